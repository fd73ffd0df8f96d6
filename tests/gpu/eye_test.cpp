// `pellucid flicker` as a person runs it.

#include <algorithm>
#include <cstdio>

#include "cli_fixture.h"

namespace {

using namespace pellucid::test;

TEST_F(Cli, FlickerOfPixelsByThemselves) {
  // What comes through a pixel is its own: moved, only the rounding of rays is left, at most one step of the
  // output's half floats, .001. Lights that turn change what comes through, and the limit says so.
  const Outcome outcome =
      run("flicker --procedural ear --size 48x40 --shadow-size 64 --pixels 1,-4 --set features=translucency "
          "--limit worst=0.01");
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("worst of R lights turned by 0.5 degrees is"), std::string::npos)
      << outcome.text;
  // A row of a change: its relative RMSE, its 99.9th percentile and the worst pixel, R G B each.
  const auto worstOf = [&](const std::string& change) {
    double e[9] = {};
    const std::size_t row = outcome.text.find("| " + change + " | ");
    if (row == std::string::npos ||
        std::sscanf(outcome.text.c_str() + row + change.size() + 5, "%lf %lf %lf | %lf %lf %lf | %lf %lf %lf", e, e + 1,
                    e + 2, e + 3, e + 4, e + 5, e + 6, e + 7, e + 8) != 9)
      ADD_FAILURE() << change << ": " << outcome.text;
    return std::minmax({e[6], e[7], e[8]});
  };
  EXPECT_LE(worstOf("moved by 1 pixel").second, 0.002);
  EXPECT_LE(worstOf("moved by -4 pixels").second, 0.002);
  EXPECT_GT(worstOf("lights turned by 0.5 degrees").first, 0.01);
  EXPECT_NE(outcome.text.find("spots, lights turned by 0.5 degrees: "), std::string::npos) << outcome.text;
}

}  // namespace
