#include "metrology/tail_probability.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

namespace stiffscope::metrology {

namespace {

namespace math = boost::math;
using math::policies::ignore_error;
// Arguments that no distribution has give NaN and do not throw.
using Policy =
    math::policies::policy<math::policies::domain_error<ignore_error>, math::policies::overflow_error<ignore_error>,
                           math::policies::promote_double<false>>;
using ChiSquare = math::chi_squared_distribution<double, Policy>;
using F = math::fisher_f_distribution<double, Policy>;

}  // namespace

double chiSquareTail(double value, int degrees) { return math::cdf(math::complement(ChiSquare(degrees), value)); }

double chiSquareLimit(double tail, int degrees) { return math::quantile(math::complement(ChiSquare(degrees), tail)); }

double fTail(double value, int above, double below) {
  if (std::isinf(value)) return 0.0;  // no variance at all to compare with
  return math::cdf(math::complement(F(above, below), value));
}

double fLimit(double tail, int above, double below) { return math::quantile(math::complement(F(above, below), tail)); }

}  // namespace stiffscope::metrology
