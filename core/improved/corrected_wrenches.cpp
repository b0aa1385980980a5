#include "core/improved/corrected_wrenches.h"

#include <fmt/format.h>

#include <cmath>

#include "core/input/input_error.h"

namespace stiffscope {

namespace {

const LinkFrame* linkNamed(const Robot& robot, const std::string& name) {
  for (const LinkFrame& link : robot.links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

/// `by`: in flange axes, m.
void moveLoadPoint(const Eigen::Vector3d& by, Campaign& campaign) {
  LoadCell& cell = *campaign.load_cell;
  const LinkFrame* parent = linkNamed(campaign.robot, cell.parent);
  if (parent == nullptr || parent->body != 6) {
    throw InputError({"--with"}, std::string(idOf(Effect::load_point_error)),
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

/// The state of a row under load; null where the fit does not have it.
const ArmState* stateOf(const GapFit& fit, const State& row) {
  for (const GapPosture& posture : fit.data.postures) {
    if (posture.pose != row.pose) continue;
    for (std::size_t s = 1; s < posture.states.size(); ++s) {
      if (posture.states[s].step == row.step) return &posture.states[s];
    }
  }
  return nullptr;
}

}  // namespace

void correctWrenches(const EffectFit& effects, const Eigen::VectorXd& parameters, Campaign& campaign) {
  const GapLayout& layout = effects.fit.data.layout;
  const Eigen::Vector3d up = effects.fit.state.at.r0_from_base_link.linear().col(2);
  const Eigen::Vector3d load_offset = effects.fit.state.at.load_offset;
  for (const ChosenModel& one : effects.fit.set.models) {
    const EffectModel& model = effects.input->models[one.model];
    const Eigen::VectorXd own = parameters.segment(layout.model_at[one.model] - layout.effects,
                                                   static_cast<Eigen::Index>(model.parameters()));
    if (model.effect == Effect::load_point_error) moveLoadPoint(own.head<3>(), campaign);
    const bool turned = model.effect == Effect::load_cell_misalignment, biased = model.effect == Effect::load_cell_bias;
    if (!turned && !biased) continue;
    for (State& row : campaign.states->rows) {
      const ArmState* state = stateOf(effects.fit, row);
      if (state == nullptr) continue;
      auto force = row.wrench_in_cell.head<3>();
      auto moment = row.wrench_in_cell.tail<3>();
      if (turned) {
        const Eigen::Matrix3d turn = turnOf(own.head<3>());
        force = turn * Eigen::Vector3d(force);
        moment = turn * Eigen::Vector3d(moment);
      } else if (state->loaded) {
        if (own.size() == 3) force += own;
        if (own.size() == 1) {
          const Eigen::Vector3d weight = -own[0] * up;
          force += state->cell_axes.transpose() * weight;
          moment += state->cell_axes.transpose() * (state->flange.linear() * load_offset).cross(weight);
        }
      }
    }
  }
}

}  // namespace stiffscope
