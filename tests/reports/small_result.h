#pragma once

#include <cmath>
#include <vector>
#include "core/campaign/campaign.h"
#include "core/frames/remarks.h"
#include "core/identification/identify.h"
#include "core/identification/remarks.h"
#include "tests/fixtures/example_arm.h"

namespace stiffscope {

/// A result made by hand, with round numbers, so that what the page and the pictures show of it is known:
/// three postures "A", "B", "C" under 1 kN; P_wrist moves by 1, 3 and 2 mm; DPP and PP leave a tenth and a
/// fifth of that; joint 1 is not identifiable, joint 4 is negative by PP; CP is not available.
struct SmallResult {
  campaign::Campaign campaign;
  identification::Identification identification{6};

  explicit SmallResult(campaign::DoubleEncoder state = campaign::DoubleEncoder::active, double scale = 1.0) {
    campaign.name = "small";
    campaign.date = "2026-11-21";
    campaign.robot = exampleArm();
    campaign.double_encoder = state;
    campaign.targets = {{"P10", {}}, {"P11", {}}, {"P12", {}}};
    campaign.pose_ids = {"A", "B", "C"};
    campaign.inputs = {{"campaign.xml", "0123456789abcdef"}};
    identification.step = 1;
    identification.frames.arm.arm = campaign.robot;
    identification.frames.wrist.reason = Remark(frames::RemarkId::no_wrist_sweep);
    identification.frames.wrist.q = JointVector::Zero(6);
    identification.frames.wrist.misses = {{3}, {4}};
    identification.frames.axes.assign(6, frames::MeasuredAxis(6));
    for (frames::MeasuredAxis& axis : identification.frames.axes)
      axis.reason = Remark(frames::RemarkId::no_circle_sweeps);
    identification.frames.links.resize(5);
    for (int pose = 0; pose < 3; ++pose) addCase(pose, scale * 1e-3 * (pose == 0 ? 1 : pose == 1 ? 3 : 2));
    for (std::size_t j = 1; j < 6; ++j) identification.identifiability.joints[j].identifiable = true;
    identification.identifiability.joints[0].reason = Remark(identification::RemarkId::load_hangs, 1, 20.0, 1.0);
    identification.identifiability.load_hangs = true;
    method(identification::Method::complete_pose).reason = Remark(identification::RemarkId::flange_pose_not_everywhere);
    fill(method(identification::Method::partial_pose), 0.2);
    fill(method(identification::Method::decoupled_partial_pose), 0.1);
    method(identification::Method::partial_pose).estimate.compliance[3] = -4e-6;
  }

  identification::MethodResult& method(identification::Method which) {
    return identification.methods[static_cast<std::size_t>(which)];
  }

 private:
  void addCase(int pose, double displacement) {
    identification::LoadCase load_case;
    load_case.pose = pose;
    load_case.q = load_case.servo = load_case.q_sagged = JointVector::Zero(6);
    load_case.axes = robot::axesAt(campaign.robot, robot::postureAt(campaign.robot, JointVector::Zero(6)));
    load_case.wrench.force = {0, 0, -1000};
    const Eigen::Vector3d move(0, 0, -displacement), flange(1.995, 0, 2.31);
    for (int target = 0; target < 3; ++target) {
      const Eigen::Vector3d place = flange + 0.2 * Eigen::Vector3d::Unit(target);
      load_case.targets.push_back({target, place, place + 2.0 * move, 1, 1});
    }
    identification.cases.push_back(load_case);
    const Eigen::Vector3d wrist(1.695, 0, 2.31);
    identification.wrist.push_back({wrist, wrist + move});
    identification.wrist_displacement.push_back(displacement);
    identification.target_displacement.push_back(2.0 * displacement);
  }

  /// Leaves `share` of every displacement: its rows predict the rest through joint 2 alone.
  void fill(identification::MethodResult& result, double share) {
    result.available = true;
    identification::StiffnessEstimate& estimate = result.estimate;
    estimate.compliance << 0, 0.2e-6, 0.25e-6, 2e-6, 4e-6, 10e-6;
    estimate.covariance = JointMatrix::Zero(6, 6);
    estimate.scatter_dof.setOnes();
    for (int j = 1; j < 6; ++j) estimate.covariance(j, j) = std::pow(0.1 * estimate.compliance[j], 2);
    estimate.identifiable = {false, true, true, true, true, true};
    for (std::size_t i = 0; i < identification.cases.size(); ++i) {
      const double displacement = identification.wrist_displacement[i];
      identification::CaseEquations wrist{Eigen::MatrixXd::Zero(3, 6), Eigen::Vector3d(0, 0, -displacement)};
      wrist.matrix(2, 1) = -(1.0 - share) * displacement / estimate.compliance[1];
      result.wrist_rows.push_back(wrist);
      result.target_rows.push_back({wrist.matrix.replicate(3, 1), wrist.right.replicate(3, 1)});
      result.wrist_residual.push_back(share * displacement);
      result.target_residual.push_back(share * 2.0 * displacement);
    }
    result.subsets.size = 2;
    result.subsets.of = 3;
    result.subsets.every_subset = true;
    for (const double factor : {0.9, 1.0, 1.1}) result.subsets.compliances.push_back(factor * estimate.compliance);
    result.at_wrist = identification::Compensation{1.0 - share, {0.95, 0.85, 0.9}};
    result.at_targets = identification::Compensation{1.0 - share, {0.94, 0.84, 0.89}};
  }
};

}  // namespace stiffscope
