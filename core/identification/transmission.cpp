#include "core/identification/transmission.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/identification/equations.h"
#include "core/identification/gear_states.h"
#include "core/identification/identifiability.h"
#include "core/identification/load_case.h"
#include "core/identification/remarks.h"
#include "core/numerics/resampling.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::identification {

namespace {

constexpr double kNoDifference = 1e-9;  ///< rad: m is a copy of q

constexpr std::size_t kFewestPostures = 3;  ///< for a scatter between them

/// Why a joint's two encoders tell nothing; empty where they do.
Remark whyNotMeasured(const JointStates& joint, int index, const JointIdentifiability& turned) {
  if (joint.size() == 0) return Remark(RemarkId::no_second_encoder);
  std::vector<double> apart;
  for (const double one : joint.windup) apart.push_back(std::abs(one));
  if (*std::max_element(apart.begin(), apart.end()) <= kNoDifference) return Remark(RemarkId::no_second_encoder);
  if (const double by = numerics::median(apart); by > campaign::kMotorSideApart) {
    return Remark(RemarkId::encoders_apart, index + 1, by);
  }
  if (!turned.identifiable) return turned.reason;
  return {};
}

/// Which side stands still, by the share of the wind-up that the link moved; where that does not tell, as declared.
HeldSide heldSide(const Slope& gear, const Slope& link, campaign::DoubleEncoder declared) {
  if (gear.value > 2.0 * gear.sd && gear.value > 2.0 * link.sd) {
    return std::abs(link.value) < 0.5 * gear.value ? HeldSide::link : HeldSide::motor;
  }
  return declaredSide(declared);
}

Remark loopCaution(HeldSide held, campaign::DoubleEncoder declared, int joint) {
  const bool contradicts = (held == HeldSide::motor && declared == campaign::DoubleEncoder::active) ||
                           (held == HeldSide::link && declared == campaign::DoubleEncoder::inactive);
  return contradicts ? Remark(RemarkId::loop_not_as_declared, joint + 1, held == HeldSide::motor) : Remark();
}

void describeOffset(const JointStates& joint, int index, const WeightTorques& weight, double compliance, double width,
                    GearTorsion& out) {
  std::vector<double> levels;
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      if (!joint.used[i]) continue;
      const double torque = joint.torque[i] + weight.torques[joint.state[i]][index];
      sum += joint.windup[i] - compliance * torque - width * joint.side[i], ++count;
    }
    if (count > 0.0) levels.push_back(sum / count);
  });
  const double n = static_cast<double>(levels.size());
  out.offset = std::accumulate(levels.begin(), levels.end(), 0.0) / n;
  double squares = 0.0;
  for (const double level : levels) squares += (level - out.offset) * (level - out.offset);
  out.offset_sd = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0;
}

/// A joint's normal equations, posture by posture, into the entries of that joint.
void addNormal(const JointStates& joint, int index, const JointColumns& columns,
               const std::vector<const campaign::State*>& states, std::vector<NormalEquations>& by_pose) {
  joint.byPosture([&](std::size_t from, std::size_t to) {
    NormalEquations& own = by_pose[static_cast<std::size_t>(states[joint.state[from]]->pose)];
    for (std::size_t i = from; i < to; ++i) {
      own.matrix(index, index) += columns.torque[i] * columns.torque[i];
      own.right[index] += columns.torque[i] * columns.windup[i];
    }
  });
}

/// What is stated of a fitted joint besides its compliance.
void describeJoint(const JointStates& joint, const JointColumns& columns, double compliance, GearTorsion& out) {
  const std::vector<double> residual = residualOf(columns.windup, columns.torque, compliance);
  joint.byPosture([&](std::size_t from, std::size_t to) {
    const auto used = std::count(joint.used.begin() + static_cast<std::ptrdiff_t>(from),
                                 joint.used.begin() + static_cast<std::ptrdiff_t>(to), true);
    out.states += static_cast<int>(used);
    out.postures += used > 1;
  });
  out.left_out = static_cast<int>(joint.size()) - out.states;
  const double unknowns = columns.side.empty() ? 1.0 : 2.0;
  const double dof = out.states - static_cast<double>(joint.posture_end.size()) - unknowns;
  out.rms_residual = dof > 0.0 ? std::sqrt(dot(residual, residual) / dof) : 0.0;
  const std::vector<double> torque = withinPostures(joint, joint.torque);
  out.rms_torque = std::sqrt(dot(torque, torque) / out.states);
  if (!columns.side.empty()) {
    const std::vector<double> windup = residualOf(withinPostures(joint, joint.windup), torque, compliance);
    const std::vector<double> across = acrossOf(columns.side, torque);
    const Slope own = slopeOf(joint, across, windup, residual);
    out.lost_motion = LostMotion{dot(columns.side, windup) / dot(columns.side, columns.side), own.sd};
  }
}

void addPoints(const JointStates& joint, int index, const std::vector<const campaign::State*>& states,
               double compliance, double width, std::vector<TorsionPoint>& points) {
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double level = 0.0, used = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      if (!joint.used[i]) continue;
      level += joint.windup[i] - compliance * joint.torque[i] - width * joint.side[i], ++used;
    }
    if (used > 0.0) level /= used;
    for (std::size_t i = from; i < to; ++i) {
      const campaign::State& row = *states[joint.state[i]];
      const double torsion = joint.windup[i] - level;
      points.push_back({row.pose, row.step, index, joint.torque[i], torsion,
                        torsion - compliance * joint.torque[i] - width * joint.side[i], joint.used[i]});
    }
  });
}

}  // namespace

HeldSide declaredSide(campaign::DoubleEncoder declared) {
  switch (declared) {
    case campaign::DoubleEncoder::active:
      return HeldSide::link;
    case campaign::DoubleEncoder::inactive:
      return HeldSide::motor;
    case campaign::DoubleEncoder::unspecified:
      break;
  }
  return HeldSide::unknown;
}

bool Transmission::measured() const {
  return std::any_of(joints.begin(), joints.end(), [](const GearTorsion& joint) { return joint.measured; });
}

bool hasSecondEncoders(const campaign::Campaign& campaign) {
  return campaign.states &&
         std::any_of(campaign.states->rows.begin(), campaign.states->rows.end(), [](const campaign::State& row) {
           // Not where it is not a number.
           return row.hasExtras() &&
                  (((row.q - row.extras().motor_side).array().abs() > kNoDifference).any() ||
                   ((row.extras().link_side - row.extras().motor_side).array().abs() > kNoDifference).any());
         });
}

namespace {

/// What the joints' readings make once it is settled which of them are used.
struct GearFit {
  PerJoint<JointStates> joints;
  PerJoint<JointColumns> columns;
  std::vector<NormalEquations> normal;  ///< one a posture
};

/// With these torques. `used`: null, or a fit that has settled which states are used.
GearFit fitOf(const EncoderDay& day, std::size_t poses, const robot::JointMask& measured,
              const std::vector<JointVector>& torques, const WeightTorques& weight, const GearFit* settled) {
  GearFit fit;
  fit.joints.resize(measured.size());
  fit.columns.resize(measured.size());
  fit.normal.resize(poses, NormalEquations(static_cast<Eigen::Index>(measured.size())));
  for (int j = 0; j < static_cast<int>(measured.size()); ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (!measured[at]) continue;
    JointStates& joint = fit.joints[at] = day.statesOf(j, torques, weight);
    if (settled != nullptr) {
      joint.used = settled->joints[at].used;
    } else {
      leaveOutWrongReadings(joint);
    }
    fit.columns[at] = columnsOf(joint);
    addNormal(joint, j, fit.columns[at], day.states(), fit.normal);
  }
  std::erase_if(fit.normal, [](const NormalEquations& one) { return one.matrix.isZero(0.0); });
  return fit;
}

/// Which joints the loads turn enough, and why the others tell nothing.
robot::JointMask judgeJoints(const campaign::Campaign& campaign, const EncoderDay& day,
                             const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases,
                             const std::vector<JointVector>& torques, const WeightTorques& weight,
                             Transmission& result) {
  const std::vector<int> steps = loadedSteps(campaign);
  std::vector<LoadCase> loaded;
  for (const LoadCase& one : cases) {
    if (std::find(steps.begin(), steps.end(), one.step) != steps.end()) loaded.push_back(one);
  }
  const Identifiability judged = evaluateTorques(geometry, loaded, *campaign.load_cell);
  robot::JointMask measured(result.joints.size(), false);
  for (int j = 0; j < static_cast<int>(measured.size()); ++j) {
    const auto at = static_cast<std::size_t>(j);
    GearTorsion& out = result.joints[at];
    const JointStates joint = day.statesOf(j, torques, weight);
    out.reason = loaded.empty() && joint.size() > 0 ? Remark(RemarkId::no_loaded_state)
                                                    : whyNotMeasured(joint, j, judged.joints[at]);
    std::size_t postures = 0;
    joint.byPosture([&](std::size_t from, std::size_t to) { postures += to - from > 1; });
    if (out.reason.empty() && postures < kFewestPostures) {
      out.reason = Remark(RemarkId::too_few_encoder_postures, postures, kFewestPostures);
    }
    measured[at] = out.measured = out.reason.empty();
  }
  return measured;
}

/// What all postures share: the measured axes, by which the torques move, and the load cell's declared scale, by which
/// all torques are wrong alike.
void addSharedParts(const campaign::Campaign& campaign, const EncoderDay& day, const GeometryPart& by_axes,
                    const GearFit& settled, StiffnessEstimate& estimate) {
  const double gain = campaign.load_cell->gain_sigma;
  estimate.parts.effects = gain * gain * estimate.compliance * estimate.compliance.transpose();
  if (by_axes) {
    estimate.parts.frames = by_axes([&](const frames::LoadingGeometry& geometry) -> JointVector {
      const std::vector<LoadCase> cases = day.casesIn(geometry);
      const GearFit fit = fitOf(day, campaign.pose_ids.size(), estimate.identifiable, jointTorques(cases),
                                day.weightTorques(geometry, cases), &settled);
      return solveNormal(sumOf(fit.normal), estimate.identifiable);
    });
  }
  estimate.covariance = estimate.parts.total();
}

}  // namespace

Transmission measureTransmission(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                 const JointVector& compliance, const GeometryPart& by_axes) {
  Transmission result;
  const int joints = campaign.robot.joints();
  result.joints.resize(static_cast<std::size_t>(joints));
  result.estimate = StiffnessEstimate(joints);
  const EncoderDay day(campaign);
  std::vector<LoadCase> cases = day.casesIn(geometry);
  const std::vector<JointVector> torques = day.torquesIn(geometry, cases, compliance);
  const WeightTorques weight = day.weightTorques(geometry, cases);
  StiffnessEstimate& estimate = result.estimate;
  estimate.identifiable = judgeJoints(campaign, day, geometry, cases, torques, weight, result);
  if (!result.measured()) return result;
  const GearFit fit = fitOf(day, campaign.pose_ids.size(), estimate.identifiable, torques, weight, nullptr);
  const NormalEquations sum = sumOf(fit.normal);
  estimate.compliance = solveNormal(sum, estimate.identifiable);
  // Each gear is a line of its own: a posture gives an equation to every one of them.
  const auto gears = std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true);
  setScatterOfOneStage(fit.normal, sum, estimate, static_cast<double>(gears));
  addSharedParts(campaign, day, by_axes, fit, estimate);
  for (int j = 0; j < joints; ++j) {
    const auto at = static_cast<std::size_t>(j);
    GearTorsion& out = result.joints[at];
    if (!out.measured) continue;
    const JointStates& joint = fit.joints[at];
    const JointColumns& columns = fit.columns[at];
    const double own = estimate.compliance[j];
    describeJoint(joint, columns, own, out);
    const Slope link = slopeOf(joint, columns.torque, columns.reported);
    out.link_turn = link.value, out.link_turn_sd = link.sd;
    out.held = heldSide({own, std::sqrt(estimate.covariance(j, j))}, link, campaign.doubleEncoderOf(j));
    out.caution = loopCaution(out.held, campaign.doubleEncoderOf(j), j);
    const double width = out.lost_motion ? out.lost_motion->width : 0.0;
    describeOffset(joint, j, weight, own, width, out);
    out.offset_holds_weight = !geometry.weight.links_known;
    addPoints(joint, j, day.states(), own, width, result.points);
  }
  return result;
}

std::optional<GearAndStructure> gearAndStructure(const Transmission& transmission, const StiffnessEstimate& by_tracker,
                                                 int joint) {
  const auto at = static_cast<std::size_t>(joint);
  const GearTorsion& gear = transmission.joints[at];
  if (!gear.measured || !by_tracker.identifiable[at] || gear.held == HeldSide::unknown) return std::nullopt;
  GearAndStructure apart;
  const double by_encoders = transmission.estimate.compliance[joint], seen = by_tracker.compliance[joint];
  const CoverageInterval tracker = complianceInterval(by_tracker, joint);
  apart.in_series = gear.held == HeldSide::motor;
  if (apart.in_series) {
    const CoverageInterval encoders = complianceInterval(transmission.estimate, joint);
    apart.structure = seen - by_encoders;
    apart.sd = std::sqrt(by_tracker.covariance(joint, joint) + transmission.estimate.covariance(joint, joint));
    apart.interval = {apart.structure - std::hypot(seen - tracker.low, encoders.high - by_encoders),
                      apart.structure + std::hypot(tracker.high - seen, by_encoders - encoders.low)};
    const bool open = !std::isfinite(apart.interval.low) || !std::isfinite(apart.interval.high);
    apart.agreement = apart.interval.low > 0.0    ? GearAgreement::structure_seen
                      : apart.interval.high < 0.0 ? GearAgreement::contradicts
                      : open                      ? GearAgreement::apart
                                                  : GearAgreement::gear_alone;
  } else {
    apart.structure = seen;
    apart.sd = std::sqrt(by_tracker.covariance(joint, joint));
    apart.interval = tracker;
  }
  apart.gear_share = by_encoders / (by_encoders + apart.structure);
  return apart;
}

}  // namespace stiffscope::identification
