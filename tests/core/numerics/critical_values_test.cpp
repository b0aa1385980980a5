#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include "core/numerics/distributions.h"

namespace stiffscope {
namespace critical_values_test {

// Printed tables (Abramowitz and Stegun 26.7, 26.8, 26.10; NIST e-Handbook 1.3.6.7), to their last digit.
TEST(Chance, LimitsAreThoseOfPrintedTables) {
  EXPECT_NEAR(numerics::chiSquareLimit(0.05, 1), 3.84146, 5e-6);
  EXPECT_NEAR(numerics::chiSquareLimit(0.01, 3), 11.3449, 5e-5);
  EXPECT_NEAR(numerics::chiSquareLimit(0.001, 10), 29.5883, 5e-5);
  EXPECT_NEAR(numerics::chiSquareLimit(0.05, 100), 124.342, 5e-4);
  EXPECT_NEAR(numerics::normalLimit(0.05), 1.959964, 5e-7);
  EXPECT_NEAR(numerics::studentLimit(0.05, 1), 12.706, 5e-4);
  EXPECT_NEAR(numerics::studentLimit(0.01, 10), 3.169, 5e-4);
  EXPECT_NEAR(numerics::studentLimit(0.001, 30), 3.646, 5e-4);
}

// The printed critical values of chi-square at 5 % and 0.1 % are the normal's at one side, 1.645 and 3.090; two degrees
// have exp(-x/2) as their tail, and 1e-16 of it is the limit.
TEST(Chance, ChiSquareAsNormalDeviatesUpToTheLimit) {
  EXPECT_NEAR(numerics::chiSquareDeviate(124.342, 100), 1.644854, 5e-5);
  EXPECT_NEAR(numerics::chiSquareDeviate(29.5883, 10), 3.090232, 5e-5);
  EXPECT_NEAR(numerics::chiSquareDeviate(-2.0 * std::log(0.975), 2), -1.959964, 5e-6);
  EXPECT_LT(numerics::chiSquareDeviate(-2.0 * std::log(2e-16), 2), numerics::kLargestDeviate);
  EXPECT_NEAR(numerics::chiSquareDeviate(-2.0 * std::log(5e-17), 2), numerics::kLargestDeviate, 1e-9);
  EXPECT_NEAR(numerics::chiSquareDeviate(1e9, 3.5), numerics::kLargestDeviate, 1e-9);
  EXPECT_NEAR(numerics::chiSquareDeviate(0.0, 3.5), -numerics::kLargestDeviate, 1e-9);
}

// Critical values of Student's t at two-sided 5 %, NIST e-Handbook 1.3.6.7.2, and at infinitely many degrees the
// normal's. Between 100 degrees and infinity no table has rows; there the first terms of Cornish and Fisher's expansion
// (Abramowitz and Stegun 26.7.5) share nothing with the library. The next term is at most 24 / dof^4 of the value.
TEST(Chance, StudentFromTenDegreesToAMillion) {
  EXPECT_NEAR(numerics::studentLimit(0.05, 10), 2.228, 5e-4);
  EXPECT_NEAR(numerics::studentLimit(0.05, 30), 2.042, 5e-4);
  EXPECT_NEAR(numerics::studentLimit(0.05, 100), 1.984, 5e-4);
  for (const double dof : {1e2, 1e3, 3e4, 1e5, 1e6}) {
    for (const auto& [tail, z] : {std::pair(0.05, 1.9599639845400545), std::pair(0.01, 2.5758293035489004),
                                  std::pair(0.001, 3.2905267314918945)}) {
      const double z2 = z * z;
      const double expanded = z + z * (z2 + 1) / (4 * dof) + z * (5 * z2 * z2 + 16 * z2 + 3) / (96 * dof * dof) +
                              z * (3 * z2 * z2 * z2 + 19 * z2 * z2 + 17 * z2 - 15) / (384 * dof * dof * dof);
      EXPECT_NEAR(numerics::studentLimit(tail, dof) / expanded, 1.0, std::max(1e-12, 30.0 / std::pow(dof, 4)))
          << tail << " " << dof;
    }
  }
}

// Wilson and Hilferty's cube (Abramowitz and Stegun 26.4.17): its error falls with dof^-3/2, 8e-4 of the value at ten
// degrees, where the table of NIST (1.3.6.7.4) decides.
TEST(Chance, ChiSquareFromTenDegreesToAMillion) {
  EXPECT_NEAR(numerics::chiSquareLimit(0.05, 10), 18.307, 5e-4);
  EXPECT_NEAR(numerics::chiSquareLimit(0.05, 30), 43.773, 5e-4);
  constexpr double kZ = 1.6448536269514722;  // of 5 % on one side
  for (const double dof : {1e1, 3e1, 1e2, 1e3, 3e4, 1e5, 1e6}) {
    const double c = 2.0 / (9.0 * dof), cubed = dof * std::pow(1.0 - c + kZ * std::sqrt(c), 3);
    EXPECT_NEAR(numerics::chiSquareLimit(0.05, dof) / cubed, 1.0, 0.03 / std::pow(dof, 1.5)) << dof;
  }
}

// Without degrees of freedom, or where everything may lie beyond, there is no limit.
TEST(Chance, NoLimitIsZero) {
  EXPECT_EQ(numerics::chiSquareLimit(0.05, 0), 0.0);
  EXPECT_EQ(numerics::chiSquareLimit(1.0, 3), 0.0);
  EXPECT_EQ(numerics::studentLimit(0.05, 0), 0.0);
  EXPECT_EQ(numerics::normalLimit(1.0), 0.0);
}

// By hand: no hit in n trials leaves 1 - (tail)^(1/n), and n hits the mirror of it.
TEST(BinomialRate, OfNoneAndOfAllByHand) {
  for (const int trials : {1, 10, 1000, 1'000'000}) {
    const double bound = -std::expm1(std::log(0.025) / trials);
    EXPECT_NEAR(numerics::binomialRate(0, trials).high / bound, 1.0, 1e-10) << trials;
    EXPECT_NEAR(numerics::binomialRate(trials, trials).low, 1.0 - bound, 1e-12) << trials;
  }
}

// The smallest levels that the audit divides down to: chi-square of 2 is -2 ln p, Student's t of 1 is Cauchy.
TEST(Chance, SmallLevelsKeepTheirDigits) {
  EXPECT_NEAR(numerics::chiSquareLimit(1e-9, 2), -2.0 * std::log(1e-9), 1e-8);
  EXPECT_NEAR(numerics::studentLimit(1e-6, 1) / std::tan(0.5 * std::numbers::pi * (1.0 - 1e-6)), 1.0, 1e-6);
}

}  // namespace critical_values_test
}  // namespace stiffscope
