// How long the module's context takes to create: it compiles every pipeline, or those that its uses ask for.
#pragma once

#include "options.h"
#include "report.h"

namespace pellucid::bench {

// In processes of their own, since drivers also keep compiled shaders in memory: without a driver cache, with
// one that a process before has filled, and from a VkPipelineCache that a process before has saved, without a
// driver cache. Adds the rows of the section "context creation", wall-clock time, of `repeat` processes each;
// the first kind is measured once, with all pipelines and with those of a default frame.
void measureContextCreation(const std::string& device, int repeat, Report& report);

// Runs in such a process: creates the context once and prints wall-clock and CPU microseconds.
int createContext(const Options& options);

}  // namespace pellucid::bench
