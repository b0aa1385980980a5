#include "core/extended_model/corrected_campaign.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "core/effects/all.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/extended_model/effect_offsets.h"
#include "core/identification/outliers.h"
#include "core/io/input_error.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::extended_model {

namespace {

const robot::LinkFrame* linkNamed(const robot::Robot& robot, const std::string& name) {
  for (const robot::LinkFrame& link : robot.links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

/// `by`: in flange axes, m.
void moveLoadPoint(const Eigen::Vector3d& by, campaign::Campaign& campaign) {
  campaign::LoadCell& cell = *campaign.load_cell;
  const robot::LinkFrame* parent = linkNamed(campaign.robot, cell.parent);
  if (parent == nullptr || parent->body != 6) {
    throw io::InputError({"--with"}, std::string(effects::idOf(effects::Effect::load_point_error)),
                         fmt::format("the load cell's parent {} does not move with the flange: its point cannot be "
                                     "corrected by one number",
                                     cell.parent));
  }
  cell.parent_from_cell.pretranslate(parent->base_from_link_at_zero.linear().transpose() *
                                     campaign.robot.base_from_flange_at_zero.linear() * by);
}

/// Of a rotation vector.
Eigen::Matrix3d turnOf(const Eigen::Vector3d& w) {
  const double size = w.norm();
  if (size == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(size, w / size).toRotationMatrix();
}

/// The day's states under load by pose and step.
std::map<std::pair<int, int>, const effects::ArmState*> loadedStates(const EffectFit& effects) {
  std::map<std::pair<int, int>, const effects::ArmState*> states;
  for (const auto& [pose, posture] : effects.day) {
    for (std::size_t s = 1; s < posture.states.size(); ++s) states[{pose, posture.states[s].step}] = &posture.states[s];
  }
  return states;
}

/// What the effects correct in wrenches and frame, as the fit's own equations have it.
effects::Corrections correctionsBy(const EffectFit& effects) {
  effects::LinearizationPoint at = effects.fit.state.at;
  effects::Corrections corrections;
  for (const diagnosis::ChosenModel& one : effects.fit.set.models) {
    const effects::EffectModel& model = effects.input->models[one.model];
    if (!model.correct) continue;
    Eigen::VectorXd own = effects.parametersOf(one);
    model.correct(at.compliance, at, corrections, own);
  }
  return corrections;
}

/// Corrects the load cell's declared point, and the readings in `states` by a finite rotation and a missing force.
/// Throws InputError where the point does not move with the flange.
void correctWrenches(const EffectFit& effects, const effects::Corrections& by, campaign::Campaign& campaign) {
  if (!by.load_point.isZero(0.0)) moveLoadPoint(by.load_point, campaign);
  const Eigen::Matrix3d turn = turnOf(by.cell_turn);
  const Eigen::Vector3d weight = -by.missing_weight * effects.fit.state.at.r0_from_base_link.linear().col(2);
  const std::map<std::pair<int, int>, const effects::ArmState*> states = loadedStates(effects);
  for (campaign::State& row : campaign.states->rows) {
    const auto found = states.find({row.pose, row.step});
    if (found == states.end()) continue;
    const effects::ArmState* state = found->second;
    auto force = row.wrench_in_cell.head<3>();
    auto moment = row.wrench_in_cell.tail<3>();
    force = turn * Eigen::Vector3d(force);
    moment = turn * Eigen::Vector3d(moment);
    if (!state->loaded) continue;
    const Eigen::Vector3d arm = state->flange.linear() * effects.fit.state.at.load_offset;
    force += by.cell_force + state->cell_axes.transpose() * weight;
    moment += state->cell_axes.transpose() * arm.cross(weight);
  }
}

/// Takes what the effects add (PostureOffsets) off readings.
class Shifter {
 public:
  /// `frame`: motion of the loading's frame, as frame_error has it, that is undone first.
  Shifter(const EffectFit& effects, const Vector6d& frame)
      : effects_(effects), frame_(frame), state_(effects.fit.state) {
    for (const auto& [pose, posture] : effects.day) postures_[pose] = &posture.states;
  }

  void loading(const campaign::States& states, campaign::Loading& table) {
    for (const campaign::State& row : states.rows) {
      if (row.step != 0 || postures_.count(row.pose) > 0) continue;
      resting_.push_back({atRest(row.pose, row.q, row.time_s)});
      postures_[row.pose] = &resting_.back();
    }
    const Eigen::Isometry3d r0_from_loading = state_.geometry.r0_from_loading.value_or(Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d loading_from_r0 = r0_from_loading.inverse();
    const Eigen::Isometry3d corrected =
        metrology::motionAbout(state_.at.epoch_centre, frame_).inverse() * r0_from_loading;
    const auto places = unloadedPlaces(table, corrected);
    for (campaign::LoadingReading& row : table.rows) {
      const Eigen::Vector3d point = corrected * row.point;
      row.point =
          loading_from_r0 * (point - offsetIn(row.pose, row.step, row.target, places.at({row.pose, row.target})));
    }
  }

  void displacements(campaign::Displacements& table) {
    const Eigen::Matrix3d table_from_r0 =
        state_.geometry.displacements_in_r0.value_or(Eigen::Matrix3d::Identity()).transpose();
    for (campaign::Displacement& row : table.rows) {
      const auto known = postures_.find(row.pose);
      const auto& at_zero = state_.geometry.targets_at_zero[static_cast<std::size_t>(row.target)];
      if (known == postures_.end() || !at_zero) continue;
      const Eigen::Vector3d place = known->second->front().posture.motion[6] * *at_zero;
      row.displacement -=
          table_from_r0 * (offsetIn(row.pose, row.step, row.target, place) - offsetIn(row.pose, 0, row.target, place));
    }
  }

  template <class Row>
  void sweep(std::vector<Row>& rows) const {
    const Eigen::Matrix3d sweeps_from_r0 = state_.r0_from_sweeps.linear().transpose();
    for (Row& row : rows) {
      const effects::PostureStates states{atRest(-1, row.q, row.time_s)};
      const PostureOffsets offsets(effects_, states, {});
      row.point -= sweeps_from_r0 * offsets.of(row.target, state_.r0_from_sweeps * row.point).front();
    }
  }

 private:
  using Key = std::pair<int, int>;  // pose and target

  /// The arm at rest, not loaded, with the effects' own turns in.
  effects::ArmState atRest(int pose, const Vector6d& q, double time_s) const {
    effects::ArmState state = effects::gravityEquilibrium(state_.geometry, state_.at, q);
    state.pose = pose;
    state.time_s = time_s;
    return state;
  }

  /// Where reflectors stand in step 0 (mean of its readings), else wherever they were read.
  static std::map<Key, Eigen::Vector3d> unloadedPlaces(const campaign::Loading& table,
                                                       const Eigen::Isometry3d& r0_from_loading) {
    std::map<Key, std::pair<Eigen::Vector3d, int>> sums;
    for (const bool unloaded : {true, false}) {
      std::map<Key, std::pair<Eigen::Vector3d, int>> here;
      for (const campaign::LoadingReading& row : table.rows) {
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
    const effects::PostureStates& states = *known->second;
    const Key key{pose, target};
    if (offsets_.count(key) == 0) {
      const PostureOffsets& own = by_pose_.try_emplace(pose, effects_, states, PostureOffsets::Which{}).first->second;
      offsets_[key] = own.of(target, place);
    }
    for (std::size_t s = 0; s < states.size(); ++s) {
      if (states[s].step == step) return offsets_[key][s];
    }
    return Eigen::Vector3d::Zero();
  }

  const EffectFit& effects_;
  Vector6d frame_;
  const diagnosis::SystemState& state_;
  std::map<int, const effects::PostureStates*> postures_;
  std::deque<effects::PostureStates> resting_;  ///< those that were never loaded
  std::map<int, PostureOffsets> by_pose_;
  std::map<Key, std::vector<Eigen::Vector3d>> offsets_;
};

/// Every reading of loading, displacements and, where they took part in the fit, sweeps.
void shiftReadings(const EffectFit& effects, const Vector6d& frame, campaign::Campaign& campaign) {
  Shifter shifter(effects, frame);
  if (campaign.loading && campaign.states && effects.fit.state.geometry.r0_from_loading)
    shifter.loading(*campaign.states, *campaign.loading);
  if (campaign.displacements) shifter.displacements(*campaign.displacements);
  if (!effects.input->sweeps) return;
  if (campaign.circle_sweeps) shifter.sweep(campaign.circle_sweeps->rows);
  if (campaign.wrist_sweep) shifter.sweep(campaign.wrist_sweep->rows);
}

void leaveOutUnknown(const EffectFit& effects, campaign::Campaign& campaign,
                     std::vector<identification::LeftOutPosture>& left_out) {
  std::set<int> known;
  for (const auto& [pose, posture] : effects.day) known.insert(pose);
  std::vector<identification::OutlyingPosture> without;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step == 0 || !known.insert(row.pose).second) continue;
    without.emplace_back();
    without.back().posture = row.pose;
    left_out.push_back(
        {campaign.pose_ids[static_cast<std::size_t>(row.pose)], Remark(RemarkId::not_read_in_all_steps)});
  }
  if (!without.empty()) campaign = identification::withoutPostures(campaign, without);
}

}  // namespace

campaign::Campaign correctedFor(const EffectFit& effects, const campaign::Campaign& campaign,
                                std::vector<identification::LeftOutPosture>& left_out) {
  campaign::Campaign result = campaign;
  if (effects.fit.set.models.empty()) return result;
  leaveOutUnknown(effects, result, left_out);
  const effects::Corrections corrections = correctionsBy(effects);
  correctWrenches(effects, corrections, result);
  shiftReadings(effects, corrections.frame, result);
  return result;
}

}  // namespace stiffscope::extended_model
