#include <cstdio>
#include <iostream>
#include <new>

#include "cli/command.h"
#include "cli/commands.h"
#include "common/error.h"

using namespace pellucid::harness;

namespace {

enum ExitCode { OK = 0, OVER_LIMIT = 1, USAGE = 2, BAD_INPUT = 3, NO_DEVICE = 4 };

int fail(ExitCode code, const char* sentence) {
  std::fprintf(stderr, "pellucid: %s\n", sentence);
  return code;
}

// Files that need more memory than there is are named where they are read. Work on them is left: the
// command says which. Nothing is allocated.
int outOfMemory(int argc, char** argv) {
  std::fputs("pellucid: there is not enough memory for:", stderr);
  for (int i = 1; i < argc; ++i) std::fprintf(stderr, " %s", argv[i]);
  std::fputs("\n", stderr);
  return BAD_INPUT;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const bool understood = runCommandLine(
        argc, argv, "Screen-space translucency and subsurface diffusion on captured frames.",
        "Exit codes: 0 ok, 1 comparison over its limit or stress violated, 2 usage, 3 bad input, 4 no usable "
        "device.",
        addCommands);
    std::cout.flush();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) || !std::cout) return fail(BAD_INPUT, "standard output cannot be written: is the disk full?");
    return understood ? OK : USAGE;
  } catch (const LimitExceeded& e) {
    return fail(OVER_LIMIT, e.what());
  } catch (const UsageError& e) {
    return fail(USAGE, e.what());
  } catch (const DeviceError& e) {
    return fail(NO_DEVICE, e.what());
  } catch (const std::bad_alloc&) {
    return outOfMemory(argc, argv);
  } catch (const std::exception& e) {
    return fail(BAD_INPUT, e.what());
  }
}
