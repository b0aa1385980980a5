#include "core/extended_model/horseshoe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiffscope::extended_model {

namespace {

// The table's places in ln S. Beyond them the density is a power of S.
constexpr double kFirstLog = -60.0, kLogStep = 0.25;
constexpr std::size_t kLogs = 301;

}  // namespace

PiecewiseDensity::PiecewiseDensity(double first, double step, const std::array<double, kPlaces>& density)
    : first_(first), step_(step), height_(density) {
  for (std::size_t i = 1; i < kPlaces; ++i) below_[i] = below_[i - 1] + 0.5 * step * (height_[i - 1] + height_[i]);
  const double share = 1.0 / below_.back();
  for (double& one : height_) one *= share;
  for (double& one : below_) one *= share;
}

double PiecewiseDensity::draw(double uniform) const {
  const auto next = std::upper_bound(below_.begin() + 1, below_.end() - 1, uniform);
  const auto i = static_cast<std::size_t>(next - below_.begin()) - 1;
  const double rest = (uniform - below_[i]) / step_, rise = height_[i + 1] - height_[i];
  // rest = height share + rise share^2 / 2, by the form of the root that a rise of zero leaves exact.
  const double root = std::sqrt(std::max(0.0, height_[i] * height_[i] + 2.0 * rise * rest));
  const double share = rest > 0.0 ? std::min(1.0, 2.0 * rest / (height_[i] + root)) : 0.0;
  return first_ + step_ * (static_cast<double>(i) + share);
}

double PiecewiseDensity::logDensity(double at) const {
  const double place = (at - first_) / step_;
  if (!(place >= 0.0 && place <= static_cast<double>(kPlaces - 1))) return -std::numeric_limits<double>::infinity();
  const auto i = std::min(static_cast<std::size_t>(place), kPlaces - 2);
  const double share = place - static_cast<double>(i);
  return std::log((1.0 - share) * height_[i] + share * height_[i + 1]);
}

ScaleMixture::ScaleMixture(std::size_t parameters, bool product)
    : count_(static_cast<double>(parameters)), product_(product) {
  for (std::size_t k = 0; k < kLogs; ++k) {
    const double log_sum = kFirstLog + kLogStep * static_cast<double>(k), sum = std::exp(log_sum);
    // The trapezoid rule over y converges faster than any power of its step; the density falls by exp(-40) beyond.
    constexpr double kStep = 0.25;
    const double high = std::max(log_sum, 0.0) + 80.0 / (count_ + 1.0);
    double most = -std::numeric_limits<double>::infinity(), integral = 0.0;
    for (double y = log_sum - 5.0; y < high; y += kStep) {
      const double one = logJoint(sum, y);
      if (one > most) integral *= std::exp(most - one), most = one;
      integral += kStep * std::exp(one - most);
    }
    table_.push_back(most + std::log(integral));
  }
}

double ScaleMixture::logPrior(double y) const {
  // Written so that no exponential overflows.
  const double size = std::abs(y);
  if (!product_) return 0.5 * y - std::max(y, 0.0) - std::log1p(std::exp(-size));
  if (size < 1e-8) return 0.0;
  return std::log(size) - 0.5 * size - std::log1p(-std::exp(-size));
}

double ScaleMixture::logJoint(double sum_of_squares, double y) const {
  return logPrior(y) - 0.5 * (count_ * y + sum_of_squares * std::exp(-y));
}

double ScaleMixture::logMarginal(double sum_of_squares) const {
  const double place = (std::log(sum_of_squares) - kFirstLog) / kLogStep;
  const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(kLogs - 2)));
  return table_[i] + (place - static_cast<double>(i)) * (table_[i + 1] - table_[i]);
}

PiecewiseDensity ScaleMixture::scaleGiven(double sum_of_squares) const {
  // From where S exp(-y) / 2 is 30 to where the prior has fallen by exp(-20) from its own middle or from S.
  const double log_sum = std::log(sum_of_squares), low = log_sum - std::log(60.0);
  const double high = std::max(log_sum, 0.0) + 40.0 / (count_ + 1.0);
  const double step = (high - low) / static_cast<double>(PiecewiseDensity::kPlaces - 1);
  // exp(logJoint) from one place to the next by factors, of the first up to a constant.
  std::array<double, PiecewiseDensity::kPlaces> density;
  const double ratio = std::exp(step), power_ratio = std::exp(0.5 * (1.0 - count_) * step);
  double square = std::exp(low), power = 1.0;
  for (std::size_t i = 0; i < density.size(); ++i, square *= ratio, power *= power_ratio) {
    const double y = low + step * static_cast<double>(i);
    const double prior = product_ ? (std::abs(y) > 1e-6 ? y / (square - 1.0) : 1.0) : 1.0 / (1.0 + square);
    density[i] = power * prior * std::exp(-0.5 * sum_of_squares / square);
  }
  return PiecewiseDensity(low, step, density);
}

double factorOfProduct(double square, double uniform) {
  const double log_square = std::log(square);
  if (std::abs(log_square) < 1e-8) return uniform / (1.0 - uniform);
  // (t^2 + s^2) / (t^2 + 1) = s^2^(1 - uniform)
  return square * std::expm1(-uniform * log_square) / -std::expm1((1.0 - uniform) * log_square);
}

}  // namespace stiffscope::extended_model
