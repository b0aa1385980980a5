#include "core/improved/shifted_readings.h"

#include <map>

#include "core/diagnosis/rest_state.h"
#include "metrology/rigid_motion.h"

namespace stiffscope {

namespace {

class Shifter {
 public:
  Shifter(const EffectFit& effects, const Eigen::VectorXd& parameters, const ShiftOptions& options)
      : effects_(effects), parameters_(parameters), options_(options), state_(effects.fit.state) {
    for (const GapPosture& posture : effects.fit.data.postures) postures_[posture.pose] = posture.states;
  }

  void loading(const States& states, Loading& table) {
    for (const State& row : states.rows) {
      if (row.step == 0 && postures_.count(row.pose) == 0) postures_[row.pose] = {atRest(row.pose, row.q, row.time_s)};
    }
    const Eigen::Isometry3d r0_from_loading = state_.geometry.r0_from_loading.value_or(Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d loading_from_r0 = r0_from_loading.inverse();
    const Eigen::Isometry3d corrected = motionAbout(state_.at.epoch_centre, options_.frame).inverse() * r0_from_loading;
    const auto places = unloadedPlaces(table, corrected);
    for (LoadingReading& row : table.rows) {
      const Eigen::Vector3d point = corrected * row.point;
      row.point = loading_from_r0 * (point - offsetIn(row.pose, row.step, row.target, places.at({row.pose, row.target})));
    }
  }

  void displacements(Displacements& table) {
    const Eigen::Matrix3d table_from_r0 =
        state_.geometry.displacements_in_r0.value_or(Eigen::Matrix3d::Identity()).transpose();
    for (Displacement& row : table.rows) {
      const auto known = postures_.find(row.pose);
      const auto& at_zero = state_.geometry.targets_at_zero[static_cast<std::size_t>(row.target)];
      if (known == postures_.end() || !at_zero) continue;
      const Eigen::Vector3d place = known->second.front().posture.motion[6] * *at_zero;
      row.displacement -= table_from_r0 * (offsetIn(row.pose, row.step, row.target, place) -
                                           offsetIn(row.pose, 0, row.target, place));
    }
  }

  template <class Row>
  void sweep(std::vector<Row>& rows) const {
    const Eigen::Matrix3d sweeps_from_r0 = state_.r0_from_sweeps.linear().transpose();
    for (Row& row : rows) {
      const PostureStates states{atRest(-1, row.q, row.time_s)};
      const PostureOffsets offsets(effects_, parameters_, states, options_.which);
      row.point -= sweeps_from_r0 * offsets.of(row.target, state_.r0_from_sweeps * row.point).front();
    }
  }

 private:
  using Key = std::pair<int, int>;  // pose and target

  /// The arm at rest, not loaded, with the effects' own turns in.
  ArmState atRest(int pose, const Vector6d& q, double time_s) const {
    ArmState state = restState(state_.geometry, state_.at, q);
    state.pose = pose;
    state.time_s = time_s;
    return state;
  }

  /// Where reflectors stand in step 0 (mean of its readings), else wherever they were read.
  static std::map<Key, Eigen::Vector3d> unloadedPlaces(const Loading& table, const Eigen::Isometry3d& r0_from_loading) {
    std::map<Key, std::pair<Eigen::Vector3d, int>> sums;
    for (const bool unloaded : {true, false}) {
      std::map<Key, std::pair<Eigen::Vector3d, int>> here;
      for (const LoadingReading& row : table.rows) {
        const Key key{row.pose, row.target};
        if ((row.step == 0) != unloaded || sums.count(key) > 0) continue;
        auto& [sum, count] = here.try_emplace(key, Eigen::Vector3d::Zero(), 0).first->second;
        sum += r0_from_loading * row.point, ++count;
      }
      sums.merge(here);
    }
    std::map<Key, Eigen::Vector3d> places;
    for (const auto& [key, sum] : sums) places[key] = sum.first / sum.second;
    return places;
  }

  Eigen::Vector3d offsetIn(int pose, int step, int target, const Eigen::Vector3d& place) {
    const auto known = postures_.find(pose);
    if (known == postures_.end()) return Eigen::Vector3d::Zero();
    const PostureStates& states = known->second;
    const Key key{pose, target};
    if (offsets_.count(key) == 0) {
      const PostureOffsets& own =
          by_pose_.try_emplace(pose, effects_, parameters_, states, options_.which).first->second;
      offsets_[key] = own.of(target, place);
    }
    for (std::size_t s = 0; s < states.size(); ++s) {
      if (states[s].step == step) return offsets_[key][s];
    }
    return Eigen::Vector3d::Zero();
  }

  const EffectFit& effects_;
  const Eigen::VectorXd& parameters_;
  const ShiftOptions& options_;
  const GapState& state_;
  std::map<int, PostureStates> postures_;
  std::map<int, PostureOffsets> by_pose_;
  std::map<Key, std::vector<Eigen::Vector3d>> offsets_;
};

}  // namespace

void shiftReadings(const EffectFit& effects, const Eigen::VectorXd& parameters, const ShiftOptions& options,
                   Campaign& campaign) {
  Shifter shifter(effects, parameters, options);
  if (campaign.loading && campaign.states && effects.fit.state.geometry.r0_from_loading)
    shifter.loading(*campaign.states, *campaign.loading);
  if (campaign.displacements) shifter.displacements(*campaign.displacements);
  if (!options.sweeps || !effects.input->sweeps) return;
  if (campaign.circle_sweeps) shifter.sweep(campaign.circle_sweeps->rows);
  if (campaign.wrist_sweep) shifter.sweep(campaign.wrist_sweep->rows);
}

}  // namespace stiffscope
