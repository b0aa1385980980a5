#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include "core/numerics/distributions.h"

namespace stiffscope {
namespace {

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

// The smallest levels that the audit divides down to: chi-square of 2 is -2 ln p, Student's t of 1 is Cauchy.
TEST(Chance, SmallLevelsKeepTheirDigits) {
  EXPECT_NEAR(numerics::chiSquareLimit(1e-9, 2), -2.0 * std::log(1e-9), 1e-8);
  EXPECT_NEAR(numerics::studentLimit(1e-6, 1) / std::tan(0.5 * std::numbers::pi * (1.0 - 1e-6)), 1.0, 1e-6);
}

}  // namespace
}  // namespace stiffscope
