// What long work shows: on a terminal, and nowhere else.
#include "common/progress.h"

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <string>

namespace pellucid::harness {
namespace {

// What `show` writes to stderr where stderr is `descriptor`, read from `reader`.
template <class Show>
std::string shownOn(int descriptor, int reader, const Show& show) {
  std::fflush(stderr);
  const int before = dup(STDERR_FILENO);
  dup2(descriptor, STDERR_FILENO);
  show();
  std::fflush(stderr);
  dup2(before, STDERR_FILENO);
  close(before);
  // The end that readers wait for: a byte that nothing else writes.
  EXPECT_EQ(write(descriptor, "$", 1), 1);
  std::string text;
  for (char byte = 0; read(reader, &byte, 1) == 1 && byte != '$';) text += byte;
  close(descriptor);
  close(reader);
  return text;
}

template <class Show>
std::string onTerminal(const Show& show) {
  int master = -1, slave = -1;
  EXPECT_EQ(openpty(&master, &slave, nullptr, nullptr, nullptr), 0);
  return shownOn(slave, master, show);
}

template <class Show>
std::string onPipe(const Show& show) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  return shownOn(ends[1], ends[0], show);
}

void showLine() { const ProgressLine line("compiling 50 shaders"); }

TEST(ProgressLine, StandsOnATerminalUntilTheWorkIsDone) {
  EXPECT_EQ(onTerminal(showLine), "\rcompiling 50 shaders\x1b[K\r\x1b[K");
}

TEST(ProgressLine, IsNotWrittenToFiles) { EXPECT_EQ(onPipe(showLine), ""); }

TEST(Progress, IsNotWrittenToFiles) {
  EXPECT_EQ(onPipe([] {
              Progress progress("replaying", 2);
              progress.advance(2);
            }),
            "");
}

}  // namespace
}  // namespace pellucid::harness
