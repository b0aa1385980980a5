#include "core/numerics/distributions.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <stdexcept>

namespace stiffscope::numerics {

namespace {

namespace math = boost::math;
using math::policies::ignore_error;
// Arguments that no distribution has give NaN or infinity and do not throw: a check without readings has no limit.
using Policy =
    math::policies::policy<math::policies::domain_error<ignore_error>, math::policies::overflow_error<ignore_error>,
                           math::policies::promote_double<false>>;

/// Where there is nothing to exceed, or everything may: zero.
bool hasLimit(double tail, double dof) { return tail < 1.0 && dof > 0.0; }

}  // namespace

double chiSquareLimit(double tail, double dof) {
  if (!hasLimit(tail, dof)) return 0.0;
  return math::quantile(math::complement(math::chi_squared_distribution<double, Policy>(dof), tail));
}

double normalLimit(double tail) {
  if (!hasLimit(tail, 1.0)) return 0.0;
  return math::quantile(math::complement(math::normal_distribution<double, Policy>(), 0.5 * tail));
}

double studentLimit(double tail, double dof) {
  if (!hasLimit(tail, dof)) return 0.0;
  return math::quantile(math::complement(math::students_t_distribution<double, Policy>(dof), 0.5 * tail));
}

double chiSquareDeviate(double value, double dof) {
  const math::chi_squared_distribution<double, Policy> chi_square(dof);
  const math::normal_distribution<double, Policy> normal;
  const double least = math::cdf(math::complement(normal, kLargestDeviate));
  // The smaller tail of the two, which alone has all its digits.
  const double above = math::cdf(math::complement(chi_square, std::max(0.0, value)));
  if (above < 0.5) return math::quantile(math::complement(normal, std::max(above, least)));
  return math::quantile(normal, std::max(math::cdf(chi_square, std::max(0.0, value)), least));
}

double poissonTail(std::size_t count, double mean) {
  return count == 0 ? 1.0 : math::gamma_p(static_cast<double>(count), mean, Policy());
}

Rate binomialRate(int hits, int trials, double level) {
  if (hits < 0 || hits > trials) throw std::invalid_argument("hits are not from 0 to trials");
  using Binomial = math::binomial_distribution<double>;
  Rate rate{hits, trials, 0.0, 1.0};
  const double tail = 0.5 * (1.0 - level);
  if (hits > 0) rate.low = Binomial::find_lower_bound_on_p(trials, hits, tail);
  if (hits < trials) rate.high = Binomial::find_upper_bound_on_p(trials, hits, tail);
  return rate;
}

}  // namespace stiffscope::numerics
