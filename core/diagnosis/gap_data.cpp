#include "core/diagnosis/gap_data.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/diagnosis/position_by_geometry.h"

namespace stiffscope {

namespace {

/// m and rad, a round: wide beside what a round corrects, and narrow enough that a motion of everything, which
/// is free by choice of frame, stays where linear steps and rounding are good.
constexpr double kGeometryPrior = 3e-3;
constexpr double kSweptGeometry =
    1e-3;  // m and rad: where nothing absolute is fitted, as a calibrated or sagging arm has it
constexpr double kWeightPrior = 0.1;  // of a body's weight: masses of a URDF are no better
constexpr double kStep = 1e-6;        // m and rad: far above rounding, far below where the model curves
constexpr Eigen::Index kBodies = 6;

Eigen::Matrix3d inR0(const TrackerNoise& noise, const Eigen::Isometry3d& r0_from_points,
                     const Eigen::Vector3d& point) {
  const Eigen::Matrix3d turn = r0_from_points.linear();
  return turn * noise.covarianceAt(r0_from_points.inverse() * point) * turn.transpose();
}

/// How the own weight of each body turns the joints of a state: one column a body.
Matrix6d sagByBody(const WorkingPoint& at, const ArmState& state) {
  Matrix6d angles = Matrix6d::Zero();
  for (int body = 1; body <= 6; ++body) {
    const auto b = static_cast<std::size_t>(body);
    Wrench own = state.weight_from_body[b];
    if (body < 6) {
      own.force -= state.weight_from_body[b + 1].force;
      own.moment -= state.weight_from_body[b + 1].moment;
    }
    for (int j = 0; j < body; ++j) {
      const Line& axis = state.axes[static_cast<std::size_t>(j)];
      angles(j, body - 1) = at.compliance[j] * axis.direction.dot(own.about(axis.point).moment);
    }
  }
  return angles;
}

/// A^T A, half of it computed.
Eigen::MatrixXd squareOf(const Eigen::MatrixXd& both) {
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(both.cols(), both.cols());
  square.selfadjointView<Eigen::Lower>().rankUpdate(both.transpose());
  square.triangularView<Eigen::StrictlyUpper>() = square.transpose();
  return square;
}

class Filler {
 public:
  Filler(const GapInput& input, const GapState& state, const ContainedEffects& effects_now)
      : input_(input), state_(state), now_(effects_now) {
    data_.layout = gapLayout(input.models, input.campaign.targets.size());
  }

  GapData run() {
    const auto rows = loadingRows(input_.campaign, state_.geometry, state_.at, state_.corrections);
    for (const GapRows& one : rows) addPosture(one);
    addGeometry(rows);
    double noise = 0.0, count = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) whiten(rows[i], data_.postures[i], noise, count);
    data_.state_noise = count > 0.0 ? std::sqrt(noise / count) : 0.0;
    addSweeps();
    return std::move(data_);
  }

 private:
  Eigen::Index geometrySteps() const { return GeometrySteps::count(input_.campaign.targets.size()); }

  void addPosture(const GapRows& rows) {
    GapPosture posture;
    posture.pose = rows.pose;
    posture.states = rows.states;
    const Eigen::Index at_rest = input_.absolute ? rows.position.size() : 0;
    const Eigen::Index per_state = rows.states.front().rows();
    posture.position_rows = at_rest;
    posture.columns.setZero(at_rest + rows.displacement.size(), data_.layout.end);
    posture.right.resize(posture.columns.rows());
    posture.columns.bottomLeftCorner(rows.displacement.size(), 6) = rows.by_compliance;
    posture.right.tail(rows.displacement.size()) = rows.displacement;
    for (std::size_t m = 0; m < input_.models.size(); ++m) {
      const Eigen::MatrixXd rest = input_.models[m].columns(state_.at, rows.states, 0);
      if (at_rest > 0) posture.columns.block(0, data_.layout.model_at[m], at_rest, rest.cols()) = rest;
      for (std::size_t s = 1; s < rows.states.size(); ++s) {
        posture.columns.block(at_rest + static_cast<Eigen::Index>(s - 1) * per_state,
                              data_.layout.model_at[m], per_state, rest.cols()) =
            input_.models[m].columns(state_.at, rows.states, s) - rest;
      }
    }
    if (at_rest > 0) {
      posture.columns.topLeftCorner(at_rest, 6) = rows.sag_by_compliance;
      posture.columns.block(0, data_.layout.weights, at_rest, kBodies) =
          byJoints(rows.states.front(), sagByBody(state_.at, rows.states.front()));
      posture.right.head(at_rest) = rows.position + rows.sag_by_compliance * state_.at.compliance;
    }
    // What the corrections took off comes back, so that the right side is that of the whole effect.
    if (now_.in_positions.size() > 0) {
      const Eigen::Index effects = now_.in_positions.size();
      posture.right.head(at_rest) += posture.columns.topRightCorner(at_rest, effects) * now_.in_positions;
      posture.right.tail(rows.displacement.size()) +=
          posture.columns.bottomRightCorner(rows.displacement.size(), effects) * now_.in_deflections;
    }
    data_.postures.push_back(std::move(posture));
  }

  /// Derivatives of measured less modelled by the geometry's steps: central differences of the rows
  /// themselves.
  void addGeometry(const std::vector<GapRows>& rows) {
    for (Eigen::Index k = 0; k < geometrySteps(); ++k) {
      const LoadingGeometry there =
          moved(state_.geometry, kStep * Eigen::VectorXd::Unit(geometrySteps(), k), state_.at.epoch_centre);
      const auto other = loadingRows(input_.campaign, there, state_.at, state_.corrections);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        GapPosture& posture = data_.postures[i];
        auto column = posture.columns.col(data_.layout.geometry + k);
        if (posture.position_rows > 0)
          column.head(posture.position_rows) = (rows[i].position - other[i].position) / kStep;
        const Vector6d& c = state_.at.compliance;
        column.tail(rows[i].displacement.size()) = ((rows[i].displacement - rows[i].by_compliance * c) -
                                                    (other[i].displacement - other[i].by_compliance * c)) /
                                                   kStep;
      }
    }
  }

  void whiten(const GapRows& rows, GapPosture& posture, double& noise, double& count) {
    const Eigen::Index per_state = rows.states.front().rows();
    const Eigen::Index size = posture.right.size(), at_rest = posture.position_rows;
    const auto steps = static_cast<Eigen::Index>(rows.states.size()) - 1;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
    const Eigen::Isometry3d r0_from_points = state_.geometry.r0_from_loading.value_or(pointsFrame());
    for (std::size_t t = 0; t < rows.states.front().points.size(); ++t) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(t);
      const Eigen::Matrix3d reading = inR0(input_.noise, r0_from_points, rows.states.front().points[t]);
      const Eigen::Matrix3d rest = reading / rows.unloaded_readings, loaded = reading / rows.loaded_readings;
      noise += (rest + loaded).trace() * static_cast<double>(steps);
      count += 3.0 * static_cast<double>(steps);
      if (at_rest > 0) covariance.block<3, 3>(row, row) = rest;
      for (Eigen::Index s = 0; s < steps; ++s) {
        const Eigen::Index i = at_rest + s * per_state + row;
        if (at_rest > 0) covariance.block<3, 3>(i, row) = covariance.block<3, 3>(row, i) = -rest;
        for (Eigen::Index r = 0; r < steps; ++r) {
          covariance.block<3, 3>(i, at_rest + r * per_state + row) = rest;
        }
        covariance.block<3, 3>(i, i) += loaded;
      }
    }
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(input_.force_sigma * input_.force_sigma),
        Eigen::Vector3d::Constant(input_.moment_sigma * input_.moment_sigma);
    for (Eigen::Index s = 0; s < steps; ++s) {
      const auto& by_wrench = rows.by_wrench[static_cast<std::size_t>(s)];
      covariance.block(at_rest + s * per_state, at_rest + s * per_state, per_state, per_state) +=
          by_wrench * variances.asDiagonal() * by_wrench.transpose();
    }
    addWander(posture, r0_from_points, covariance);
    posture.noise.resize(size, per_state);
    for (Eigen::Index at = 0; at < size; at += per_state) {
      posture.noise.middleRows(at, per_state) = covariance.block(at, at, per_state, per_state);
    }
    addModelError(rows, posture, covariance);
    const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
    posture.position_lower = cholesky.matrixLLT().topLeftCorner(at_rest, at_rest).triangularView<Eigen::Lower>();
    posture.normal = normalOf(posture, cholesky);
    posture.stiffness_normal = stiffnessNormalOf(posture, covariance);
    data_.loading_rows += size;
  }

  /// The station between two rounds of the nests, where it was interpolated: one rigid motion of all
  /// reflectors in a state, a Brownian bridge over time. Postures share it; that is left out.
  void addWander(const GapPosture& posture, const Eigen::Isometry3d& r0_from_points,
                 Eigen::MatrixXd& covariance) const {
    if (input_.wandering == nullptr || input_.wandering->wander.isZero()) return;
    const StationMotion& station = input_.wandering->motion;
    const ArmState& rest = posture.states.front();
    const Eigen::Vector3d centre = r0_from_points * station.centre;
    Eigen::MatrixXd motion(rest.rows(), 6);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = r0_from_points.linear().col(k);
      motion.col(k) = byMotion(rest, centre, axis, Eigen::Vector3d::Zero());
      motion.col(3 + k) = byMotion(rest, centre, Eigen::Vector3d::Zero(), axis);
    }
    const Eigen::MatrixXd a_second = motion * input_.wandering->wander * motion.transpose();
    const auto bridge = [&](std::size_t s, std::size_t r) {
      return bridgeBetweenRounds(station, posture.states[s].time_s, posture.states[r].time_s);
    };
    const Eigen::Index per_state = rest.rows(), at_rest = posture.position_rows;
    const std::size_t first = at_rest > 0 ? 0 : 1;
    for (std::size_t s = first; s < posture.states.size(); ++s) {
      for (std::size_t r = first; r < posture.states.size(); ++r) {
        double seconds = bridge(s, r);
        if (s > 0) seconds -= bridge(0, r);
        if (r > 0) seconds -= bridge(s, 0);
        if (s > 0 && r > 0) seconds += bridge(0, 0);
        covariance.block(static_cast<Eigen::Index>(s - first) * per_state,
                         static_cast<Eigen::Index>(r - first) * per_state, per_state, per_state) +=
            seconds * a_second;
      }
    }
  }

  static Eigen::Matrix<double, 7, 7> stiffnessNormalOf(const GapPosture& posture,
                                                       const Eigen::MatrixXd& covariance) {
    const Eigen::Index rows = posture.right.size() - posture.position_rows;
    Eigen::MatrixXd both(rows, 7);
    both << posture.columns.bottomLeftCorner(rows, 6), posture.right.tail(rows);
    covariance.bottomRightCorner(rows, rows).llt().matrixL().solveInPlace(both);
    return both.transpose() * both;
  }

  /// What the model is not good for: more noise in absolute positions; in a deflection an error that grows
  /// with the load, one number a posture, reflector and direction, so that it counts once however many load
  /// steps show it.
  void addModelError(const GapRows& rows, const GapPosture& posture, Eigen::MatrixXd& covariance) const {
    const Eigen::Index per_state = rows.states.front().rows(), at_rest = posture.position_rows;
    covariance.topLeftCorner(at_rest, at_rest) *= state_.position_slack;
    const double variance = state_.model_error * state_.model_error;
    if (variance == 0.0) return;
    const auto share = [&](std::size_t s) {
      return rows.states[s].load.force.norm() / state_.at.largest_force;
    };
    for (std::size_t s = 1; s < rows.states.size(); ++s) {
      for (std::size_t r = 1; r < rows.states.size(); ++r) {
        covariance
            .block(at_rest + static_cast<Eigen::Index>(s - 1) * per_state,
                   at_rest + static_cast<Eigen::Index>(r - 1) * per_state, per_state, per_state)
            .diagonal()
            .array() += variance * share(s) * share(r);
      }
    }
  }

  /// Displacements alone: the frame of their station.
  Eigen::Isometry3d pointsFrame() const { return state_.at.r0_from_base_link; }

  static Eigen::MatrixXd normalOf(const GapPosture& posture, const Eigen::LLT<Eigen::MatrixXd>& noise) {
    Eigen::MatrixXd both(posture.columns.rows(), posture.columns.cols() + 1);
    both << posture.columns, posture.right;
    noise.matrixL().solveInPlace(both);
    return squareOf(both);
  }

  void addSweeps() {
    const Eigen::Index size = data_.layout.end + 1;
    data_.sweeps.setZero(size, size);
    for (Eigen::Index k = 0; k < geometrySteps(); ++k) {
      const Eigen::Index at = data_.layout.geometry + k;
      const double prior = input_.absolute ? kGeometryPrior : kSweptGeometry;
      data_.sweeps(at, at) += 1.0 / (prior * prior);
    }
    for (Eigen::Index k = 0; k < kBodies; ++k) {
      const Eigen::Index at = data_.layout.weights + k;
      data_.sweeps(at, at) += 1.0 / (kWeightPrior * kWeightPrior);
    }
    addCompliances();
    addNests();
    if (!input_.sweeps) return;
    const auto rows = sweepRows(input_.campaign, state_.geometry, state_.r0_from_sweeps, state_.at);
    Eigen::Index total = 0;
    for (const SweepRows& one : rows) total += one.position.size();
    Eigen::MatrixXd both(total, size);
    both.setZero();
    Eigen::Index row = 0;
    for (const SweepRows& one : rows) {
      fillSweep(one, both.middleRows(row, one.position.size()));
      row += one.position.size();
    }
    row = 0;
    for (const SweepRows& one : rows) {
      for (const Eigen::Vector3d& point : one.state.points) {
        const Eigen::Matrix3d covariance =
            state_.sweep_slack * inR0(input_.noise, state_.r0_from_sweeps, point);
        both.middleRows<3>(row) = covariance.llt().matrixL().solve(both.middleRows<3>(row)).eval();
        row += 3;
      }
    }
    data_.sweeps += squareOf(both);
    data_.sweep_rows += total;
  }

  void addCompliances() {
    const Eigen::Index end = data_.layout.end;
    for (Eigen::Index j = 0; j < 6; ++j) {
      const double value = input_.expected.value[j], sd = input_.expected.sd[j];
      if (sd <= 0.0) continue;
      const double weight = 1.0 / (sd * sd);
      data_.sweeps(j, j) += weight;
      data_.sweeps(j, end) += weight * value;
      data_.sweeps(end, j) += weight * value;
      data_.sweeps(end, end) += weight * value * value;
    }
  }

  void addNests() {
    if (input_.drift_weight.isZero()) return;
    for (std::size_t m = 0; m < input_.models.size(); ++m) {
      if (input_.models[m].effect != Effect::tracker_drift) continue;
      const Eigen::Index at = data_.layout.model_at[m], end = data_.layout.end;
      const Vector6d right = input_.drift_weight * input_.drift;
      data_.sweeps.block<6, 6>(at, at) += input_.drift_weight;
      data_.sweeps.block<6, 1>(at, end) += right;
      data_.sweeps.block<1, 6>(end, at) += right.transpose();
      data_.sweeps(end, end) += input_.drift.dot(right);
      data_.sweep_rows += 6;
    }
  }

  template <class Rows>
  void fillSweep(const SweepRows& one, Rows both) const {
    both.leftCols(6) = one.sag_by_compliance;
    both.middleCols(data_.layout.geometry, geometrySteps()) =
        positionByGeometry(state_.geometry, one.state, state_.at.epoch_centre);
    both.middleCols(data_.layout.weights, kBodies) = byJoints(one.state, sagByBody(state_.at, one.state));
    for (std::size_t m = 0; m < input_.models.size(); ++m) {
      const Eigen::MatrixXd columns = input_.models[m].columns(state_.at, {one.state}, 0);
      both.middleCols(data_.layout.model_at[m], columns.cols()) = columns;
    }
    auto right = both.col(both.cols() - 1);
    right = one.position + one.sag_by_compliance * state_.at.compliance;
    if (now_.in_positions.size() > 0)
      right += both.middleCols(data_.layout.effects, now_.in_positions.size()) * now_.in_positions;
  }

  const GapInput& input_;
  const GapState& state_;
  const ContainedEffects& now_;
  GapData data_;
};

}  // namespace

double GapPosture::noiseSquares(Eigen::Index first, Eigen::Index rows) const {
  double sum = 0.0;
  for (Eigen::Index row = first; row < first + rows; ++row) sum += noise(row, row % noise.cols());
  return sum;
}

ComplianceExpected complianceExpected(const Vector6d& identified) {
  constexpr double kNothing = 0.05;  // of the neighbours': not identified
  constexpr double kHalf = 0.5, kThrice = 3.0;
  ComplianceExpected expected;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double neighbour =
        std::max(j > 0 ? identified[j - 1] : 0.0, j < 5 ? identified[j + 1] : 0.0);
    const bool known = identified[j] > kNothing * neighbour;
    expected.value[j] = known ? identified[j] : kHalf * neighbour;
    expected.sd[j] = known ? kThrice * identified[j] : kHalf * neighbour;
  }
  return expected;
}

GapLayout gapLayout(const std::vector<EffectModel>& models, std::size_t targets) {
  GapLayout layout;
  layout.weights = layout.geometry + GeometrySteps::count(targets);
  layout.effects = layout.weights + kBodies;
  layout.end = layout.effects;
  for (const EffectModel& model : models) {
    layout.model_at.push_back(layout.end);
    layout.end += static_cast<Eigen::Index>(model.parameters());
  }
  return layout;
}

GapData gapData(const GapInput& input, const GapState& state, const ContainedEffects& effects_now) {
  return Filler(input, state, effects_now).run();
}

}  // namespace stiffscope
