#include "core/frames/position_equations.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/frames/arm_parameters.h"
#include "core/frames/remarks.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

namespace {

class RowMaker {
 public:
  RowMaker(const campaign::Campaign& campaign, const Frames& frames, const LoadingGeometry& geometry)
      : campaign_(campaign),
        geometry_(geometry),
        axes_(sweptAxes(frames, geometry.arm.axes_in_base_at_zero)),
        arm_(axes_),
        places_(geometry.arm.axes()),
        joints_(geometry.arm.joints()),
        steps_(places_.count(campaign.targets.size())) {}

  const ArmParameters& places() const { return places_; }
  Eigen::Index parameters() const { return steps_ + joints_; }

  Eigen::MatrixXd prior() const {
    Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(parameters(), parameters());
    for (Eigen::Index j = 0; j < geometry_.arm.axes(); ++j) {
      prior.block<4, 4>(4 * j, 4 * j) = axes_[static_cast<std::size_t>(j)].covariance.inverse();
    }
    prior.bottomRightCorner(joints_, joints_) = JointMatrix::Identity(joints_, joints_) / (kSagShare * kSagShare);
    return prior;
  }

  /// Rows of one posture but for the base's columns; `r0_from_loading` has brought the measured points into R0.
  void add(const campaign::StatePoints& state, const JointVector& q, const metrology::TrackerNoise& noise,
           AbsoluteRows& result) const {
    const Eigen::Isometry3d& r0_from_loading = *geometry_.r0_from_loading;
    const JointVector sagged = geometry_.sagged(q);
    const PlacedPosture posture(arm_, sagged);
    for (const campaign::ReflectorMean& mean : state.reflectors) {
      const auto& at_zero = geometry_.targets_at_zero[static_cast<std::size_t>(mean.target)];
      if (!at_zero) continue;
      AbsoluteRow row;
      row.pose = state.pose;
      row.target = mean.target;
      const Eigen::Vector3d modelled = posture.position(*at_zero);
      row.point = r0_from_loading * mean.point;
      row.residual = row.point - modelled;
      const Eigen::Matrix3d covariance = mean.absoluteCovariance(campaign_, noise);
      row.weight = (r0_from_loading.linear() * covariance * r0_from_loading.linear().transpose()).inverse();
      row.by_angles = posture.byAngles(modelled);
      row.jacobian = Eigen::MatrixXd::Zero(3, parameters());
      row.jacobian.leftCols(places_.axes()) = posture.byAxes(modelled);
      row.jacobian.middleCols<3>(places_.targetAt(static_cast<std::size_t>(mean.target))) = posture.byTarget();
      // The sag is proportional to each compliance: q_sagged = q + c tau.
      row.sag = sagged - q;
      row.jacobian.rightCols(joints_) = row.by_angles * row.sag.asDiagonal();
      result.rows.push_back(std::move(row));
    }
  }

 private:
  const campaign::Campaign& campaign_;
  const LoadingGeometry& geometry_;
  AxesAtStart axes_;
  PlacedArm arm_;
  ArmParameters places_;
  Eigen::Index joints_, steps_;
};

Remark missing(const campaign::Campaign& campaign, const Frames& frames, const LoadingGeometry& geometry,
               const std::optional<metrology::TrackerNoise>& noise) {
  if (!campaign.loading || !campaign.states) return Remark(RemarkId::no_absolute_readings);
  if (!noise) return Remark(RemarkId::tracker_noise_not_declared);
  for (std::size_t j = 0; j < frames.axes.size(); ++j) {
    if (!frames.axes[j].measured) return Remark(RemarkId::axis_not_measured, j + 1, frames.axes[j].reason);
  }
  if (!geometry.r0_from_loading) return Remark(RemarkId::loading_in_other_frame);
  return {};
}

}  // namespace

AbsoluteRows absoluteRows(const campaign::Campaign& campaign, const Frames& frames, const LoadingGeometry& geometry,
                          const std::vector<campaign::StatePoints>& states,
                          const std::optional<metrology::TrackerNoise>& noise) {
  AbsoluteRows result;
  result.reason = missing(campaign, frames, geometry, noise);
  if (!result.reason.empty()) return result;
  const RowMaker maker(campaign, frames, geometry);
  std::vector<const campaign::State*> unloaded(campaign.pose_ids.size(), nullptr);
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0) unloaded[static_cast<std::size_t>(state.pose)] = &state;
  }
  for (const campaign::StatePoints& state : states) {
    if (state.pose < 0 || state.step != 0) continue;
    const campaign::State* reported = unloaded[static_cast<std::size_t>(state.pose)];
    if (reported == nullptr) continue;
    maker.add(state, reported->q, *noise, result);
    result.poses.push_back(state.pose);
  }
  result.axes = geometry.arm.axes();
  result.joints = geometry.arm.joints();
  result.parameters = static_cast<int>(maker.parameters());
  result.prior = maker.prior();
  std::vector<bool> seen(campaign.targets.size(), false);
  for (const AbsoluteRow& row : result.rows) {
    seen[static_cast<std::size_t>(row.target)] = true;
    result.centre += row.point / static_cast<double>(result.rows.size());
  }
  for (AbsoluteRow& row : result.rows) {
    // The readings' motion moves what was read, which need not be near the model.
    row.jacobian.middleCols<6>(maker.places().baseAt()) = metrology::pointByFrameError(row.point - result.centre);
  }
  result.targets = static_cast<int>(std::count(seen.begin(), seen.end(), true));
  return result;
}

}  // namespace stiffscope::frames
