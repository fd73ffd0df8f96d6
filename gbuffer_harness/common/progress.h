// Progress of long work on a terminal.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace pellucid::harness {

// Draws on stderr, and only when stderr is a terminal; elsewhere it does nothing. The line is erased
// when the bar goes out of scope. advance() may be called from any thread.
class Progress {
public:
  Progress(std::string label, std::uint64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::uint64_t steps = 1);

  // Text after the bar from its next drawing on.
  void note(std::string text);

private:
  void draw(std::uint64_t done);

  const std::string label_;
  const std::uint64_t total_;
  const bool terminal_;
  const std::chrono::steady_clock::time_point start_;
  std::atomic<std::uint64_t> done_ = 0;
  std::mutex drawing_;  // of what follows
  std::string note_;
  std::chrono::steady_clock::time_point drawn_;
};

// A sentence on stderr while it is in scope, for work without steps to count; only when stderr is a terminal.
class ProgressLine {
public:
  explicit ProgressLine(const std::string& sentence);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

private:
  const bool terminal_;
};

}  // namespace pellucid::harness
