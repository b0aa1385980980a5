#include <utility>
#include <vector>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/identification/warnings.h"
#include "core/mistakes/controller_agreement.h"
#include "core/preparation/finding.h"

namespace stiffscope::audit {

namespace {

using campaign::ControllerModel;

/// What fitted axes explain, and what axes with springs do; a cause is named that leaves a quarter.
std::vector<Remark> patternOf(const mistakes::ControllerAgreement& poses) {
  constexpr double kExplained = 0.25;
  const auto explains = [&](const std::optional<double>& left) { return left && *left < kExplained * *poses.miss; };
  if (explains(poses.geometry_miss)) return {Remark(ControllerRemarkId::poses_of_other_geometry, *poses.geometry_miss)};
  if (explains(poses.elastic_miss)) return {Remark(ControllerRemarkId::poses_sag, *poses.elastic_miss)};
  if (poses.geometry_miss) return {Remark(ControllerRemarkId::poses_unexplained, *poses.geometry_miss)};
  return {};
}

/// Where the poses are the URDF's.
void judgeAgreement(const campaign::Campaign& campaign, preparation::AuditCheck& check, std::vector<Remark>& more) {
  if (campaign.controller_model != ControllerModel::absolute_accuracy) return;
  check.verdict = preparation::AuditVerdict::warn;
  more.push_back(Remark(ControllerRemarkId::accuracy_not_seen));
}

/// Where they are not: by mistake, or because the controller has another model of its arm.
void judgeDifference(const campaign::Campaign& campaign, const mistakes::ControllerAgreement& poses,
                     preparation::AuditCheck& check, std::vector<Remark>& more) {
  using preparation::AuditVerdict;
  if (!poses.cures.empty()) {
    check.verdict = AuditVerdict::fail;
    check.where = poses.cures.size() == 1 ? poses.cures.front().where : Remark();
    more.push_back(Remark(ControllerRemarkId::poses_mended, poses.cures.size()));
    return;
  }
  if (poses.position_miss && *poses.position_miss <= *check.limit) {
    check.verdict = AuditVerdict::fail;
    more.push_back(Remark(ControllerRemarkId::turns_otherwise, *poses.position_miss));
    return;
  }
  more = patternOf(poses);
  const bool another_arm = *poses.miss > identification::kMissedGeometry;
  check.verdict = another_arm ? AuditVerdict::fail : AuditVerdict::warn;
  check.where = preparation::atRow(campaign.states->file, poses.line);
  if (another_arm) {
    more.push_back(Remark(ControllerRemarkId::poses_of_other_arm));
    return;
  }
  if (campaign.controller_model == ControllerModel::absolute_accuracy) {
    check.verdict = AuditVerdict::pass;
    check.limit = identification::kMissedGeometry;
    check.limit_source = Remark(LimitId::machines_off_drawing);
    check.where = Remark();
    more.push_back(Remark(ControllerRemarkId::accuracy_as_declared));
    return;
  }
  more.push_back(Remark(campaign.controller_model == ControllerModel::nominal
                            ? ControllerRemarkId::declared_nominal
                            : ControllerRemarkId::accuracy_undeclared));
}

}  // namespace

Findings checkControllerPoses(const AuditInput& input) {
  const mistakes::ControllerAgreement& poses = input.controller;
  const std::string id = "controller_poses";
  if (poses.postures == 0) return {preparation::notTestable(id, Remark(MissingId::no_controller_poses))};
  if (!poses.miss)
    return {preparation::notTestable(
        id, Remark(MissingId::few_controller_poses, poses.postures, mistakes::ControllerAgreement::kFewest))};
  preparation::AuditCheck check;
  check.id = id;
  check.value = *poses.miss;
  check.limit = kControllerDigits;
  check.limit_source = Remark(LimitId::controllers_compute);
  std::vector<Remark> more;
  if (*poses.miss <= kControllerDigits)
    judgeAgreement(input.campaign, check, more);
  else
    judgeDifference(input.campaign, poses, check, more);
  if (!poses.still.empty()) more.push_back(Remark(ControllerRemarkId::joints_not_compared, poses.still));
  check.message =
      Remark(ControllerRemarkId::controller_states, poses.postures, *poses.miss, poses.largest, std::move(more));
  return {check};
}

}  // namespace stiffscope::audit
