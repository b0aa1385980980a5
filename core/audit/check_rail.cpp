#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/identification/identifiability.h"
#include "core/preparation/finding.h"

namespace stiffscope::audit {

namespace {

using preparation::AuditVerdict;

preparation::AuditCheck straightCheck(const preparation::RailCourse& rail) {
  preparation::AuditCheck check;
  check.id = "rail_straight";
  const identification::TrustLimits trust;
  check.value = std::hypot(rail.along_rms, rail.across_rms);
  check.limit = trust.position;
  check.limit_source = Remark(LimitId::trusted_places);
  check.message =
      Remark(RemarkId::rail_leaves, rail.along_rms, rail.across_rms, rail.lowest, rail.highest, rail.farthest);
  if (*check.value <= *check.limit) return check;
  check.verdict = *check.value > kNoRail ? AuditVerdict::fail : AuditVerdict::warn;
  check.where = preparation::atRow(rail.farthest_file, rail.farthest_line);
  return check;
}

preparation::AuditCheck scaleCheck(const preparation::RailCourse& rail) {
  preparation::AuditCheck check;
  check.id = "rail_scale";
  check.value = std::abs(rail.scale() - 1.0);
  check.limit = kRailScale;
  check.limit_source = Remark(LimitId::travels_as_reported);
  check.message = Remark(RemarkId::rail_travels, rail.scale(), rail.scaleSd());
  if (*check.value <= *check.limit) return check;
  check.impossible = *check.value > kOtherUnit;
  check.verdict = check.impossible ? AuditVerdict::fail : AuditVerdict::warn;
  return check;
}

preparation::AuditCheck directionCheck(const AuditInput& input, const preparation::RailCourse& rail) {
  preparation::AuditCheck check;
  check.id = "rail_direction";
  const frames::ArmInR0& arm = input.frames.arm;
  const bool in_points = input.campaign.rail_sweep->frame == campaign::PointFrame::tracker;
  if (in_points && !arm.points_placed) return preparation::notTestable(check.id, Remark(MissingId::no_sweeps));
  const Eigen::Matrix3d r0_from_points = in_points ? arm.r0_from_points.linear() : arm.r0_from_base_link.linear();
  const Eigen::Vector3d stated = arm.r0_from_base_link.linear() * input.campaign.robot.rail->direction_in_base;
  const double cosine = stated.dot((r0_from_points * rail.per_metre).normalized());
  check.value = std::acos(std::clamp(cosine, -1.0, 1.0));
  check.limit = kRailDirection;
  check.limit_source = Remark(LimitId::rails_are_laid);
  constexpr double kReversed = std::numbers::pi / 2.0;
  check.message = Remark(*check.value > kReversed ? RemarkId::rail_reversed : RemarkId::rail_runs, *check.value);
  if (*check.value <= *check.limit) return check;
  check.verdict = *check.value > kOtherRail ? AuditVerdict::fail : AuditVerdict::warn;
  return check;
}

}  // namespace

Findings checkRail(const AuditInput& input) {
  if (!input.campaign.robot.rail) return {};
  if (!input.rail) {
    const Remark missing(MissingId::no_rail_sweep);
    return {preparation::notTestable("rail_straight", missing), preparation::notTestable("rail_scale", missing),
            preparation::notTestable("rail_direction", missing)};
  }
  return {straightCheck(*input.rail), scaleCheck(*input.rail), directionCheck(input, *input.rail)};
}

}  // namespace stiffscope::audit
