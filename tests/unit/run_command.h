// Runs a command of the command line within the test.
#pragma once

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>
#include <vector>

#include "cli/commands.h"

namespace pellucid::harness {

// Standard output of `pellucid WORDS`, the first of which is the command that `add` adds; also in `printed`, when
// it throws too.
inline std::string runCommand(void (*add)(const Command&), const std::vector<std::string>& words,
                              std::string* printed = nullptr) {
  CLI::App app;
  add(app);
  std::string line;
  for (const std::string& word : words) line += word + " ";
  std::exception_ptr thrown;
  testing::internal::CaptureStdout();
  try {
    app.parse(line);
  } catch (...) {
    thrown = std::current_exception();
  }
  const std::string text = testing::internal::GetCapturedStdout();
  if (printed) *printed = text;
  if (thrown) std::rethrow_exception(thrown);
  return text;
}

}  // namespace pellucid::harness
