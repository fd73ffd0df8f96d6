// A module context whose pipelines the driver compiles when a plan first dispatches them. Engines want all of
// them before the first frame; a command or a test renders few frames, which dispatch half of the pipelines
// at most.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "pellucid/pellucid.h"
#include "pellucid/pellucid_plan.h"

namespace pellucid::harness {

class DeferredPipelines {
public:
  DeferredPipelines();
  ~DeferredPipelines();

  // Must outlive the context that the desc makes. Sets getInstanceProcAddr, pipelineCache, parallelFor and
  // uses.
  void defer(PellucidContextDesc& desc);

  // Compiles what the plan dispatches, on all threads of the machine. Must come before the plan is recorded.
  // Throws DeviceError.
  void prepare(const PellucidPlan& plan);

private:
  struct Pipeline;
  struct Functions;

  std::mutex mutex_;
  std::vector<std::unique_ptr<Pipeline>> pipelines_;  // in the order of PellucidDispatch::pipeline
};

}  // namespace pellucid::harness
