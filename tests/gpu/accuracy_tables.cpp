// Measures and prints the table of docs/accuracy.md about float arithmetic, or rewrites it there:
//   pellucid_accuracy_tables cancellation [--update FILE]
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "accuracy.h"
#include "commit.h"
#include "generated_block.h"

namespace {

using namespace pellucid;

template <class... Values>
std::string format(const char* text, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, text, values...);
  return line;
}

std::string cancellation(harness::Replayer& replayer) {
  std::string table =
      "| depth format | near .. far, m | stored depths | shader | float32 difference of linearized depths |\n"
      "|-|-|-|-|-|\n";
  for (const test::DepthErrors& e : test::measureDepths(replayer)) {
    const std::string farPlane = std::isinf(e.farPlane) ? "infinite" : format("%g", e.farPlane);
    table += format("| %s | %g .. %s | %.1e | %.1e | %.1e |\n", e.format.c_str(), e.nearPlane,
                    farPlane.c_str(), e.stored, e.shader, e.naive);
  }
  return table;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  if (name != "cancellation") {
    std::fprintf(stderr, "usage: pellucid_accuracy_tables cancellation [--update FILE]\n");
    return 2;
  }
  try {
    harness::Device device;
    harness::Replayer replayer(device);
    const std::string heading =
        "Worst relative errors; " + device.description() + "; commit " PELLUCID_COMMIT ":\n\n";
    return generatedBlock(argc - 2, argv + 2, name, heading + cancellation(replayer));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
