#include "core/identification/transmission.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/identification/equations.h"
#include "core/identification/identifiability.h"
#include "core/identification/load_case.h"
#include "core/identification/remarks.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::identification {

namespace {

constexpr double kNoDifference = 1e-9;  ///< rad: m is a copy of q

/// Angles are written to 1e-5 deg, so that a difference of two scatters by as much at least.
constexpr double kLeastScatter = 1.7e-7;  // rad

/// A state this many robust standard deviations from the line is a wrong reading: one in a million is not by chance.
constexpr double kWrongReading = 5.0;

constexpr std::size_t kFewestPostures = 3;  ///< for a scatter between them

constexpr std::size_t kFewestTurns = 3;  ///< postures whose torque turns round, for a lost motion

/// Of a posture's states only these have both angles of the joint.
struct JointStates {
  std::vector<std::size_t> state;                      ///< places among all states
  std::vector<double> torque, windup, reported, side;  ///< tau, q - m, q, sign(T)/2; one a state
  std::vector<std::size_t> posture_end;                ///< a posture's states stand together and end before this
  std::vector<bool> used;

  std::size_t size() const { return state.size(); }

  /// Calls work(from, to) for each posture.
  template <class Work>
  void byPosture(const Work& work) const {
    std::size_t from = 0;
    for (const std::size_t to : posture_end) work(from, to), from = to;
  }
};

/// Value with a weight; see weightedMedian.
struct Weighted {
  double value, weight;
};

double weightedMedian(std::vector<Weighted> values) {
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  const double half = 0.5 * std::accumulate(values.begin(), values.end(), 0.0,
                                            [](double sum, const Weighted& one) { return sum + one.weight; });
  double below = 0.0;
  for (const Weighted& one : values) {
    below += one.weight;
    if (below >= half) return one.value;
  }
  return 0.0;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Slope and lost motion that single wrong readings do not move.
struct RobustLine {
  double slope = 0.0, width = 0.0;
};

/// By differences of two states of a posture: the slope from those whose torques have one sign, the lost motion from
/// the others. Where no two have one sign the slope is from all, and no lost motion is looked for.
RobustLine robustLine(const JointStates& joint) {
  std::vector<Weighted> slopes, all_slopes, widths;
  const auto forPairs = [&](const auto& work) {
    joint.byPosture([&](std::size_t from, std::size_t to) {
      for (std::size_t a = from; a < to; ++a) {
        for (std::size_t b = a + 1; b < to; ++b) work(a, b);
      }
    });
  };
  forPairs([&](std::size_t a, std::size_t b) {
    const double turned = joint.torque[b] - joint.torque[a];
    if (turned == 0.0) return;
    const Weighted slope{(joint.windup[b] - joint.windup[a]) / turned, std::abs(turned)};
    all_slopes.push_back(slope);
    if (joint.side[a] == joint.side[b]) slopes.push_back(slope);
  });
  if (slopes.empty()) return {weightedMedian(std::move(all_slopes)), 0.0};
  const double slope = weightedMedian(std::move(slopes));
  forPairs([&](std::size_t a, std::size_t b) {
    const double sides = joint.side[b] - joint.side[a];
    if (sides == 0.0) return;
    const double rest = joint.windup[b] - joint.windup[a] - slope * (joint.torque[b] - joint.torque[a]);
    widths.push_back({rest / sides, std::abs(sides)});
  });
  return {slope, weightedMedian(std::move(widths))};
}

/// Marks the states that disagree with the line of the others.
void leaveOutWrongReadings(JointStates& joint) {
  const auto [slope, width] = robustLine(joint);
  std::vector<double> residual(joint.size()), sizes;
  const std::size_t postures = joint.posture_end.size();
  if (joint.size() <= postures) return;
  joint.byPosture([&, slope = slope, width = width](std::size_t from, std::size_t to) {
    std::vector<double> own;
    for (std::size_t i = from; i < to; ++i) {
      own.push_back(joint.windup[i] - slope * joint.torque[i] - width * joint.side[i]);
    }
    const double level = median(own);
    for (std::size_t i = from; i < to; ++i) residual[i] = own[i - from] - level;
  });
  for (const double one : residual) sizes.push_back(std::abs(one));
  // 1.4826: from the median of absolute values to a normal standard deviation; the levels take their degrees of
  // freedom.
  const double n = static_cast<double>(joint.size());
  const double scatter = 1.4826 * median(sizes) * std::sqrt(n / (n - static_cast<double>(postures)));
  const double most = kWrongReading * std::max(scatter, kLeastScatter);
  for (std::size_t i = 0; i < joint.size(); ++i) joint.used[i] = std::abs(residual[i]) <= most;
}

/// The used entries of a column less their mean in each posture; others zero.
std::vector<double> withinPostures(const JointStates& joint, const std::vector<double>& column) {
  std::vector<double> within(column.size(), 0.0);
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      if (joint.used[i]) sum += column[i], ++count;
    }
    for (std::size_t i = from; i < to; ++i) {
      if (joint.used[i]) within[i] = column[i] - sum / count;
    }
  });
  return within;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// a less its part along b.
std::vector<double> acrossOf(std::vector<double> a, const std::vector<double>& b) {
  const double factor = dot(a, b) / dot(b, b);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= factor * b[i];
  return a;
}

/// Columns of a joint's least squares after postures' levels are taken off. With a lost motion its column is taken off
/// too: what is left of the others gives the same slope (Frisch, Waugh and Lovell).
struct JointColumns {
  std::vector<double> torque, windup, reported;
  std::vector<double> side;  ///< empty: no lost motion is fitted
};

bool turnsRound(const JointStates& joint, const std::vector<double>& side, const std::vector<double>& torque) {
  std::size_t turns = 0;
  joint.byPosture([&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (side[i] != 0.0) {
        ++turns;
        break;
      }
    }
  });
  if (turns < kFewestTurns) return false;
  constexpr double kAlike = 0.98;  // correlation beyond which the two columns cannot be told apart
  const double product = dot(side, torque);
  return product * product < kAlike * kAlike * dot(side, side) * dot(torque, torque);
}

JointColumns columnsOf(const JointStates& joint) {
  JointColumns columns{withinPostures(joint, joint.torque), withinPostures(joint, joint.windup),
                       withinPostures(joint, joint.reported), withinPostures(joint, joint.side)};
  if (!turnsRound(joint, columns.side, columns.torque)) columns.side.clear();
  if (columns.side.empty()) return columns;
  columns.torque = acrossOf(std::move(columns.torque), columns.side);
  columns.windup = acrossOf(std::move(columns.windup), columns.side);
  columns.reported = acrossOf(std::move(columns.reported), columns.side);
  return columns;
}

/// Slope of least squares of `values` over `column` with its standard deviation by the scatter between postures.
struct Slope {
  double value = 0.0, sd = 0.0;
};

Slope slopeOf(const JointStates& joint, const std::vector<double>& column, const std::vector<double>& values,
              const std::vector<double>& residual) {
  const double square = dot(column, column);
  double squares = 0.0, postures = 0.0;
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double sum = 0.0, any = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += column[i] * residual[i], any += column[i] * column[i];
    squares += sum * sum;
    postures += any > 0.0;
  });
  const double rest = postures > 1.0 ? postures / (postures - 1.0) : 0.0;
  return {dot(column, values) / square, std::sqrt(squares * rest) / square};
}

std::vector<double> residualOf(const std::vector<double>& values, const std::vector<double>& column, double slope) {
  std::vector<double> residual(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) residual[i] = values[i] - slope * column[i];
  return residual;
}

Slope slopeOf(const JointStates& joint, const std::vector<double>& column, const std::vector<double>& values) {
  return slopeOf(joint, column, values, residualOf(values, column, dot(column, values) / dot(column, column)));
}

/// Torques of the own weight, by state; zero where masses are not known, and then nobody knows which sign the torque of
/// load and weight together has.
struct WeightTorques {
  bool known = false;
  std::vector<Vector6d> torques;
};

/// The load states of a day with motor-side angles.
class EncoderDay {
 public:
  explicit EncoderDay(const campaign::Campaign& campaign) : campaign_(campaign) {
    std::vector<std::vector<const campaign::State*>> by_pose(campaign.pose_ids.size());
    for (const campaign::State& row : campaign.states->rows) {
      if (!row.motor_side.array().isNaN().all()) by_pose[static_cast<std::size_t>(row.pose)].push_back(&row);
    }
    for (auto& rows : by_pose) {
      std::sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->step < b->step; });
      states_.insert(states_.end(), rows.begin(), rows.end());
    }
  }

  const std::vector<const campaign::State*>& states() const { return states_; }

  /// A case each state, in their order. An unloaded one has the wrench zero by the format, whatever the tared cell
  /// shows.
  std::vector<LoadCase> casesIn(const frames::LoadingGeometry& geometry) const {
    std::vector<LoadCase> cases;
    const campaign::State* first = nullptr;
    for (const campaign::State* state : states_) {
      if (first == nullptr || first->pose != state->pose) first = state;
      cases.push_back(caseOfState(campaign_, geometry, *first, *state));
    }
    return cases;
  }

  /// Torques of the load in those cases. `compliance`: K_c, and how the load cell turns with the arm, are of it.
  std::vector<Vector6d> torquesIn(const frames::LoadingGeometry& geometry, std::vector<LoadCase>& cases,
                                  const Vector6d& compliance) const {
    std::vector<Vector6d> torques = jointTorques(cases);
    constexpr int kRounds = 2;
    for (int round = 0; round < kRounds && !compliance.isZero(0.0); ++round) {
      updateLoadedConfiguration(geometry, compliance, cases, torques);
    }
    return torques;
  }

  WeightTorques weightTorques(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases) const {
    WeightTorques weight{geometry.weight.links_known, {cases.size(), Vector6d::Zero()}};
    for (std::size_t i = 0; weight.known && i < cases.size(); ++i) {
      weight.torques[i] = robot::weightTorque(geometry.arm, unloadedPosture(geometry.arm, cases[i]), geometry.weight);
    }
    return weight;
  }

  JointStates statesOf(int joint, const std::vector<Vector6d>& torques, const WeightTorques& weight) const {
    JointStates all;
    int pose = -1;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const campaign::State& row = *states_[i];
      if (std::isnan(row.motor_side[joint])) continue;
      if (row.pose != pose && all.size() > 0) all.posture_end.push_back(all.size());
      pose = row.pose;
      all.state.push_back(i);
      const double reported = std::isnan(row.link_side[joint]) ? row.q[joint] : row.link_side[joint];
      const double torque = torques[i][joint];
      const double whole = weight.known ? torque + weight.torques[i][joint] : 0.0;
      all.torque.push_back(torque);
      all.windup.push_back(reported - row.motor_side[joint]);
      all.reported.push_back(reported);
      all.side.push_back(whole > 0.0 ? 0.5 : whole < 0.0 ? -0.5 : 0.0);
    }
    if (all.size() > 0) all.posture_end.push_back(all.size());
    all.used.assign(all.size(), true);
    return all;
  }

 private:
  const campaign::Campaign& campaign_;
  std::vector<const campaign::State*> states_;  ///< by pose and step
};

/// Why a joint's two encoders tell nothing; empty where they do.
Remark whyNotMeasured(const JointStates& joint, int index, const JointIdentifiability& turned) {
  if (joint.size() == 0) return Remark(RemarkId::no_second_encoder);
  std::vector<double> apart;
  for (const double one : joint.windup) apart.push_back(std::abs(one));
  if (*std::max_element(apart.begin(), apart.end()) <= kNoDifference) return Remark(RemarkId::no_second_encoder);
  if (const double by = median(apart); by > campaign::kMotorSideApart) {
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

bool Transmission::measured() const {
  return std::any_of(joints.begin(), joints.end(), [](const GearTorsion& joint) { return joint.measured; });
}

bool hasSecondEncoders(const campaign::Campaign& campaign) {
  return campaign.states &&
         std::any_of(campaign.states->rows.begin(), campaign.states->rows.end(), [](const campaign::State& row) {
           // Not where it is not a number.
           return ((row.q - row.motor_side).array().abs() > kNoDifference).any() ||
                  ((row.link_side - row.motor_side).array().abs() > kNoDifference).any();
         });
}

namespace {

/// What the joints' readings make once it is settled which of them are used.
struct GearFit {
  std::array<JointStates, 6> joints;
  std::array<JointColumns, 6> columns;
  std::vector<NormalEquations> normal;  ///< one a posture
};

/// With these torques. `used`: null, or a fit that has settled which states are used.
GearFit fitOf(const EncoderDay& day, std::size_t poses, const robot::JointMask& measured,
              const std::vector<Vector6d>& torques, const WeightTorques& weight, const GearFit* settled) {
  GearFit fit;
  fit.normal.resize(poses);
  for (int j = 0; j < 6; ++j) {
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
                             const std::vector<Vector6d>& torques, const WeightTorques& weight, Transmission& result) {
  const std::vector<int> steps = loadedSteps(campaign);
  std::vector<LoadCase> loaded;
  for (const LoadCase& one : cases) {
    if (std::find(steps.begin(), steps.end(), one.step) != steps.end()) loaded.push_back(one);
  }
  const Identifiability judged = evaluateTorques(geometry, loaded, *campaign.load_cell);
  robot::JointMask measured{};
  for (int j = 0; j < 6; ++j) {
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
    estimate.parts.frames = by_axes([&](const frames::LoadingGeometry& geometry) -> Vector6d {
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
                                 const Vector6d& compliance, const GeometryPart& by_axes) {
  Transmission result;
  const EncoderDay day(campaign);
  std::vector<LoadCase> cases = day.casesIn(geometry);
  const std::vector<Vector6d> torques = day.torquesIn(geometry, cases, compliance);
  const WeightTorques weight = day.weightTorques(geometry, cases);
  StiffnessEstimate& estimate = result.estimate;
  estimate.identifiable = judgeJoints(campaign, day, geometry, cases, torques, weight, result);
  if (!result.measured()) return result;
  const GearFit fit = fitOf(day, campaign.pose_ids.size(), estimate.identifiable, torques, weight, nullptr);
  const NormalEquations sum = sumOf(fit.normal);
  estimate.compliance = solveNormal(sum, estimate.identifiable);
  setScatterOfOneStage(fit.normal, sum, estimate);
  addSharedParts(campaign, day, by_axes, fit, estimate);
  for (int j = 0; j < 6; ++j) {
    const auto at = static_cast<std::size_t>(j);
    GearTorsion& out = result.joints[at];
    if (!out.measured) continue;
    const JointStates& joint = fit.joints[at];
    const JointColumns& columns = fit.columns[at];
    const double own = estimate.compliance[j];
    describeJoint(joint, columns, own, out);
    const Slope link = slopeOf(joint, columns.torque, columns.reported);
    out.link_turn = link.value, out.link_turn_sd = link.sd;
    out.held = heldSide({own, std::sqrt(estimate.covariance(j, j))}, link, campaign.double_encoder);
    out.caution = loopCaution(out.held, campaign.double_encoder, j);
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
    apart.agreement = apart.interval.low > 0.0    ? GearAgreement::structure_seen
                      : apart.interval.high < 0.0 ? GearAgreement::contradicts
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
