#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <vector>

#include "core/campaign/state_points.h"
#include "core/numerics/distributions.h"
#include "core/numerics/resampling.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::preparation {

namespace {

/// A distance and its variance by the declared noise.
struct Distance {
  double length = 0.0, variance = 0.0;
};

Distance distanceOf(const campaign::ReflectorMean& a, const campaign::ReflectorMean& b,
                    const metrology::TrackerNoise& noise) {
  const Eigen::Vector3d apart = b.point - a.point;
  const double length = apart.norm();
  const Eigen::Vector3d along = apart / length;
  return {length, along.dot((a.covariance(noise) + b.covariance(noise)) * along)};
}

}  // namespace

bool DistanceScatter::asDeclared() const {
  constexpr double kSigmas = 2.0;
  const double wide = 1.0 + kSigmas * std::sqrt(2.0 / std::max(1.0, degrees));
  return ratio < wide && ratio * wide > 1.0;
}

DistanceScatter distanceScatter(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise) {
  constexpr std::size_t kMostTargets = 6;  // more say the same many times over
  using Pair = std::tuple<int, int, int>;  // step, two targets
  std::map<Pair, Distance> last;
  std::vector<double> squares;
  double independent = 0.0;
  for (const campaign::StatePoints& state : campaign::statePoints(campaign)) {
    if (state.source != campaign::StatePoints::Source::loading) continue;
    const std::size_t seen = std::min(kMostTargets, state.reflectors.size());
    std::size_t changes = 0;
    for (std::size_t i = 0; i < seen; ++i) {
      for (std::size_t k = i + 1; k < seen; ++k) {
        const campaign::ReflectorMean &a = state.reflectors[i], &b = state.reflectors[k];
        if (a.station != b.station) continue;
        const Distance now = distanceOf(a, b, noise);
        if (!(now.length > 0.0) || !(now.variance > 0.0)) continue;
        const auto [before, first] =
            last.try_emplace({state.step, std::min(a.target, b.target), std::max(a.target, b.target)}, now);
        if (first) continue;
        const double change = now.length - before->second.length;
        squares.push_back(change * change / (now.variance + before->second.variance));
        before->second = now;
        ++changes;
      }
    }
    if (seen >= 2)
      independent += std::min(static_cast<double>(changes), seen == 2 ? 1.0 : 3.0 * static_cast<double>(seen) - 6.0);
  }
  DistanceScatter found;
  if (squares.empty()) return found;
  constexpr double kOfMedian = 0.37, kOfSuccessive = 2.0 / 3.0;
  found.ratio = numerics::median(std::move(squares)) / numerics::chiSquareLimit(0.5, 1.0);
  found.degrees = kOfMedian * kOfSuccessive * independent;
  return found;
}

}  // namespace stiffscope::preparation
