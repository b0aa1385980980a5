#include "core/frames/geometry_calibration.h"

#include <ceres/ceres.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/frames/arm_parameters.h"
#include "core/frames/remarks.h"
#include "core/numerics/normal_equations.h"

namespace stiffscope::frames {

namespace {

struct ReflectorReading {
  std::size_t target;
  Eigen::Vector3d at_zero;  ///< of the reflector, to start with
  Eigen::Vector3d point;    ///< in R0 as the start has it
  Eigen::Matrix3d whiten;
};

struct UnloadedPosture {
  Vector6d q;  ///< with the sag in
  std::vector<ReflectorReading> reflectors;
};

using WhitenedRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Measured less modelled places of all reflectors, whitened, by ArmParameters: one block of each, so that the arm is
/// placed once and each posture computed once.
class PositionsCost : public ceres::CostFunction {
 public:
  PositionsCost(const AxesAtStart& axes, const Eigen::Vector3d& centre, std::vector<UnloadedPosture> postures,
                Eigen::Index parameters)
      : axes_(axes), centre_(centre), postures_(std::move(postures)) {
    int rows = 0;
    for (const UnloadedPosture& one : postures_) rows += 3 * static_cast<int>(one.reflectors.size());
    set_num_residuals(rows);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index count = parameter_block_sizes().front();
    const Eigen::Map<const Eigen::VectorXd> steps(parameters[0], count);
    double* const jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    Eigen::Index row = 0;
    forEach(steps, [&](const PlacedPosture& posture, const ReflectorReading& reading, const Eigen::Vector3d& position) {
      Eigen::Map<Eigen::Vector3d>(residuals + row) = reading.whiten * (reading.point - position);
      if (jacobian != nullptr) {
        Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> rows(jacobian + row * count, 3, count);
        rows.leftCols<ArmParameters::kAxes>() = -reading.whiten * posture.byAxes(position);
        rows.middleCols<ArmParameters::kBase>(ArmParameters::kBaseAt) = -reading.whiten * posture.byBase(position);
        rows.rightCols(count - ArmParameters::kTargetsAt).setZero();
        rows.middleCols<3>(ArmParameters::targetAt(reading.target)) = -reading.whiten * posture.byTarget();
      }
      row += 3;
    });
    return true;
  }

  WhitenedRows jacobian(const Eigen::VectorXd& steps) const {
    WhitenedRows rows(num_residuals(), steps.size());
    Eigen::VectorXd residuals(num_residuals());
    const double* at = steps.data();
    double* into = rows.data();
    Evaluate(&at, residuals.data(), &into);
    return rows;
  }

  /// Plain, per coordinate, m.
  double rms(const Eigen::VectorXd& steps) const {
    double sum = 0.0;
    forEach(steps, [&](const PlacedPosture&, const ReflectorReading& reading, const Eigen::Vector3d& position) {
      sum += (reading.point - position).squaredNorm();
    });
    return std::sqrt(sum / num_residuals());
  }

 private:
  template <class Use>
  void forEach(const Eigen::Ref<const Eigen::VectorXd>& steps, const Use& use) const {
    const PlacedArm arm(axes_, centre_, steps.head<ArmParameters::kAxes>(),
                        steps.segment<ArmParameters::kBase>(ArmParameters::kBaseAt));
    for (const UnloadedPosture& one : postures_) {
      const PlacedPosture posture(arm, one.q);
      for (const ReflectorReading& reading : one.reflectors) {
        const Eigen::Vector3d step = steps.segment<3>(ArmParameters::targetAt(reading.target));
        use(posture, reading, posture.position(reading.at_zero + step));
      }
    }
  }

  AxesAtStart axes_;
  Eigen::Vector3d centre_;
  std::vector<UnloadedPosture> postures_;
};

class Calibration {
 public:
  Calibration(const campaign::Campaign& campaign, const LoadingGeometry& start) : campaign_(campaign), start_(start) {}

  GeometryCalibration run() {
    GeometryCalibration result;
    positions_ = unloadedPositions(campaign_);
    result.positions = static_cast<int>(positions_.size());
    if (positions_.empty()) {
      result.reason = Remark(RemarkId::no_unloaded_positions);
      return result;
    }
    if (!placeStart()) {
      result.reason = Remark(RemarkId::base_not_placed);
      return result;
    }
    build();
    result.rms_before = cost_->rms(steps_);
    const std::vector<int> unseen = unseenOfAxes();
    const std::vector<int> free = freeParameters(unseen);
    result.parameters = static_cast<int>(free.size());
    if (3 * result.positions <= result.parameters) {
      result.reason = Remark(RemarkId::too_few_positions, result.positions, result.parameters);
      return result;
    }
    for (const int k : unseen) result.fixed.push_back(Remark(RemarkId::axis_parameter, k / 4 + 1, k % 4));
    holdAllBut(free);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.function_tolerance = 1e-12;
    options.parameter_tolerance = 1e-12;
    options.max_num_iterations = 50;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (!summary.IsSolutionUsable()) {
      result.reason = Remark(RemarkId::calibration_not_settling, summary.message);
      return result;
    }
    result.rms_after = cost_->rms(steps_);
    result.geometry = moved(start_, steps_, centre_);
    spread(free, 2.0 * summary.final_cost / (3.0 * result.positions - result.parameters), result);
    result.done = true;
    return result;
  }

 private:
  /// Base and reflectors by the postures where the sweeps do not place them. False where those do not either.
  bool placeStart() {
    const bool placed = start_.r0_from_loading.has_value() &&
                        std::all_of(positions_.begin(), positions_.end(), [&](const UnloadedPosition& p) {
                          return start_.targets_at_zero[static_cast<std::size_t>(p.target)].has_value();
                        });
    if (placed) return true;
    const auto found = baseFromPostures(start_, positions_, campaign_.targets.size());
    if (!found) return false;
    start_.r0_from_loading = found->points_from_base.inverse();
    for (std::size_t t = 0; t < found->targets_at_zero.size(); ++t) {
      if (found->targets_at_zero[t]) start_.targets_at_zero[t] = found->targets_at_zero[t];
    }
    return true;
  }

  void build() {
    std::vector<UnloadedPosture> postures;
    int pose = -1;
    for (const UnloadedPosition& position : positions_) {
      if (position.pose != pose) postures.push_back({start_.sagged(position.q), {}});
      pose = position.pose;
      const auto target = static_cast<std::size_t>(position.target);
      const Eigen::Vector3d point = *start_.r0_from_loading * position.point;
      centre_ += point / static_cast<double>(positions_.size());
      postures.back().reflectors.push_back({target, *start_.targets_at_zero[target], point, whitening(position)});
      if (std::find(used_targets_.begin(), used_targets_.end(), target) == used_targets_.end())
        used_targets_.push_back(target);
    }
    std::sort(used_targets_.begin(), used_targets_.end());
    steps_ = Eigen::VectorXd::Zero(ArmParameters::count(start_.targets_at_zero.size()));
    cost_ =
        new PositionsCost(axesAtStart(start_.arm.axes_in_base_at_zero), centre_, std::move(postures), steps_.size());
    problem_.AddResidualBlock(cost_, nullptr, steps_.data());
  }

  Eigen::Matrix3d whitening(const UnloadedPosition& position) const {
    if (!campaign_.tracker) return Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance =
        trackerNoise(*campaign_.tracker).covarianceAt(position.point) / position.readings;
    const Eigen::Matrix3d in_loading = covariance.inverse().llt().matrixU();
    return in_loading * start_.r0_from_loading->linear().transpose();
  }

  /// In the order in which fits would rather determine them: base, reflectors, then of the axes those that are not
  /// `unseen`.
  std::vector<int> freeParameters(const std::vector<int>& unseen) const {
    std::vector<int> free;
    for (int k = 0; k < ArmParameters::kBase; ++k) free.push_back(ArmParameters::kBaseAt + k);
    for (const std::size_t t : used_targets_) {
      for (int k = 0; k < 3; ++k) free.push_back(static_cast<int>(ArmParameters::targetAt(t)) + k);
    }
    for (int k = 0; k < ArmParameters::kAxes; ++k) {
      if (std::find(unseen.begin(), unseen.end(), k) == unseen.end()) free.push_back(k);
    }
    return free;
  }

  /// Axis parameters whose column of the Jacobian lies in the span of those before it. Base and reflectors
  /// come first and the axes from the tip inwards, so that what is free by choice of frame is fixed in axes 1
  /// and 2, which define R0.
  std::vector<int> unseenOfAxes() const {
    std::vector<int> order = freeParameters({});
    auto axes = order.end() - ArmParameters::kAxes;
    for (int axis = 5; axis >= 0; --axis) {
      for (int k = 0; k < 4; ++k) *axes++ = 4 * axis + k;
    }
    std::vector<int> unseen;
    for (const int column : numerics::columnsInSpanOfEarlier(cost_->jacobian(steps_), order)) {
      if (column < ArmParameters::kAxes) unseen.push_back(column);
    }
    std::sort(unseen.begin(), unseen.end());
    return unseen;
  }

  void holdAllBut(const std::vector<int>& free) {
    std::vector<int> held;
    for (int k = 0; k < static_cast<int>(steps_.size()); ++k) {
      if (std::find(free.begin(), free.end(), k) == free.end()) held.push_back(k);
    }
    if (!held.empty())
      problem_.SetManifold(steps_.data(), new ceres::SubsetManifold(static_cast<int>(steps_.size()), held));
  }

  void spread(const std::vector<int>& free, double chi2_per_dof, GeometryCalibration& result) const {
    const Eigen::MatrixXd columns = cost_->jacobian(steps_)(Eigen::all, free);
    const Eigen::VectorXd scale = columns.colwise().norm().cwiseInverse();
    if (!scale.allFinite()) return;
    const double factor = campaign_.tracker ? std::max(1.0, chi2_per_dof) : chi2_per_dof;
    const Eigen::LLT<Eigen::MatrixXd> normal(numerics::normalMatrix(columns * scale.asDiagonal()));
    if (normal.info() != Eigen::Success) return;
    // (L L^T)^-1 = S S^T, S = L^-T.
    const Eigen::MatrixXd root = std::sqrt(factor) * scale.asDiagonal() *
                                 normal.matrixU().solve(Eigen::MatrixXd::Identity(columns.cols(), columns.cols()));
    for (Eigen::Index k = 0; k < root.cols(); ++k) {
      Eigen::VectorXd there = steps_;
      there(free) += root.col(k);
      result.spread.push_back(moved(start_, there, centre_));
    }
  }

  const campaign::Campaign& campaign_;
  LoadingGeometry start_;
  std::vector<UnloadedPosition> positions_;
  std::vector<std::size_t> used_targets_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< mean of the measured points, in R0
  Eigen::VectorXd steps_;                             ///< ArmParameters; the solver holds its address
  PositionsCost* cost_ = nullptr;                     ///< owned by the problem
  ceres::Problem problem_;
};

}  // namespace

GeometryCalibration calibrateGeometry(const campaign::Campaign& campaign, const LoadingGeometry& start) {
  return Calibration(campaign, start).run();
}

}  // namespace stiffscope::frames
