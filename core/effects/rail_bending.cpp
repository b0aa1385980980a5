#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/effects/all.h"

namespace stiffscope::effects {

// A rail gives more at some positions of the carriage than at others: between its supports more than over them. The
// foot of the arm is shifted and turned by the force F and the moment M there (own weight and load), as base_compliance
// has it and in its axes: x along the rail, y across it, z off it. Here are the changes of these compliances with the
// position r, by x = (r - mean) / half of the travel: c(r) = c_1 x + c_2 (x^2 - mean of x^2), so that the mean over the
// day's postures is zero and stays base_compliance's. Besides, a force off the rail turns the carriage across it where
// the rail is not loaded at the middle between supports, and by reciprocity the moment lifts it: turn about y c F_z,
// shift along z c M_y, with a mean of its own; the same level, of F_y and M_z. No beam and no place of supports is
// assumed. Source: any rail on supports (S. P. Timoshenko, Strength of Materials I, on beams); polynomials of second
// order in the position are what a day's postures can tell.
// Readings in the tracker's frame are referred to the carriage at zero by a straight line through a sweep of the rail,
// in which the arm bends it as well: what that sweep's line has taken in is taken off the shift.
// Parameters of either sign: m/N, rad/Nm and rad/N. At most 1e-6: under a load of 1 kN a millimetre, and under 1 kNm a
// milliradian, more than at the mean.

namespace {

constexpr std::size_t kOwnCompliances = 5, kCouplings = 2;

/// What a unit of each compliance does under a load on the foot.
struct FootMotion {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
};

std::array<FootMotion, kOwnCompliances + kCouplings> footMotions(const Eigen::Matrix3d& axes, const robot::Wrench& at) {
  const auto x = axes.col(0), y = axes.col(1), z = axes.col(2);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  return {{{none, y * y.dot(at.force)},
           {none, z * z.dot(at.force)},
           {x * x.dot(at.moment), none},
           {y * y.dot(at.moment), none},
           {z * z.dot(at.moment), none},
           {y * z.dot(at.force), z * y.dot(at.moment)},
           {z * y.dot(at.force), y * z.dot(at.moment)}}};
}

/// 1, x and x^2 less its mean; of a position that is not known their means.
std::array<double, 3> byPosition(const RailTravel& rail, double carriage) {
  if (std::isnan(carriage)) return {1.0, 0.0, 0.0};
  const double x = (carriage - rail.mean) / rail.scale;
  return {1.0, x, x * x - rail.mean_square};
}

std::vector<BodyTwist> railBendingTwists(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  const RailTravel& rail = at.rail;
  const Eigen::Vector3d foot = at.r0_from_base_link.translation();
  const Eigen::Matrix3d axes = at.r0_from_base_link.linear() * footAxes(at.rail_in_base);
  const auto here = footMotions(axes, carried(state, 0, foot));
  const auto at_sweep = footMotions(axes, rail.weight_at_sweep.about(foot));
  const std::array<double, 3> share = byPosition(rail, state.carriage);
  const double along = std::isnan(state.carriage) ? 0.0 : state.carriage - rail.mean;
  const std::array<double, 3> in_line{0.0, along * rail.line_by_x, along * rail.line_by_square};
  std::vector<BodyTwist> twists;
  twists.reserve(here.size() * share.size());
  for (std::size_t c = 0; c < here.size(); ++c) {
    const Eigen::Vector3d swept = at_sweep[c].rotation.cross(rail.reflectors_at_sweep - foot) + at_sweep[c].shift;
    for (std::size_t k = c < kOwnCompliances ? 1 : 0; k < share.size(); ++k) {
      BodyTwist& twist = twists.emplace_back(BodyTwist{.first_body = 1, .with_axis = true, .pivot = foot});
      twist.rotation = share[k] * here[c].rotation;
      twist.shift = share[k] * here[c].shift - in_line[k] * swept;
    }
  }
  return twists;
}

std::vector<EffectModel> railBendingModels(const ModelScope& scope) {
  if (!scope.on_rail) return {};
  EffectModel model{.most_parts = kOwnCompliances + kCouplings, .twists = &railBendingTwists};
  constexpr double kMost = 1e-6;
  const auto add = [&](const std::string& what, bool has_mean, const std::string& unit) {
    EffectPart part{what, {}, false, unit, {}};
    if (has_mean) part.names.push_back(what + " at the mean position");
    part.names.push_back(what + " by position");
    part.names.push_back(what + " by its square");
    part.most.assign(part.names.size(), kMost);
    model.parts.push_back(std::move(part));
  };
  add("shift across the rail", false, "m/N");
  add("shift off the rail", false, "m/N");
  add("rocking about the rail", false, "rad/Nm");
  add("rocking across the rail", false, "rad/Nm");
  add("turn on the rail", false, "rad/Nm");
  add("rocking by the force off the rail", true, "rad/N");
  add("turn by the force across the rail", true, "rad/N");
  return {model};
}

Remark railBendingMissing(const CampaignContents& has) {
  constexpr int kFewestPositions = 3;  // of a second-order polynomial
  if (has.carriage_positions == 0) return Remark(RemarkId::rail_bending_needs_rail);
  if (has.carriage_positions < kFewestPositions) return Remark(RemarkId::rail_bending_needs_three_positions);
  return {};
}

}  // namespace

const EffectRecord& railBending() {
  static const EffectRecord record{.effect = Effect::rail_bending,
                                   .nature = EffectNature::machine,
                                   .of_rail = true,
                                   .missing = &railBendingMissing,
                                   .models = &railBendingModels};
  return record;
}

}  // namespace stiffscope::effects
