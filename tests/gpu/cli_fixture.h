// Runs `pellucid` in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "temporary_directory.h"

namespace pellucid::test {

struct Outcome {
  int code;
  std::string text;  // standard output and error
};

// `before`: shell commands in the same process, each with its semicolon.
inline Outcome run(const std::string& arguments, const std::string& before = "") {
  const std::string command = before + PELLUCID_COMMAND + " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {-1, "popen failed"};
  Outcome outcome{0, {}};
  char buffer[4096];
  while (const size_t n = fread(buffer, 1, sizeof buffer, pipe)) outcome.text.append(buffer, n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

class Cli : public testing::Test {
protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void expect(int code, const std::string& arguments, const std::string& sentence = "") const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(sentence), std::string::npos) << arguments << "\n" << outcome.text;
  }

  std::string bytes(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  harness::TemporaryDirectory folder_;
};

}  // namespace pellucid::test
