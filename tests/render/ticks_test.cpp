#include "render/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include "render/spread_chart.h"

namespace stiffscope {
namespace ticks_test {

using Strings = std::vector<std::string>;

TEST(Ticks, RoundsToOneTwoFive) {
  EXPECT_DOUBLE_EQ(render::roundDown125(7.3), 5);
  EXPECT_DOUBLE_EQ(render::roundDown125(0.02), 0.02);
  EXPECT_DOUBLE_EQ(render::roundUp125(7.3), 10);
  EXPECT_DOUBLE_EQ(render::roundUp125(0.021), 0.05);
  EXPECT_DOUBLE_EQ(render::roundUp125(100), 100);
}

TEST(Ticks, LinearLabelsHaveTheDecimalsOfTheStep) {
  EXPECT_EQ(render::linearTicks(0, 1, 6).labels, (Strings{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(render::linearTicks(-1, 1, 5).labels, (Strings{"\u22121.0", "\u22120.5", "0", "0.5", "1.0"}));
  EXPECT_EQ(render::linearTicks(0, 4e6, 3).labels, (Strings{"0", "2\u00d710\u2076", "4\u00d710\u2076"}));
}

TEST(Ticks, LinearTicksStayInsideAndAreNotTooMany) {
  for (double upper = 0.013; upper < 5000; upper *= 1.7) {
    const render::Ticks ticks = render::linearTicks(-0.3 * upper, upper, 8);
    ASSERT_GE(ticks.positions.size(), 2u) << upper;
    EXPECT_LE(ticks.positions.size(), 8u) << upper;
    EXPECT_GE(ticks.positions.front(), -0.3 * upper * (1 + 1e-9));
    EXPECT_LE(ticks.positions.back(), upper * (1 + 1e-9));
  }
}

TEST(Ticks, OneTickTellsNoScale) {
  EXPECT_EQ(render::linearTicks(-0.12, 4.1, 2).labels, (Strings{"0", "2", "4"}));
  EXPECT_EQ(render::linearTicks(0.7, 1.3, 2).labels, (Strings{"0.8", "1.0", "1.2"}));
  EXPECT_EQ(render::linearTicks(1001, 1004, 2).labels, (Strings{"1002", "1004"}));
}

TEST(Ticks, LogTicksAreDecades) {
  EXPECT_EQ(render::logTicks(0.5, 2e4).labels, (Strings{"1", "10", "100", "1000", "10\u2074"}));
  EXPECT_GE(render::logTicks(3, 6).positions.size(), 3u);
}

TEST(Ticks, FactorsAreWrittenOut) {
  EXPECT_EQ(render::factorText(40000), "40\u00a0000");
  EXPECT_EQ(render::factorText(12050), "12\u00a0050");
  EXPECT_EQ(render::factorText(500), render::shortNumber(500));
  EXPECT_EQ(render::factorText(5e6), render::shortNumber(5e6));
  EXPECT_EQ(render::factorText(0.5), render::shortNumber(0.5));
}

TEST(Ticks, ShortNumbers) {
  EXPECT_EQ(render::shortNumber(200), "200");
  EXPECT_EQ(render::shortNumber(-2.5), "\u22122.5");
  EXPECT_EQ(render::shortNumber(50000), "5\u00d710\u2074");
  EXPECT_EQ(render::shortNumber(1e-6), "10\u207b\u2076");
  EXPECT_EQ(render::shortNumber(0), "0");
}

TEST(Spread, PercentilesByHand) {
  const render::Spread spread = render::spreadOf({5, 1, 4, 2, 13});
  EXPECT_DOUBLE_EQ(spread.p5, 1.2);
  EXPECT_DOUBLE_EQ(spread.p25, 2);
  EXPECT_DOUBLE_EQ(spread.p50, 4);
  EXPECT_DOUBLE_EQ(spread.p75, 5);
  EXPECT_DOUBLE_EQ(spread.p95, 11.4);
  EXPECT_DOUBLE_EQ(spread.mean, 5);
  EXPECT_DOUBLE_EQ(render::spreadOf({3}).p95, 3);
  EXPECT_THROW(render::spreadOf({}), std::invalid_argument);
  EXPECT_THROW(render::spreadOf({1, std::nan("")}), std::invalid_argument);
}

}  // namespace ticks_test
}  // namespace stiffscope
