#include "core/calibration/fitted_arm.h"

#include <algorithm>
#include <limits>

#include "core/robot/kinematics.h"
#include "metrology/registration.h"

namespace stiffscope::calibration {

namespace {

struct Seen {
  Eigen::Isometry3d flange_motion;  ///< of the last body from its place at zero
  Eigen::Vector3d point;
  std::size_t target = 0;
  double miss = 0.0;
  bool used = true;
};

/// Evenly chosen postures: placing is a start, and a few hundred readings determine nine numbers.
std::vector<Seen> seenReadings(const UnloadedDay& day, const std::vector<double>& weights) {
  constexpr std::size_t kEnough = 600;
  std::vector<Seen> all;
  std::size_t at = 0;
  for (const Posture& posture : day.postures) {
    const Eigen::Isometry3d motion = robot::postureAt(day.arm, posture.q).motion.back();
    for (const Reading& reading : posture.readings) {
      if (weights[at++] > 0.0) all.push_back({motion, reading.point, static_cast<std::size_t>(reading.target)});
    }
  }
  const std::size_t stride = all.size() / kEnough + 1;
  std::vector<Seen> chosen;
  for (std::size_t i = 0; i < all.size(); i += stride) chosen.push_back(all[i]);
  return chosen;
}

/// Uses the four fifths that fit best; returns the median miss.
double trim(std::vector<Seen>& seen) {
  std::vector<double> misses;
  for (const Seen& one : seen) misses.push_back(one.miss);
  std::sort(misses.begin(), misses.end());
  const double limit = misses[(4 * misses.size()) / 5];
  for (Seen& one : seen) one.used = one.miss <= limit;
  return misses[misses.size() / 2];
}

class Placing {
 public:
  Placing(std::vector<Seen> seen, std::size_t targets) : seen_(std::move(seen)), targets_(targets) {}

  /// From reflectors that all stand at one point of the flange's body; the median miss where it ends.
  double from(const Eigen::Vector3d& start) {
    place_.targets_at_zero.assign(targets_, start);
    for (Seen& one : seen_) one.used = true;
    double median = std::numeric_limits<double>::infinity();
    constexpr int kTurns = 100;
    constexpr double kSettled = 1e-3;
    for (int turn = 0; turn < kTurns; ++turn) {
      if (!registerReadings()) return std::numeric_limits<double>::infinity();
      placeTargets();
      for (Seen& one : seen_) {
        one.miss =
            (place_.base_from_points * one.point - one.flange_motion * place_.targets_at_zero[one.target]).norm();
      }
      const double before = median;
      median = trim(seen_);
      if (turn > 5 && std::abs(before - median) < kSettled * median) break;
    }
    return median;
  }

  const ArmPlace& place() const { return place_; }

 private:
  bool registerReadings() {
    std::vector<Eigen::Vector3d> points, modelled;
    for (const Seen& one : seen_) {
      if (!one.used) continue;
      points.push_back(one.point);
      modelled.push_back(one.flange_motion * place_.targets_at_zero[one.target]);
    }
    const metrology::RigidRegistration registration = metrology::registerRigid(points, modelled);
    place_.base_from_points = registration.to_from_source;
    return registration.determined;
  }

  void placeTargets() {
    std::vector<Eigen::Vector3d> sums(targets_, Eigen::Vector3d::Zero());
    std::vector<int> counts(targets_, 0);
    for (const Seen& one : seen_) {
      if (!one.used) continue;
      sums[one.target] += one.flange_motion.inverse() * (place_.base_from_points * one.point);
      ++counts[one.target];
    }
    for (std::size_t t = 0; t < targets_; ++t) {
      if (counts[t] > 0) place_.targets_at_zero[t] = sums[t] / counts[t];
    }
  }

  std::vector<Seen> seen_;
  std::size_t targets_;
  ArmPlace place_;
};

}  // namespace

std::optional<ArmPlace> placeArm(const UnloadedDay& day, const std::vector<double>& weights) {
  std::vector<Seen> seen = seenReadings(day, weights);
  constexpr std::size_t kFewest = 4;
  if (seen.size() < kFewest) return std::nullopt;
  const Eigen::Vector3d flange = day.arm.base_from_flange_at_zero.translation();
  constexpr double kFar = 0.3;  // m: tools and adapters
  Placing placing(std::move(seen), day.targets.size());
  std::optional<ArmPlace> best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 7; ++start) {
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    if (start > 0) offset[(start - 1) / 2] = start % 2 == 1 ? kFar : -kFar;
    const double median = placing.from(flange + offset);
    if (!(median < least)) continue;
    least = median;
    best = placing.place();
  }
  return best;
}

}  // namespace stiffscope::calibration
