#include "common/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace pellucid::harness {

namespace {

constexpr int kBarWidth = 30;

bool onTerminal() { return isatty(STDERR_FILENO) == 1; }

void eraseLine() { std::fputs("\r\x1b[K", stderr); }

}  // namespace

Progress::Progress(std::string label, std::uint64_t total)
    : label_(std::move(label)),
      total_(std::max<std::uint64_t>(total, 1)),
      terminal_(onTerminal()),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {}

Progress::~Progress() {
  if (terminal_) eraseLine();
}

void Progress::advance(std::uint64_t steps) {
  const std::uint64_t done = done_ += steps;
  if (!terminal_) return;
  // Workers never wait for the terminal: who finds the bar being drawn goes on.
  const std::unique_lock lock(drawing_, std::try_to_lock);
  const auto now = std::chrono::steady_clock::now();
  if (!lock || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  draw(std::min(done, total_));
}

void Progress::note(std::string text) {
  const std::scoped_lock lock(drawing_);
  note_ = std::move(text);
}

void Progress::draw(std::uint64_t done) {
  const double fraction = static_cast<double>(done) / static_cast<double>(total_);
  const int filled = static_cast<int>(fraction * kBarWidth);
  const double elapsed = std::chrono::duration<double>(drawn_ - start_).count();
  const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
  std::fprintf(stderr, "\r%s [%s%s] %3.0f %%, %.0f s left%s%s\x1b[K", label_.c_str(),
               std::string(filled, '#').c_str(), std::string(kBarWidth - filled, '.').c_str(), 100 * fraction,
               left, note_.empty() ? "" : ", ", note_.c_str());
  std::fflush(stderr);
}

ProgressLine::ProgressLine(const std::string& sentence) : terminal_(onTerminal()) {
  if (!terminal_) return;
  std::fprintf(stderr, "\r%s\x1b[K", sentence.c_str());
  std::fflush(stderr);
}

ProgressLine::~ProgressLine() {
  if (terminal_) eraseLine();
}

}  // namespace pellucid::harness
