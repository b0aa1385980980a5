#include "core/extended_model/extend_model.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/effects/all.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/extended_model/effect_offsets.h"
#include "core/identification/outliers.h"
#include "core/io/input_error.h"
#include "core/numerics/parallel.h"

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
  if (parent == nullptr || parent->body != campaign.robot.axes()) {
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

/// The day's state under load of a pose and step; null where there is none.
const effects::CompactPosture::OfState* loadedState(const DayPosture& posture, int step) {
  const auto& states = posture.states.ofStates();
  const auto found = std::find_if(states.begin() + 1, states.end(),
                                  [&](const effects::CompactPosture::OfState& one) { return one.step == step; });
  return found == states.end() ? nullptr : &*found;
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
  const Eigen::Vector3d weight = by.missing_weight * effects.fit.state.at.down;
  for (campaign::State& row : campaign.states->rows) {
    const auto found = effects.day.find(row.pose);
    if (found == effects.day.end()) continue;
    const effects::CompactPosture::OfState* state = loadedState(found->second, row.step);
    if (state == nullptr) continue;
    auto force = row.wrench_in_cell.head<3>();
    auto moment = row.wrench_in_cell.tail<3>();
    force = turn * Eigen::Vector3d(force);
    moment = turn * Eigen::Vector3d(moment);
    if (!state->loaded) continue;
    const Eigen::Vector3d arm = found->second.states.flange().linear() * effects.fit.state.at.load_offset;
    force += by.cell_force + state->cell_axes.transpose() * weight;
    moment += state->cell_axes.transpose() * arm.cross(weight);
  }
}

/// Takes what the effects add (PostureOffsets) off readings.
class Shifter {
 public:
  /// `frame`: motion of the loading's frame, as frame_error has it, that is undone first.
  Shifter(const EffectFit& effects, const Vector6d& frame, std::size_t poses)
      : effects_(effects), frame_(frame), state_(effects.fit.state), poses_(poses) {}

  void loading(const campaign::States& states, campaign::Loading& table) const {
    std::vector<const campaign::State*> resting(poses_, nullptr);  // those that were never loaded
    for (const campaign::State& row : states.rows) {
      const campaign::State*& rest = resting[indexOf(row.pose)];
      if (row.step == 0 && rest == nullptr && !effects_.day.contains(row.pose)) rest = &row;
    }
    const auto statesOf = [&](int pose) -> effects::PostureStates {
      const campaign::State* const rest = resting[indexOf(pose)];
      if (rest == nullptr) return effects_.statesOf(pose);
      return {atRest(pose, rest->q, rest->time_s, rest->carriage)};
    };
    const Eigen::Isometry3d r0_from_loading = state_.geometry.r0_from_loading.value_or(Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d loading_from_r0 = r0_from_loading.inverse();
    std::vector<std::optional<Eigen::Isometry3d>> by_pose(poses_);
    for (const campaign::State& row : states.rows) {
      std::optional<Eigen::Isometry3d>& here = by_pose[indexOf(row.pose)];
      if (!here) here = state_.at.withoutMovedInstrument(frame_, row.carriage) * r0_from_loading;
    }
    const auto corrected = [&](const campaign::LoadingReading& row) -> Eigen::Vector3d {
      return by_pose[indexOf(row.pose)].value() * row.point;
    };
    const Offsets offsets(effects_, unloadedPlaces(table, corrected), statesOf);
    numerics::smallWorkOnAllCores(table.rows.size(), [&](std::size_t i) {
      campaign::LoadingReading& row = table.rows[i];
      row.point = loading_from_r0 * (corrected(row) - offsets.of(row.pose, row.step, row.target));
    });
  }

  void displacements(campaign::Displacements& table) const {
    const Eigen::Matrix3d table_from_r0 =
        state_.geometry.displacements_in_r0.value_or(Eigen::Matrix3d::Identity()).transpose();
    Places places(poses_);
    for (const campaign::Displacement& row : table.rows) {
      const auto& at_zero = state_.geometry.targets_at_zero[static_cast<std::size_t>(row.target)];
      if (!effects_.day.contains(row.pose) || !at_zero) continue;
      auto& [sum, count] = placeOf(places, row.pose, row.target);
      if (count == 0) sum = effects_.statesOf(row.pose).front().posture.motion.back() * *at_zero, count = 1;
    }
    const Offsets offsets(effects_, places, [&](int pose) { return effects_.statesOf(pose); });
    for (campaign::Displacement& row : table.rows) {
      row.displacement -=
          table_from_r0 * (offsets.of(row.pose, row.step, row.target) - offsets.of(row.pose, 0, row.target));
    }
  }

  template <class Row>
  void sweep(std::vector<Row>& rows) const {
    const Eigen::Matrix3d sweeps_from_r0 = state_.r0_from_sweeps.linear().transpose();
    numerics::onAllCores(rows.size(), [&](std::size_t i) {
      Row& row = rows[i];
      const effects::PostureStates states{atRest(-1, row.q, row.time_s, row.carriage)};
      const PostureOffsets offsets(effects_, states, {});
      row.point -= sweeps_from_r0 * offsets.of(row.target, state_.r0_from_sweeps * row.point).front();
    });
  }

 private:
  struct Sum {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;

    Eigen::Vector3d mean() const { return sum / count; }
  };
  using Places = std::vector<std::vector<std::pair<int, Sum>>>;  // by pose, which holds its targets

  static std::size_t indexOf(int pose) { return static_cast<std::size_t>(pose); }

  /// Of few targets.
  static Sum& placeOf(Places& places, int pose, int target) {
    std::vector<std::pair<int, Sum>>& here = places[indexOf(pose)];
    const auto found = std::find_if(here.begin(), here.end(), [&](const auto& one) { return one.first == target; });
    return found == here.end() ? here.emplace_back(target, Sum()).second : found->second;
  }

  /// Of all postures and reflectors that have a place, in all states.
  class Offsets {
   public:
    Offsets(const EffectFit& effects, const Places& places,
            const std::function<effects::PostureStates(int pose)>& states_of)
        : by_pose_(places.size()) {
      numerics::onAllCores(places.size(), [&](std::size_t pose) {
        if (places[pose].empty()) return;
        const effects::PostureStates states = states_of(static_cast<int>(pose));
        if (states.empty()) return;
        const PostureOffsets own(effects, states, {});
        OfPosture& here = by_pose_[pose];
        for (const effects::ArmState& state : states) here.steps.push_back(state.step);
        for (const auto& [target, place] : places[pose]) {
          here.targets.push_back(target);
          const std::vector<Eigen::Vector3d> by_state = own.of(target, place.mean());
          here.offsets.insert(here.offsets.end(), by_state.begin(), by_state.end());
        }
      });
    }

    Eigen::Vector3d of(int pose, int step, int target) const {
      const OfPosture& here = by_pose_[indexOf(pose)];
      const auto s = std::find(here.steps.begin(), here.steps.end(), step) - here.steps.begin();
      const auto t = std::find(here.targets.begin(), here.targets.end(), target) - here.targets.begin();
      if (s == std::ssize(here.steps) || t == std::ssize(here.targets)) return Eigen::Vector3d::Zero();
      return here.offsets[static_cast<std::size_t>(t) * here.steps.size() + static_cast<std::size_t>(s)];
    }

   private:
    struct OfPosture {
      std::vector<int> steps, targets;
      std::vector<Eigen::Vector3d> offsets;  // by target, then state
    };

    std::vector<OfPosture> by_pose_;
  };

  /// The arm at rest, not loaded, with the effects' own turns in.
  effects::ArmState atRest(int pose, const JointVector& q, double time_s, double carriage) const {
    effects::ArmState state = effects::gravityEquilibrium(state_.geometry, state_.at, q, carriage);
    state.pose = pose;
    state.time_s = time_s;
    return state;
  }

  /// Where reflectors stand in step 0 (mean of its readings), else wherever they were read.
  template <class InR0>
  Places unloadedPlaces(const campaign::Loading& table, const InR0& in_r0) const {
    Places at_rest(poses_), else_where(poses_);
    for (const campaign::LoadingReading& row : table.rows) {
      Sum& sum = placeOf(row.step == 0 ? at_rest : else_where, row.pose, row.target);
      sum.sum += in_r0(row), ++sum.count;
    }
    for (std::size_t pose = 0; pose < poses_; ++pose) {
      for (const auto& [target, sum] : else_where[pose]) {
        Sum& here = placeOf(at_rest, static_cast<int>(pose), target);
        if (here.count == 0) here = sum;
      }
    }
    return at_rest;
  }

  const EffectFit& effects_;
  Vector6d frame_;
  const diagnosis::SystemState& state_;
  std::size_t poses_;  ///< of the campaign
};

/// Every reading of loading, displacements and, where they took part in the fit, sweeps.
void shiftReadings(const EffectFit& effects, const Vector6d& frame, campaign::Campaign& campaign) {
  const Shifter shifter(effects, frame, campaign.pose_ids.size());
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
