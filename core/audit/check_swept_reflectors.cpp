#include <algorithm>
#include <cmath>
#include <utility>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/audit/sag_doubt.h"
#include "core/campaign/row_names.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::audit {

namespace {

/// Of two lines: place at the middle between the circles, and direction.
struct LineDifference {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();

  /// In parts of its variance.
  double squared() const { return mahalanobisSquared(Eigen::VectorXd(value), covariance); }
};

LineDifference differenceOf(const metrology::MeasuredLine& common, const metrology::AxisFit& a,
                            const metrology::AxisFit& b, double height) {
  LineDifference found;
  const Eigen::Vector3d at = common.line.point + height * common.line.direction;
  const auto add = [&](const metrology::AxisFit& fit, double sign) {
    const metrology::Line& line = fit.axis.line;
    const double sense = line.direction.dot(common.line.direction) < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d direction = sense * line.direction;
    const double along = (at - line.point).dot(direction);
    const Eigen::Vector3d place = line.point + along * direction;
    Eigen::Matrix2d turn;  // from the fit's own directions across to the common ones
    turn << common.across_u.dot(fit.axis.across_u), common.across_u.dot(fit.axis.across_v),
        common.across_v.dot(fit.axis.across_u), common.across_v.dot(fit.axis.across_v);
    Eigen::Matrix4d to_common = Eigen::Matrix4d::Zero();
    to_common.topLeftCorner<2, 2>() = turn;
    to_common.topRightCorner<2, 2>() = sense * along * turn;
    to_common.bottomRightCorner<2, 2>() = sense * turn;
    found.covariance += to_common * fit.axis.covariance * to_common.transpose();
    found.value.head<2>() += sign * Eigen::Vector2d(common.across_u.dot(place - at), common.across_v.dot(place - at));
    found.value.tail<2>() += sign * Eigen::Vector2d(common.across_u.dot(direction), common.across_v.dot(direction));
  };
  add(a, 1.0);
  add(b, -1.0);
  return found;
}

/// What two reflectors say of an axis they turn about.
struct ReflectorPair {
  std::size_t axis = 0, first = 0, second = 0;  ///< the reflectors by their circles
  LineDifference difference;
};

/// Of all pairs of reflectors that say something of their axis by themselves. `measured`: of the axes to which the
/// differences are referred, the same for circles under another sag.
std::vector<ReflectorPair> reflectorPairs(const frames::MeasuredAxes& measured, const SweptCircles& axes) {
  std::vector<ReflectorPair> pairs;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const metrology::AxisFit& common = measured[axis].fit;
    if (!common.determined) continue;
    std::vector<std::pair<std::size_t, metrology::AxisFit>> own;
    for (std::size_t k = 0; k < axes[axis].size(); ++k) {
      if (common.circles[k].radius < kReflectorRadius) continue;
      metrology::AxisFit fit = metrology::fitAxis({axes[axis][k].readings});
      if (fit.determined) own.emplace_back(k, std::move(fit));
    }
    for (std::size_t a = 0; a < own.size(); ++a) {
      for (std::size_t b = a + 1; b < own.size(); ++b) {
        const double height = 0.5 * (common.circles[own[a].first].height + common.circles[own[b].first].height);
        pairs.push_back(
            {axis, own[a].first, own[b].first, differenceOf(common.axis, own[a].second, own[b].second, height)});
      }
    }
  }
  return pairs;
}

const ReflectorPair& farthestApart(const std::vector<ReflectorPair>& pairs) {
  return *std::max_element(pairs.begin(), pairs.end(), [](const ReflectorPair& a, const ReflectorPair& b) {
    return a.difference.squared() < b.difference.squared();
  });
}

/// The sag that was taken off moves what the reflectors say; how well it is known is in the covariance then.
void addDoubtOfSag(const AuditInput& input, std::vector<ReflectorPair>& pairs) {
  std::vector<Eigen::Vector4d> as_found;
  for (const ReflectorPair& pair : pairs) as_found.push_back(pair.difference.value);
  for (const AuditInput& other : underOtherSags(input)) {
    const std::vector<ReflectorPair> moved = reflectorPairs(input.frames.axes, sweptCircles(other));
    if (moved.size() != pairs.size()) continue;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector4d by_sag = moved[i].difference.value - as_found[i];
      pairs[i].difference.covariance += by_sag * by_sag.transpose();
    }
  }
}

preparation::AuditCheck agreementCheck(const AuditInput& input, const SweptCircles& axes) {
  preparation::AuditCheck check;
  check.id = "axis_agreement";
  std::vector<ReflectorPair> pairs = reflectorPairs(input.frames.axes, axes);
  if (pairs.empty()) return preparation::notTestable("axis_agreement", Remark(MissingId::no_two_reflectors_off_axis));
  const double limit = numerics::chiSquareLimit(preparation::kLevel / static_cast<double>(pairs.size()), 4.0);
  if (farthestApart(pairs).difference.squared() > limit) addDoubtOfSag(input, pairs);
  const ReflectorPair& farthest = farthestApart(pairs);
  const double worst = farthest.difference.squared();
  check.where = Remark(RemarkId::at_axis_and_pair, farthest.axis + 1,
                       campaign::targetName(input.campaign, axes[farthest.axis][farthest.first].target),
                       campaign::targetName(input.campaign, axes[farthest.axis][farthest.second].target));
  check.value = std::sqrt(worst / 4.0);
  check.limit = std::sqrt(limit / 4.0);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square_of_pairs, pairs.size()));
  if (worst > limit) check.verdict = preparation::AuditVerdict::warn;
  check.message = Remark(worst > limit ? RemarkId::reflectors_disagree : RemarkId::reflectors_agree, *check.value);
  return check;
}

preparation::AuditCheck onAxisCheck(const AuditInput& input, const SweptCircles& axes) {
  preparation::AuditCheck check;
  check.id = "reflector_on_axis";
  check.limit = kReflectorRadius;
  check.limit_source = Remark(LimitId::reflector_radius);
  double least = INFINITY;
  std::vector<Remark> names, near;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const metrology::AxisFit& fit = input.frames.axes[axis].fit;
    if (!fit.determined) continue;
    for (std::size_t k = 0; k < axes[axis].size(); ++k) {
      const double radius = fit.circles[k].radius;
      if (radius < kReflectorRadius) {
        names.push_back(
            Remark(RemarkId::at_reflector, campaign::targetName(input.campaign, axes[axis][k].target), axis + 1));
        near.push_back(Remark(RemarkId::reflector_near_axis, names.back(), radius));
      }
      least = std::min(least, radius);
    }
  }
  check.value = least;
  check.message = Remark(RemarkId::well_off_axes);
  if (near.empty()) return check;
  check.verdict = preparation::AuditVerdict::warn;
  check.where = Remark(RemarkId::at_reflectors, std::move(names));
  check.message = Remark(RemarkId::on_axis, std::move(near));
  return check;
}

}  // namespace

Findings checkSweptReflectors(const AuditInput& input) {
  if (!input.campaign.circle_sweeps) {
    return {preparation::notTestable("axis_agreement", Remark(MissingId::no_sweeps)),
            preparation::notTestable("reflector_on_axis", Remark(MissingId::no_sweeps))};
  }
  const auto axes = sweptCircles(input);
  const Remark none = noCircles(input.frames.axes);
  if (!none.empty()) return {agreementCheck(input, axes), preparation::notTestable("reflector_on_axis", none)};
  return {agreementCheck(input, axes), onAxisCheck(input, axes)};
}

}  // namespace stiffscope::audit
