#include "reports/words/numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include "reports/page/html.h"

namespace stiffscope::page {
namespace numbers_test {

TEST(ForceWords, InTheUnitThatSuitsTheRobot) {
  EXPECT_EQ(reports::forceWords(1497.3), "1.50\u00a0kN");
  EXPECT_EQ(reports::forceWords(92.34), "92.3\u00a0N");  // not 0.09 kN
  EXPECT_EQ(reports::forceWords(999.6), "1.00\u00a0kN");
  EXPECT_EQ(reports::forceWords(999.4), "999\u00a0N");
}

TEST(Numbers, ValuesEndWhereTheirUncertaintyDoes) {
  EXPECT_EQ(reports::withUncertainty(5.6012, 0.1), "5.60 ± 0.10");
  EXPECT_EQ(reports::withUncertainty(0.079123, 0.0123), "0.079 ± 0.012");
  EXPECT_EQ(reports::withUncertainty(-0.2412, 0.2212), "−0.24 ± 0.22");
  EXPECT_EQ(reports::withUncertainty(2403.0, 2288.0), "2400 ± 2300");
  EXPECT_EQ(reports::withUncertainty(1.0, 0.0996), "1.00 ± 0.10");  // 0.0996 is 0.10 in two digits
}

TEST(Numbers, PlacesToTheSecondDigitOfAnUncertainty) {
  EXPECT_EQ(reports::placesOf(0.0123, 3), 3);
  EXPECT_EQ(reports::placesOf(0.0996, 3), 2);  // as 0.10
  EXPECT_EQ(reports::placesOf(12.3, 3), 0);
  EXPECT_EQ(reports::placesOf(250.0, 3), 0);
  EXPECT_EQ(reports::placesOf(0.0, 3), 3);
  EXPECT_EQ(reports::placesOf(std::nan(""), 4), 4);
}

TEST(Numbers, WithoutUncertaintyFourDigits) {
  EXPECT_EQ(reports::withUncertainty(3.14159, 0.0), "3.142");
  EXPECT_EQ(reports::withUncertainty(3.14159, std::nan("")), "3.142");
}

TEST(Numbers, HugeOnesHaveAnExponent) { EXPECT_EQ(reports::significant(2.345e9, 3), "2.35e9"); }

TEST(Numbers, WhatIsNoNumberSaysSo) {
  EXPECT_EQ(reports::fixed(std::nan(""), 2), "–");
  EXPECT_EQ(reports::percent(INFINITY), "–");
  EXPECT_EQ(reports::withUncertainty(INFINITY, 1.0), "–");
}

TEST(Numbers, ZeroHasNoSign) {
  EXPECT_EQ(reports::fixed(-0.0004, 2), "0.00");
  EXPECT_EQ(reports::significant(0.0, 3), "0");
}

TEST(Numbers, PercentWithANoBreakSpace) { EXPECT_EQ(reports::percent(0.8432), "84.3\u00a0%"); }

TEST(Numbers, WhatIsNotTheWholeDoesNotReadAsTheWhole) {
  EXPECT_EQ(reports::percentNumber(0.994, 0), "99");
  EXPECT_EQ(reports::percentNumber(0.996, 0), "99.6");
  EXPECT_EQ(reports::percentNumber(0.9996, 1), "99.96");
  EXPECT_EQ(reports::percentNumber(0.99999, 1), "100.0");  // whole to a hundredth of a percent
  EXPECT_EQ(reports::percentNumber(1.0, 0), "100");
  EXPECT_EQ(reports::percentNumber(1.0004, 0), "100");
  EXPECT_EQ(reports::percentNumber(-0.3, 0), "−30");
}

TEST(Base64, TheVectorsOfRfc4648) {
  const auto encode = [](const std::string& text) { return page::base64({text.begin(), text.end()}); };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
  EXPECT_EQ(page::base64({0xff, 0xff, 0xfe}), "///+");
}

}  // namespace numbers_test
}  // namespace stiffscope::page
