// The analysis of perception tests against published analyses and tables.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "metrics/anova.h"
#include "refusal.h"
#include "temporary_directory.h"
#include "view/perception.h"

namespace {

using namespace pellucid::harness;

// Bliss 1952, The Statistics of Bioassay: lengths of guinea pigs' teeth by supplement (orange juice, ascorbic
// acid) and dose; R has them as ToothGrowth.
const Cells kTeeth = {{{15.2, 21.5, 17.6, 9.7, 14.5, 10.0, 8.2, 9.4, 16.5, 9.7},
                       {19.7, 23.3, 23.6, 26.4, 20.0, 25.2, 25.8, 21.2, 14.5, 27.3},
                       {25.5, 26.4, 22.4, 24.5, 24.8, 30.9, 26.4, 27.3, 29.4, 23.0}},
                      {{4.2, 11.5, 7.3, 5.8, 6.4, 10.0, 11.2, 11.2, 5.2, 7.0},
                       {16.5, 16.5, 15.2, 17.3, 22.5, 17.3, 13.6, 14.5, 18.8, 15.5},
                       {23.6, 18.5, 33.9, 25.5, 26.4, 32.5, 26.7, 21.5, 23.3, 29.5}}};

TEST(Anova, TeethAreAsRHasThem) {
  // summary(aov(len ~ supp * factor(dose), ToothGrowth)), as R's documentation and textbooks print it.
  const Anova anova = twoWayAnova(kTeeth);
  EXPECT_NEAR(anova.first.sumOfSquares, 205.35, 0.005);
  EXPECT_NEAR(anova.first.f, 15.572, 0.0005);
  EXPECT_NEAR(anova.first.p, 0.000231, 5e-7);
  EXPECT_NEAR(anova.second.sumOfSquares, 2426.4, 0.05);
  EXPECT_NEAR(anova.second.f, 92.0, 0.0005);
  EXPECT_LT(anova.second.p, 2e-16);
  EXPECT_NEAR(anova.interaction.sumOfSquares, 108.3, 0.05);
  EXPECT_NEAR(anova.interaction.f, 4.107, 0.0005);
  EXPECT_NEAR(anova.interaction.p, 0.02186, 5e-6);
  EXPECT_NEAR(anova.residual.sumOfSquares, 712.1, 0.05);
  EXPECT_EQ(anova.residual.degrees, 54);
}

TEST(Anova, ComparisonsGradeTheThesisTable) {
  // Whelan 2009, table 5.4: t of six comparisons, and its stars. Twelve participants leave 132 degrees.
  const std::pair<double, const char*> table[] = {{2.926, "*"}, {2.440, "ns"}, {4.606, "***"},
                                                  {2.870, "*"}, {3.299, "**"}, {2.562, "ns"}};
  for (const auto& [t, stars] : table) EXPECT_EQ(significance(6 * bothTailsT(t, 132)), stars) << t;
}

TEST(Anova, ComparisonsAreBonferronis) {
  const Anova anova = twoWayAnova(kTeeth);
  const std::vector<CellComparison> c = compareLevels(kTeeth, 0, 1, anova);
  // (13.23 - 7.98) / sqrt(2 * 712.106 / 54 / 10); then (22.70 - 16.77) and (26.06 - 26.14).
  EXPECT_NEAR(c[0].t, 3.2327, 1e-3);
  EXPECT_NEAR(c[1].t, 3.6514, 1e-3);
  EXPECT_NEAR(c[2].t, 0.0493, 1e-3);
  EXPECT_NEAR(c[0].p, 3 * bothTailsT(c[0].t, 54), 1e-15);
  EXPECT_EQ(c[2].p, 1);
}

TEST(Anova, RefusesWhatIsNotBalanced) {
  Cells cells = kTeeth;
  cells[1][2].pop_back();
  EXPECT_THROW(twoWayAnova(cells), InputError);
  EXPECT_THROW(twoWayAnova({kTeeth[0]}), InputError);
  EXPECT_THROW(twoWayAnova({{{1}, {2}}, {{3}, {4}}}), InputError);
}

class Perception : public testing::Test {
protected:
  std::string refusal() const {
    return pellucid::test::refusalOf([&] { readAnswers(file_); });
  }
  TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_ / "answers.csv";
};

TEST_F(Perception, AnswersComeBack) {
  EXPECT_TRUE(readAnswers(file_).empty());
  addAnswer(file_, {"p1", "ear", {0.5, 0.25, 0.125}, 12.5});
  addAnswer(file_, {"p1", "nose", {1, 0, 0.5}, 3});
  const std::vector<PerceptionAnswer> answers = readAnswers(file_);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].scene, "ear");
  EXPECT_EQ(answers[0].color, (std::array<double, 3>{0.5, 0.25, 0.125}));
  EXPECT_EQ(answers[1].seconds, 3);
  EXPECT_NO_THROW(requireNewParticipant(file_, "p2"));
  EXPECT_THROW(requireNewParticipant(file_, "p1"), InputError);
  EXPECT_THROW(requireNewParticipant(file_, "p,2"), InputError);
}

TEST_F(Perception, BadRowsAreNamedByLine) {
  const auto write = [&](const std::string& row) {
    std::ofstream(file_) << "participant,scene,red,green,blue,seconds\np,ear,1,1,1,2\n" << row << "\n";
  };
  for (const char* row :
       {"p,ear,1,1,1", "p,ear,1,x,1,2", "p,ear,1,1,1.5,2", "p,ear,-1,1,1,2", "p,ear,1,1,1,2,3"}) {
    write(row);
    EXPECT_NE(refusal().find(".csv:3"), std::string::npos) << row << ": " << refusal();
  }
  std::ofstream(file_) << "name,scene\n";
  EXPECT_NE(refusal().find(".csv"), std::string::npos);
}

}  // namespace
