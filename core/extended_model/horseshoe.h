#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace stiffscope::extended_model {

/// A density that is linear between equally spaced places and zero beyond them: what is proposed for one that is known
/// at these places only. Drawn from by its inverse distribution function, so that a draw follows the density as
/// smoothly as the uniform number it is made of.
class PiecewiseDensity {
 public:
  static constexpr std::size_t kPlaces = 56;

  /// `density`: at the places from `first` on, up to a factor; not all of them zero.
  PiecewiseDensity(double first, double step, const std::array<double, kPlaces>& density);

  double draw(double uniform) const;
  double logDensity(double at) const;  ///< -infinity beyond the places

 private:
  double first_, step_;
  std::array<double, kPlaces> height_{}, below_{};  ///< density and distribution function at the places
};

/// What the horseshoe says of parameters that share one scale s: x_i ~ N(0, s^2), i = 1 ... n, with s = l or, where
/// `product`, s = l t, of numbers l and t ~ C+(0, 1) each. In y = ln s^2 and S = sum x_i^2
///
///   ln p(x, y) = L(y) - n y / 2 - S exp(-y) / 2 + const,
///   L(y) = y/2 - ln(1 + exp y), or y/2 + ln(y / (exp y - 1)) of the product
///
/// (Carvalho, Polson and Scott, Biometrika 97, 2010, 465; the product's density is that of a ratio of half Cauchy
/// numbers, 4/pi^2 ln s / (s^2 - 1)).
class ScaleMixture {
 public:
  ScaleMixture(std::size_t parameters, bool product);

  /// ln p(x, y) + const.
  double logJoint(double sum_of_squares, double y) const;
  /// ln of the integral of p(x, y) over y, + the same const: from a table in ln S, for proposals.
  double logMarginal(double sum_of_squares) const;
  /// Proposes y for given S; differs from p(y | x) by what the places leave.
  PiecewiseDensity scaleGiven(double sum_of_squares) const;

 private:
  double logPrior(double y) const;

  double count_;
  bool product_;
  std::vector<double> table_;
};

/// Of s = l t as above, the square of t for given square of s: its distribution function
/// 1 - ln((t^2 + s^2) / (t^2 + 1)) / ln(s^2) at `uniform`, inverted.
double factorOfProduct(double square, double uniform);

}  // namespace stiffscope::extended_model
