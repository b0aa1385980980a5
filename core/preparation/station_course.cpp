#include "core/preparation/station_course.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/preparation/drift_nests.h"
#include "core/preparation/remarks.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::preparation {

namespace {

/// Least squares of motion = share * m over the rounds; the first round defines zero and has its noise in all
/// others.
struct Course {
  std::vector<double> share;
  Vector6d motion = Vector6d::Zero();
  double chi2 = 0.0;
};

Course fitCourse(const StationMotion& station, std::vector<double> share) {
  Course course;
  course.share = std::move(share);
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  for (std::size_t e = 1; e < station.epochs.size(); ++e) {
    const Matrix6d weight = inverseOf(station.epochs[e].covariance);
    normal += course.share[e] * course.share[e] * weight;
    right += course.share[e] * weight * station.epochs[e].motion;
  }
  course.motion = solveSymmetric(normal, right);
  for (std::size_t e = 1; e < station.epochs.size(); ++e) {
    const Vector6d left = station.epochs[e].motion - course.share[e] * course.motion;
    course.chi2 += mahalanobisSquared(left, station.epochs[e].covariance);
  }
  return course;
}

Course bestJump(const StationMotion& station, std::size_t& at) {
  Course best;
  best.chi2 = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < station.epochs.size(); ++k) {
    std::vector<double> share(station.epochs.size(), 0.0);
    std::fill(share.begin() + static_cast<std::ptrdiff_t>(k), share.end(), 1.0);
    Course course = fitCourse(station, std::move(share));
    if (course.chi2 < best.chi2) best = std::move(course), at = k;
  }
  return best;
}

void findRate(DriftModel& station) {
  const auto& epochs = station.motion.epochs;
  Vector6d right = Vector6d::Zero();
  for (std::size_t e = 1; e < epochs.size(); ++e) {
    const double since = epochs[e].time_s - epochs.front().time_s;
    const Matrix6d weight = inverseOf(epochs[e].covariance);
    station.rate_weight += since * since * weight;
    right += since * weight * epochs[e].motion;
  }
  station.rate = solveSymmetric(station.rate_weight, right);
  if (!station.rate.allFinite()) station.rate.setZero(), station.rate_weight.setZero();
}

/// Mean square of the steps from round to round about the steady drift, each over its time. The rounds' own
/// noise is in it: it is in what is interpolated, too.
Matrix6d wanderOf(const std::vector<StationEpoch>& epochs) {
  Matrix6d sum = Matrix6d::Zero();
  if (epochs.size() < 3) return sum;
  const Vector6d steady =
      (epochs.back().motion - epochs.front().motion) / (epochs.back().time_s - epochs.front().time_s);
  for (std::size_t e = 1; e < epochs.size(); ++e) {
    const double time = epochs[e].time_s - epochs[e - 1].time_s;
    const Vector6d step = epochs[e].motion - epochs[e - 1].motion - time * steady;
    sum += step * step.transpose() / time;
  }
  return sum / static_cast<double>(epochs.size() - 2);
}

}  // namespace

double bridgeBetweenRounds(const StationMotion& station, double one, double other) {
  const double early = std::min(one, other), late = std::max(one, other);
  for (std::size_t e = 1; e < station.epochs.size(); ++e) {
    const double before = station.epochs[e - 1].time_s, after = station.epochs[e].time_s;
    if (early >= before && late <= after) return (early - before) * (after - late) / (after - before);
  }
  return 0.0;
}

DriftModel stationCourse(const campaign::Campaign& campaign, const std::optional<metrology::TrackerNoise>& noise) {
  DriftModel result;
  result.motion = stationMotion(campaign, noise);
  result.rounds = result.motion;
  if (!result.motion.tested) {
    result.remark = result.motion.reason;
    return result;
  }
  findRate(result);
  if (!result.motion.moved) {
    result.course = StationCourse::still;
    result.remark = Remark(RemarkId::station_stood_still, result.motion.epochs.size());
    return result;
  }
  if (result.motion.deforming()) {
    result.remark = Remark(RemarkId::nests_deform);
    return result;
  }
  findJumps(campaign, *noise, result.motion);
  result.rounds = result.motion;
  StationMotion& motion = result.motion;
  std::vector<double> steady;
  const double first = motion.epochs.front().time_s, span = motion.epochs.back().time_s - first;
  for (const StationEpoch& epoch : motion.epochs) steady.push_back((epoch.time_s - first) / span);
  const Course drift = fitCourse(motion, steady);
  std::size_t at = 1;
  const Course jump = bestJump(motion, at);
  const bool jumped = jump.chi2 < drift.chi2;
  const Course& best = jumped ? jump : drift;
  const double dof = 6.0 * static_cast<double>(motion.epochs.size() - 2);
  constexpr double kFits = 3.0;  // chi2 per degree of freedom: rounds share the first one's noise
  const bool fits = best.chi2 < kFits * std::max(1.0, dof);
  for (const StationEpoch& epoch : motion.epochs)
    result.moved_by = std::max(result.moved_by, epoch.motion.tail<3>().norm());
  result.course = jumped && fits ? StationCourse::jumped : StationCourse::drifted;
  if (!fits) result.wander = wanderOf(motion.epochs);
  if (fits) {
    for (std::size_t e = 0; e < motion.epochs.size(); ++e) {
      StationEpoch& epoch = motion.epochs[e];
      epoch.motion = best.share[e] * best.motion;
      if (!jumped || e != at) epoch.jumped_at.reset();
    }
    if (jumped) motion.epochs[at].jumped_at = jumpTime(campaign, *noise, motion, at);
  }
  const bool jumped_once = result.course == StationCourse::jumped;
  result.remark = Remark(jumped_once ? RemarkId::station_jumped : RemarkId::station_wandered, result.moved_by);
  return result;
}

}  // namespace stiffscope::preparation
