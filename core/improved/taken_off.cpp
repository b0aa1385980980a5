#include "core/improved/taken_off.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "core/audit/nest_network.h"
#include "core/identification/without_postures.h"
#include "core/improved/effect_nature.h"
#include "core/input/input_error.h"

namespace stiffscope {

namespace {

const LinkFrame* linkNamed(const Robot& robot, const std::string& name) {
  for (const LinkFrame& link : robot.links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

class Remover {
 public:
  Remover(const Campaign& campaign, const EffectFit& effects, const Eigen::VectorXd& parameters, TakenOff which)
      : result_(campaign), effects_(effects), state_(effects.fit.state), which_(which) {
    const GapLayout& layout = effects.fit.data.layout;
    for (const ChosenModel& one : effects.fit.set.models) {
      const EffectModel& model = effects.input->models[one.model];
      own_.emplace_back(&model, parameters.segment(layout.model_at[one.model] - layout.effects,
                                                   static_cast<Eigen::Index>(model.parameters())));
    }
    for (const GapPosture& posture : effects.fit.data.postures) postures_[posture.pose] = posture.states;
  }

  Campaign run(std::vector<std::string>* left_out) {
    correctWrenches();
    findFrame();
    leaveOut(left_out);
    if (result_.loading) correctLoading();
    if (result_.displacements) correctDisplacements();
    if (effects_.input->sweeps) {
      const Eigen::Isometry3d& r0_from_sweeps = state_.r0_from_sweeps;
      if (result_.circle_sweeps) correctSweep(r0_from_sweeps, result_.circle_sweeps->rows);
      if (result_.wrist_sweep) correctSweep(r0_from_sweeps, result_.wrist_sweep->rows);
    }
    return std::move(result_);
  }

 private:
  using Own = std::pair<const EffectModel*, Eigen::VectorXd>;

  bool taken(Effect effect) const {
    return which_ == TakenOff::everything || natureOf(effect) == EffectNature::measurement;
  }

  /// Offsets go off the readings; what acts through the wrench or the frame does not.
  bool isOffset(Effect effect) const {
    return effect != Effect::load_point_error && effect != Effect::load_cell_misalignment &&
           effect != Effect::load_cell_bias && effect != Effect::frame_error && taken(effect);
  }

  const Eigen::VectorXd* sizeOf(Effect effect) const {
    if (!taken(effect)) return nullptr;
    for (const Own& one : own_) {
      if (one.first->effect == effect) return &one.second;
    }
    return nullptr;
  }

  const ArmState* stateOf(int pose, int step) const {
    const auto found = postures_.find(pose);
    if (found == postures_.end()) return nullptr;
    for (const ArmState& state : found->second) {
      if (state.step == step) return &state;
    }
    return nullptr;
  }

  void correctWrenches() {
    if (const Eigen::VectorXd* by = sizeOf(Effect::load_point_error)) moveLoadPoint(*by);
    const Eigen::VectorXd* turn = sizeOf(Effect::load_cell_misalignment);
    const Eigen::VectorXd* bias = sizeOf(Effect::load_cell_bias);
    if (turn == nullptr && bias == nullptr) return;
    for (State& row : result_.states->rows) {
      const ArmState* state = row.step == 0 ? nullptr : stateOf(row.pose, row.step);
      if (state == nullptr) continue;
      const Vector6d read = row.wrench_in_cell;
      if (turn != nullptr) {
        row.wrench_in_cell.head<3>() += turn->head<3>().cross(read.head<3>());
        row.wrench_in_cell.tail<3>() += turn->head<3>().cross(read.tail<3>());
      }
      if (bias == nullptr || !state->loaded) continue;
      const Eigen::Vector3d up = state_.at.r0_from_base_link.linear().col(2);
      row.wrench_in_cell.head<3>() += bias->size() == 3
                                          ? Eigen::Vector3d(bias->head<3>())
                                          : Eigen::Vector3d(-(*bias)[0] * (state->cell_axes.transpose() * up));
    }
  }

  /// `by`: in flange axes, m.
  void moveLoadPoint(const Eigen::VectorXd& by) {
    LoadCell& cell = *result_.load_cell;
    const LinkFrame* parent = linkNamed(result_.robot, cell.parent);
    if (parent == nullptr || parent->body != 6) {
      throw InputError({"--with"}, std::string(idOf(Effect::load_point_error)),
                       fmt::format("the load cell's parent {} does not move with the flange: its point cannot be "
                                   "corrected by one number",
                                   cell.parent));
    }
    const Eigen::Matrix3d parent_from_flange = parent->base_from_link_at_zero.linear().transpose() *
                                               result_.robot.base_from_flange_at_zero.linear();
    cell.parent_from_cell.translation() += parent_from_flange * by.head<3>();
  }

  void findFrame() {
    if (!state_.geometry.r0_from_loading) return;
    r0_from_loading_ = *state_.geometry.r0_from_loading;
    corrected_r0_from_loading_ = r0_from_loading_;
    if (const Eigen::VectorXd* moved = sizeOf(Effect::frame_error))
      corrected_r0_from_loading_ = motionAbout(state_.at.epoch_centre, *moved).inverse() * r0_from_loading_;
  }

  void leaveOut(std::vector<std::string>* left_out) {
    std::vector<OutlyingPosture> without;
    for (const State& row : result_.states->rows) {
      if (row.step == 0 || postures_.count(row.pose) > 0) continue;
      if (!without.empty() && without.back().posture == row.pose) continue;
      without.push_back({});
      without.back().posture = row.pose;
      if (left_out != nullptr)
        left_out->push_back(fmt::format("pose {}: no reflector read in all its load steps, so the effects cannot be taken off",
                                        result_.pose_ids[static_cast<std::size_t>(row.pose)]));
    }
    if (!without.empty()) result_ = withoutPostures(result_, without);
  }

  /// The offsets of one reflector in all states of a posture, in R0.
  std::vector<Eigen::Vector3d> offsetsOf(const PostureStates& posture, int target, const Eigen::Vector3d& place) const {
    PostureStates states = posture;
    for (ArmState& state : states) state.targets = {target}, state.points = {place};
    std::vector<Eigen::Vector3d> offsets(states.size(), Eigen::Vector3d::Zero());
    for (const auto& [model, size] : own_) {
      if (!isOffset(model->effect)) continue;
      for (std::size_t s = 0; s < states.size(); ++s) offsets[s] += model->columns(state_.at, states, s) * size;
    }
    return offsets;
  }

  /// The arm at rest, not loaded, with the effects' own turns in.
  ArmState atRest(const Vector6d& q, double time_s) const {
    ArmState state = stateAt(state_.geometry, q, unloadedTurn(state_.geometry, state_.at, q));
    state.time_s = time_s;
    return state;
  }

  void correctLoading() {
    std::map<std::pair<int, int>, std::vector<Eigen::Vector3d>> offsets;  // by pose and target
    std::map<int, Vector6d> rest_angles;
    for (const State& row : result_.states->rows) {
      if (row.step == 0) rest_angles[row.pose] = row.q;
    }
    const Eigen::Isometry3d loading_from_r0 = r0_from_loading_.inverse();
    for (LoadingReading& row : result_.loading->rows) {
      const Eigen::Vector3d place = corrected_r0_from_loading_ * row.point;
      const auto known = postures_.find(row.pose);
      if (known == postures_.end() && rest_angles.count(row.pose) == 0) continue;
      PostureStates alone;
      if (known == postures_.end()) alone = {atRest(rest_angles[row.pose], row.time_s)}, alone.front().pose = row.pose;
      const PostureStates& states = known == postures_.end() ? alone : known->second;
      const auto key = std::make_pair(row.pose, row.target);
      if (offsets.count(key) == 0) offsets[key] = offsetsOf(states, row.target, place);
      Eigen::Vector3d offset = Eigen::Vector3d::Zero();
      for (std::size_t s = 0; s < states.size(); ++s) {
        if (states[s].step == row.step) offset = offsets[key][s];
      }
      row.point = loading_from_r0 * (place - offset);
    }
  }

  void correctDisplacements() {
    const Eigen::Matrix3d table_from_r0 =
        state_.geometry.displacements_in_r0.value_or(Eigen::Matrix3d::Identity()).transpose();
    for (Displacement& row : result_.displacements->rows) {
      const auto known = postures_.find(row.pose);
      const auto& at_zero = state_.geometry.targets_at_zero[static_cast<std::size_t>(row.target)];
      if (known == postures_.end() || !at_zero) continue;
      const PostureStates& states = known->second;
      const Eigen::Vector3d place = states.front().posture.motion[6] * *at_zero;
      const std::vector<Eigen::Vector3d> offsets = offsetsOf(states, row.target, place);
      for (std::size_t s = 1; s < states.size(); ++s) {
        if (states[s].step == row.step) row.displacement -= table_from_r0 * (offsets[s] - offsets[0]);
      }
    }
  }

  template <class Row>
  void correctSweep(const Eigen::Isometry3d& r0_from_sweeps, std::vector<Row>& rows) const {
    const Eigen::Matrix3d sweeps_from_r0 = r0_from_sweeps.linear().transpose();
    for (Row& row : rows) {
      const PostureStates states{atRest(row.q, row.time_s)};
      row.point -= sweeps_from_r0 * offsetsOf(states, row.target, r0_from_sweeps * row.point).front();
    }
  }

  Campaign result_;
  const EffectFit& effects_;
  const GapState& state_;
  TakenOff which_;
  std::vector<Own> own_;
  std::map<int, PostureStates> postures_;
  Eigen::Isometry3d r0_from_loading_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d corrected_r0_from_loading_ = Eigen::Isometry3d::Identity();
};

}  // namespace

Campaign withoutEffects(const Campaign& campaign, const EffectFit& effects, const Eigen::VectorXd& parameters,
                        TakenOff which, std::vector<std::string>* left_out) {
  if (effects.fit.set.models.empty()) return campaign;
  return Remover(campaign, effects, parameters, which).run(left_out);
}

}  // namespace stiffscope
