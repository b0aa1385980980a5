#include "core/diagnosis/linear_system.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/diagnosis/geometry_columns.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/frames/arm_parameters.h"
#include "core/identification/load_case.h"
#include "core/numerics/normal_equations.h"
#include "core/numerics/parallel.h"
#include "core/preparation/finding.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::diagnosis {

/// Covariance of one posture's rows (position rows first, then deflection rows state by state), m^2. All
/// displacements of a posture share its unloaded readings, and a state's coordinates its wrench.
struct GapCovariance {
  Eigen::MatrixXd by_measuring;  ///< readings, wrench, and a station between its rounds
  Eigen::MatrixXd whole;         ///< with the inflation of positions and the error of the model
  double displacement_trace = 0.0,
         displacements = 0.0;  ///< readings' variances of displacements, and how many
};

GapCovariance gapCovariance(const SystemInput& input, const SystemState& state, const GapPosture& posture);

/// Adds to `data.beforehand` what is known before the gap is looked at: how far geometry steps and own weights
/// may go in one round, the compliances as expected, a drift as the nests have it.
void addPriors(const SystemInput& input, LinearSystem& data);

/// Adds the equations of every posture of the loading to `data`: y = A c + geometry + own weights + effects +
/// noise for the unloaded absolute positions (where they take part) and the displacements, unwhitened. Fills
/// `loading_rows`. `by_geometry`: columns of the geometry, of each posture.
void addPostureEquations(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                         std::vector<SystemRows> rows, const std::vector<Eigen::MatrixXd>& by_geometry,
                         LinearSystem& data);

/// Whitens each posture by its own covariance: fills `normal` and what else follows from that, and `state_noise`.
void whitenPostures(const SystemInput& input, const SystemState& state, LinearSystem& data);

/// Fills `data.as_read` with the equations of circle and wrist sweeps: absolute positions of unloaded postures,
/// y = sag + geometry + own weights + effects + noise.
void addSweepEquations(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                       const std::vector<SweepRows>& rows, const std::vector<Eigen::MatrixXd>& by_geometry,
                       LinearSystem& data);

/// Their normal equations, whitened reading by reading.
Eigen::MatrixXd sweepNormal(const SystemInput& input, const SystemState& state, SweepEquations equations);

namespace {

/// Covariance of one tracker reading at a point of R0, in R0, m^2: that of the station's frame, turned.
/// `from`: where the instrument stood, in R0.
Eigen::Matrix3d readingCovariance(const metrology::TrackerNoise& noise, const Eigen::Isometry3d& r0_from_points,
                                  const Eigen::Vector3d& point_in_r0, const Eigen::Vector3d& from) {
  const Eigen::Matrix3d turn = r0_from_points.linear();
  const Eigen::Isometry3d points_from_r0 = r0_from_points.inverse();
  return turn * noise.covarianceAt(points_from_r0 * point_in_r0, points_from_r0 * from) * turn.transpose();
}

/// Of one of the readings; the default on a day of one station.
ReadFrom readFrom(const std::vector<ReadFrom>& all, std::size_t reading) {
  return all.empty() ? ReadFrom() : all[reading];
}

/// The station between two rounds of the nests, where it was interpolated: one rigid motion of all
/// reflectors in a state, a Brownian bridge over time. Postures share it; that is left out.
void addWander(const SystemInput& input, const effects::LinearizationPoint& at, const GapPosture& posture,
               const Eigen::Isometry3d& r0_from_points, Eigen::MatrixXd& covariance) {
  if (input.wandering == nullptr || input.wandering->wander.isZero()) return;
  const preparation::StationMotion& station = input.wandering->motion;
  const effects::ArmState& rest = posture.states.front();
  const Eigen::Vector3d pivot = r0_from_points * station.centre - at.travelOf(rest.carriage);
  Eigen::MatrixXd motion(rest.rows(), 6);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = r0_from_points.linear().col(k);
    motion.col(k) = effects::byMotion(rest, pivot, axis, Eigen::Vector3d::Zero());
    motion.col(3 + k) = effects::byMotion(rest, pivot, Eigen::Vector3d::Zero(), axis);
  }
  const Eigen::MatrixXd a_second = propagated(motion, input.wandering->wander);
  const auto bridge = [&](std::size_t s, std::size_t r) {
    return preparation::bridgeBetweenRounds(station, posture.states[s].time_s, posture.states[r].time_s);
  };
  const Eigen::Index per_state = rest.rows();
  const std::size_t first = posture.position_rows > 0 ? 0 : 1;
  for (std::size_t s = first; s < posture.states.size(); ++s) {
    for (std::size_t r = first; r < posture.states.size(); ++r) {
      double seconds = bridge(s, r);
      if (s > 0) seconds -= bridge(0, r);
      if (r > 0) seconds -= bridge(s, 0);
      if (s > 0 && r > 0) seconds += bridge(0, 0);
      covariance.block(static_cast<Eigen::Index>(s - first) * per_state,
                       static_cast<Eigen::Index>(r - first) * per_state, per_state, per_state) += seconds * a_second;
    }
  }
}

/// Where the carriage stands in this posture: one shift of all reflectors, of which displacements are free.
void addCarriage(const SystemInput& input, const GapPosture& posture, const Eigen::Isometry3d& r0_from_points,
                 Eigen::MatrixXd& covariance) {
  if (input.carriage.isZero(0.0)) return;
  const Eigen::Matrix3d turn = r0_from_points.linear();
  const Eigen::Matrix3d shift = turn * input.carriage * turn.transpose();
  for (Eigen::Index a = 0; a < posture.position_rows; a += 3) {
    for (Eigen::Index b = 0; b < posture.position_rows; b += 3) covariance.block<3, 3>(a, b) += shift;
  }
}

/// What the model is not good for: more noise in absolute positions; in a deflection an error that grows
/// with the load, one number a posture, reflector and direction, so that it counts once however many load
/// steps show it.
void addModelError(const SystemState& state, const GapPosture& posture, Eigen::MatrixXd& covariance) {
  const Eigen::Index per_state = posture.states.front().rows(), at_rest = posture.position_rows;
  covariance.topLeftCorner(at_rest, at_rest) *= state.position_inflation;
  const double variance = state.model_error * state.model_error;
  if (variance == 0.0) return;
  const auto share = [&](std::size_t s) { return posture.states[s].load.force.norm() / state.at.largest_force; };
  for (std::size_t s = 1; s < posture.states.size(); ++s) {
    for (std::size_t r = 1; r < posture.states.size(); ++r) {
      covariance
          .block(at_rest + static_cast<Eigen::Index>(s - 1) * per_state,
                 at_rest + static_cast<Eigen::Index>(r - 1) * per_state, per_state, per_state)
          .diagonal()
          .array() += variance * share(s) * share(r);
    }
  }
}

}  // namespace

GapCovariance gapCovariance(const SystemInput& input, const SystemState& state, const GapPosture& posture) {
  GapCovariance result;
  const Eigen::Index per_state = posture.states.front().rows(), at_rest = posture.position_rows;
  const auto steps = static_cast<Eigen::Index>(posture.states.size()) - 1;
  const Eigen::Index size = at_rest + steps * per_state;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  // Displacements alone are in the frame of their station.
  const Eigen::Isometry3d r0_from_points = state.geometry.r0_from_loading.value_or(state.at.r0_from_base_link);
  for (std::size_t t = 0; t < posture.states.front().points.size(); ++t) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(t);
    const ReadFrom station = readFrom(posture.read_from, t);
    const Eigen::Matrix3d reading =
        readingCovariance(input.noise, r0_from_points, posture.states.front().points[t], station.from);
    const auto target = static_cast<Eigen::Index>(t);
    const Eigen::Matrix3d rest = reading / posture.readings(0, target);
    if (at_rest > 0) covariance.block<3, 3>(row, row) = rest + station.pose_covariance;
    for (Eigen::Index s = 0; s < steps; ++s) {
      const Eigen::Index i = at_rest + s * per_state + row;
      const Eigen::Matrix3d loaded = reading / posture.readings(s + 1, target);
      result.displacement_trace += (rest + loaded).trace();
      result.displacements += 3.0;
      if (at_rest > 0) covariance.block<3, 3>(i, row) = covariance.block<3, 3>(row, i) = -rest;
      for (Eigen::Index r = 0; r < steps; ++r) {
        covariance.block<3, 3>(i, at_rest + r * per_state + row) = rest;
      }
      covariance.block<3, 3>(i, i) += loaded;
    }
  }
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(input.force_sigma * input.force_sigma),
      Eigen::Vector3d::Constant(input.moment_sigma * input.moment_sigma);
  for (Eigen::Index s = 0; s < steps; ++s) {
    const auto& by_wrench = posture.by_wrench[static_cast<std::size_t>(s)];
    covariance.block(at_rest + s * per_state, at_rest + s * per_state, per_state, per_state) +=
        by_wrench * variances.asDiagonal() * by_wrench.transpose();
  }
  addWander(input, state.at, posture, r0_from_points, covariance);
  addCarriage(input, posture, r0_from_points, covariance);
  result.by_measuring = covariance;
  addModelError(state, posture, covariance);
  result.whole = std::move(covariance);
  return result;
}

double GapPosture::noiseSquares(Eigen::Index first, Eigen::Index rows) const {
  double sum = 0.0;
  for (Eigen::Index row = first; row < first + rows; ++row) sum += noise(row, row % noise.cols());
  return sum;
}

ComplianceExpected complianceExpected(const JointVector& identified) {
  constexpr double kNothing = 0.05;  // of the neighbours': not identified
  constexpr double kHalf = 0.5, kThrice = 3.0;
  const Eigen::Index joints = identified.size();
  ComplianceExpected expected{JointVector::Zero(joints), JointVector::Zero(joints), {}};
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double neighbour = std::max(j > 0 ? identified[j - 1] : 0.0, j + 1 < joints ? identified[j + 1] : 0.0);
    const bool known = identified[j] > kNothing * neighbour;
    expected.known.push_back(known);
    expected.value[j] = known ? identified[j] : kHalf * neighbour;
    expected.sd[j] = known ? kThrice * identified[j] : kHalf * neighbour;
  }
  return expected;
}

Eigen::VectorXd priorsOf(const std::vector<effects::EffectModel>& models) {
  std::vector<double> priors;
  for (const effects::EffectModel& model : models) {
    for (const effects::EffectPart& part : model.parts) {
      for (const double most : part.most) priors.push_back(1.0 / (most * most));
    }
  }
  return Eigen::VectorXd::Map(priors.data(), static_cast<Eigen::Index>(priors.size()));
}

GapLayout gapLayout(const std::vector<effects::EffectModel>& models, const robot::Robot& arm, std::size_t targets) {
  GapLayout layout;
  layout.geometry = arm.joints();
  layout.weights = layout.geometry + frames::ArmParameters(arm.axes()).count(targets);
  layout.effects = layout.weights + arm.axes();
  layout.end = layout.effects;
  for (const effects::EffectModel& model : models) {
    layout.model_at.push_back(layout.end);
    layout.end += static_cast<Eigen::Index>(model.parameters());
  }
  return layout;
}

LinearSystem linearSystem(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                          Weighed weighed) {
  GeometryColumns by_geometry;
  return linearSystem(input, state, effects_now, by_geometry, weighed);
}

LinearSystem linearSystem(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                          GeometryColumns& by_geometry, Weighed weighed) {
  LinearSystem data;
  data.layout = gapLayout(input.models, input.campaign.robot, input.campaign.targets.size());
  const LoadingRows maker(input.campaign);
  std::vector<SystemRows> loading = maker.rows(state.geometry, state.at, state.corrections);
  std::vector<SweepRows> sweeps;
  if (input.sweeps) sweeps = sweepRows(input.campaign, state.geometry, state.r0_from_sweeps, state.at);
  const GeometryColumns::Columns& columns = by_geometry.of(state, input.absolute, maker, loading, sweeps);
  addPostureEquations(input, state, effects_now, std::move(loading), columns.loading, data);
  whitenPostures(input, state, data);
  data.beforehand.setZero(data.layout.end + 1, data.layout.end + 1);
  addPriors(input, data);
  data.sweeps = data.beforehand;
  if (!input.sweeps) return data;
  addSweepEquations(input, state, effects_now, sweeps, columns.sweeps, data);
  data.sweeps += sweepNormal(input, state, weighed == Weighed::again ? data.as_read : std::move(data.as_read));
  return data;
}

void weighAgain(const SystemInput& input, const SystemState& state, LinearSystem& data) {
  whitenPostures(input, state, data);
  data.sweeps = data.beforehand;
  if (input.sweeps) data.sweeps += sweepNormal(input, state, std::move(data.as_read));
  data.as_read = {};
}

namespace {

/// m and rad, a round: wide beside what a round corrects, and narrow enough that a motion of everything,
/// which is free by choice of frame, stays where linear steps and rounding are good.
constexpr double kGeometryPrior = 3e-3;
constexpr double kSweptGeometry =
    1e-3;  // m and rad: where nothing absolute is fitted, as a calibrated or sagging arm has it
constexpr double kWeightPrior = 0.1;  // of a body's weight: masses of a URDF are no better

void addGeometryAndWeights(const SystemInput& input, LinearSystem& data) {
  for (Eigen::Index k = 0; k < data.layout.weights - data.layout.geometry; ++k) {
    const Eigen::Index at = data.layout.geometry + k;
    const double prior = input.absolute ? kGeometryPrior : kSweptGeometry;
    data.beforehand(at, at) += 1.0 / (prior * prior);
  }
  // Each body's own, and beside it what is declared common to all: the inverse of s^2 I + m^2 1 1^T.
  constexpr double kOwn = 1.0 / (kWeightPrior * kWeightPrior);
  const double common = input.campaign.mass_sigma * kOwn * input.campaign.mass_sigma;
  const Eigen::Index bodies = data.layout.bodies();
  data.beforehand.diagonal().segment(data.layout.weights, bodies).array() += kOwn;
  if (common > 0.0) {
    data.beforehand.block(data.layout.weights, data.layout.weights, bodies, bodies).array() -=
        kOwn * common / (1.0 + static_cast<double>(bodies) * common);
  }
}

void addCompliances(const SystemInput& input, LinearSystem& data) {
  const Eigen::Index end = data.layout.end;
  for (Eigen::Index j = 0; j < input.expected.sd.size(); ++j) {
    const double value = input.expected.value[j], sd = input.expected.sd[j];
    if (sd <= 0.0) continue;
    const double weight = 1.0 / (sd * sd);
    data.beforehand(j, j) += weight;
    data.beforehand(j, end) += weight * value;
    data.beforehand(end, j) += weight * value;
    data.beforehand(end, end) += weight * value * value;
  }
}

void addNests(const SystemInput& input, LinearSystem& data) {
  if (input.drift_weight.isZero()) return;
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    if (input.models[m].effect != effects::Effect::tracker_drift) continue;
    const Eigen::Index at = data.layout.model_at[m], end = data.layout.end;
    const Vector6d right = input.drift_weight * input.drift;
    data.beforehand.block<6, 6>(at, at) += input.drift_weight;
    data.beforehand.block<6, 1>(at, end) += right;
    data.beforehand.block<1, 6>(end, at) += right.transpose();
    data.beforehand(end, end) += input.drift.dot(right);
    data.sweep_rows += 6;
  }
}

}  // namespace

void addPriors(const SystemInput& input, LinearSystem& data) {
  addGeometryAndWeights(input, data);
  addCompliances(input, data);
  addNests(input, data);
}

namespace {

/// Columns and right side of one posture but for the columns of the geometry, unwhitened.
GapPosture unwhitened(const SystemInput& input, const SystemState& state, const ContainedEffects& now,
                      const GapLayout& layout, const SystemRows& rows) {
  GapPosture posture;
  posture.pose = rows.pose;
  posture.readings = rows.readings;
  const Eigen::Index at_rest = input.absolute ? rows.position.size() : 0;
  const Eigen::Index per_state = rows.states.front().rows();
  posture.position_rows = at_rest;
  posture.columns.setZero(at_rest + rows.displacement.size(), layout.end);
  posture.right.resize(posture.columns.rows());
  posture.columns.bottomLeftCorner(rows.displacement.size(), layout.joints()) = rows.by_compliance;
  posture.right.tail(rows.displacement.size()) = rows.displacement;
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const Eigen::MatrixXd rest = input.models[m].columns(state.at, rows.states, 0);
    if (at_rest > 0) posture.columns.block(0, layout.model_at[m], at_rest, rest.cols()) = rest;
    for (std::size_t s = 1; s < rows.states.size(); ++s) {
      posture.columns.block(at_rest + static_cast<Eigen::Index>(s - 1) * per_state, layout.model_at[m], per_state,
                            rest.cols()) = input.models[m].columns(state.at, rows.states, s) - rest;
    }
  }
  if (at_rest > 0) {
    posture.columns.topLeftCorner(at_rest, layout.joints()) = rows.sag_by_compliance;
    posture.columns.block(0, layout.weights, at_rest, layout.bodies()) =
        effects::gravityDeflectionByBody(state.at, rows.states.front());
    posture.right.head(at_rest) = rows.position + rows.sag_by_compliance * state.at.compliance;
  }
  // What the corrections took off comes back, so that the right side is that of the whole effect.
  if (now.in_positions.size() > 0) {
    const Eigen::Index effects = now.in_positions.size();
    posture.right.head(at_rest) += posture.columns.topRightCorner(at_rest, effects) * now.in_positions;
    posture.right.tail(rows.displacement.size()) +=
        posture.columns.bottomRightCorner(rows.displacement.size(), effects) * now.in_deflections;
  }
  return posture;
}

StiffnessNormal stiffnessNormalOf(const GapPosture& posture, const Eigen::MatrixXd& covariance) {
  const Eigen::Index rows = posture.right.size() - posture.position_rows;
  const Eigen::Index joints = posture.states.front().joints();
  Eigen::MatrixXd both(rows, joints + 1);
  both << posture.columns.bottomLeftCorner(rows, joints), posture.right.tail(rows);
  covariance.bottomRightCorner(rows, rows).llt().matrixL().solveInPlace(both);
  return both.transpose() * both;
}

Eigen::MatrixXd normalOf(const GapPosture& posture, const Eigen::LLT<Eigen::MatrixXd>& noise) {
  Eigen::MatrixXd both(posture.columns.rows(), posture.columns.cols() + 1);
  both << posture.columns, posture.right;
  noise.matrixL().solveInPlace(both);
  return numerics::normalMatrix(both);
}

void whiten(const GapCovariance& covariance, GapPosture& posture) {
  const Eigen::Index per_state = posture.states.front().rows();
  const Eigen::Index size = posture.right.size(), at_rest = posture.position_rows;
  posture.noise.resize(size, per_state);
  for (Eigen::Index at = 0; at < size; at += per_state) {
    posture.noise.middleRows(at, per_state) = covariance.by_measuring.block(at, at, per_state, per_state);
  }
  if (size - at_rest > per_state)
    posture.noise_across = covariance.by_measuring.block(at_rest + per_state, at_rest, per_state, per_state);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance.whole);
  posture.position_lower = cholesky.matrixLLT().topLeftCorner(at_rest, at_rest).triangularView<Eigen::Lower>();
  posture.normal = numerics::LowerTriangle(normalOf(posture, cholesky));
  posture.stiffness_normal = stiffnessNormalOf(posture, covariance.whole);
}

}  // namespace

void addPostureEquations(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                         std::vector<SystemRows> rows, const std::vector<Eigen::MatrixXd>& by_geometry,
                         LinearSystem& data) {
  data.postures.resize(rows.size());
  numerics::onAllCores(rows.size(), [&](std::size_t i) {
    data.postures[i] = unwhitened(input, state, effects_now, data.layout, rows[i]);
    data.postures[i].columns.middleCols(data.layout.geometry, by_geometry[i].cols()) = by_geometry[i];
    data.postures[i].states = std::move(rows[i].states);
    data.postures[i].by_wrench = std::move(rows[i].by_wrench);
    data.postures[i].read_from = std::move(rows[i].read_from);
  });
  for (const GapPosture& posture : data.postures) data.loading_rows += posture.right.size();
}

void whitenPostures(const SystemInput& input, const SystemState& state, LinearSystem& data) {
  std::vector<double> traces(data.postures.size()), counts(data.postures.size());
  numerics::onAllCores(data.postures.size(), [&](std::size_t i) {
    const GapCovariance covariance = gapCovariance(input, state, data.postures[i]);
    whiten(covariance, data.postures[i]);
    traces[i] = covariance.displacement_trace;
    counts[i] = covariance.displacements;
  });
  const double noise = std::accumulate(traces.begin(), traces.end(), 0.0),
               count = std::accumulate(counts.begin(), counts.end(), 0.0);
  data.state_noise = count > 0.0 ? std::sqrt(noise / count) : 0.0;
}

namespace {

/// [A y] of one posture, unwhitened.
template <class Rows>
void fill(const SystemInput& input, const SystemState& state, const ContainedEffects& now, const GapLayout& layout,
          const Eigen::MatrixXd& by_geometry, const SweepRows& one, Rows both) {
  both.leftCols(layout.joints()) = one.sag_by_compliance;
  both.middleCols(layout.geometry, by_geometry.cols()) = by_geometry;
  both.middleCols(layout.weights, layout.bodies()) = effects::gravityDeflectionByBody(state.at, one.state);
  const effects::PostureStates alone{one.state};
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const Eigen::MatrixXd columns = input.models[m].columns(state.at, alone, 0);
    both.middleCols(layout.model_at[m], columns.cols()) = columns;
  }
  auto right = both.col(both.cols() - 1);
  right = one.position + one.sag_by_compliance * state.at.compliance;
  if (now.in_positions.size() > 0) right += both.middleCols(layout.effects, now.in_positions.size()) * now.in_positions;
}

}  // namespace

void addSweepEquations(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                       const std::vector<SweepRows>& rows, const std::vector<Eigen::MatrixXd>& by_geometry,
                       LinearSystem& data) {
  Eigen::Index total = 0;
  std::vector<Eigen::Index> first;
  for (const SweepRows& one : rows) {
    first.push_back(total);
    total += one.position.size();
    data.as_read.points.insert(data.as_read.points.end(), one.state.points.begin(), one.state.points.end());
    data.as_read.read_from.insert(data.as_read.read_from.end(), one.read_from.begin(), one.read_from.end());
  }
  data.as_read.rows.setZero(total, data.layout.end + 1);
  numerics::onAllCores(rows.size(), [&](std::size_t i) {
    fill(input, state, effects_now, data.layout, by_geometry[i], rows[i],
         data.as_read.rows.middleRows(first[i], rows[i].position.size()));
  });
  data.sweep_rows += total;
}

namespace {

/// Takes out of the normal equations what one shift of all readings, unknown to `covariance` S, could explain:
/// N - (A' E) (E' E + 1)^-1 (E' A), A the whitened rows, E = whitened ones times a root of S. The sweeps are read at
/// one stop of the carriage, which misses its place by as much as those of the postures do.
void freeOneShift(const Eigen::MatrixXd& whitened, const Eigen::MatrixXd& whitened_shift,
                  const Eigen::Matrix3d& covariance, Eigen::MatrixXd& normal) {
  const Eigen::MatrixXd shift = whitened_shift * covarianceRoot(covariance);  // of rank one: along the rail
  const Eigen::MatrixXd across = shift.transpose() * whitened;
  const Eigen::Matrix3d own = shift.transpose() * shift + Eigen::Matrix3d::Identity();
  normal -= across.transpose() * own.ldlt().solve(across);
}

}  // namespace

Eigen::MatrixXd sweepNormal(const SystemInput& input, const SystemState& state, SweepEquations equations) {
  std::vector<Eigen::Matrix3d> roots;
  roots.reserve(equations.points.size());
  for (std::size_t i = 0; i < equations.points.size(); ++i) {
    const ReadFrom station = readFrom(equations.read_from, i);
    const Eigen::Matrix3d covariance = state.sweep_inflation * readingCovariance(input.noise, state.r0_from_sweeps,
                                                                                 equations.points[i], station.from) +
                                       station.pose_covariance;
    roots.emplace_back(covariance.llt().matrixL());
  }
  // Column by column, as they lie in memory.
  const auto whiten = [&](auto column) {
    for (std::size_t i = 0; i < roots.size(); ++i) {
      auto reading = column.template segment<3>(3 * static_cast<Eigen::Index>(i));
      roots[i].triangularView<Eigen::Lower>().solveInPlace(reading);
    }
  };
  numerics::onAllCores(static_cast<std::size_t>(equations.rows.cols()),
                       [&](std::size_t k) { whiten(equations.rows.col(static_cast<Eigen::Index>(k))); });
  Eigen::MatrixXd normal = numerics::normalMatrix(equations.rows);
  if (!input.carriage.isZero(0.0)) {
    Eigen::MatrixXd shift = Eigen::Matrix3d::Identity().replicate(static_cast<Eigen::Index>(roots.size()), 1);
    for (int k = 0; k < 3; ++k) whiten(shift.col(k));
    const Eigen::Matrix3d turn = state.r0_from_sweeps.linear();
    freeOneShift(equations.rows, shift, turn * input.carriage * turn.transpose(), normal);
  }
  return normal;
}

}  // namespace stiffscope::diagnosis
