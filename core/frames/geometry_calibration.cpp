#include "core/frames/geometry_calibration.h"

#include <ceres/ceres.h>
#include <ceres/jet.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/frames/base_frame.h"
#include "core/frames/remarks.h"
#include "core/numerics/normal_equations.h"
#include "metrology/lines.h"

namespace stiffscope::frames {

namespace {

class Calibration {
 public:
  Calibration(const campaign::Campaign& campaign, const LoadingGeometry& start) : campaign_(campaign), begin_(start) {}

  GeometryCalibration run() {
    GeometryCalibration result;
    positions_ = unloadedPositions(campaign_);
    result.positions = static_cast<int>(positions_.size());
    if (positions_.empty()) {
      result.reason = Remark(RemarkId::no_unloaded_positions);
      return result;
    }
    if (!begin(result)) return result;
    build();
    result.rms_before = plainRms();
    const std::vector<int> unseen_axes = findUnseen();
    result.parameters = 24 + 6 + 3 * static_cast<int>(used_targets_.size()) - static_cast<int>(unseen_axes.size());
    if (3 * result.positions <= result.parameters) {
      result.reason = Remark(RemarkId::too_few_positions, result.positions, result.parameters);
      return result;
    }
    for (const int k : unseen_axes) result.fixed.push_back(Remark(RemarkId::axis_parameter, k / 4 + 1, k % 4));
    if (!unseen_axes.empty() && unseen_axes.size() < 24) {
      problem_.SetManifold(parameters_.axes.data(), new ceres::SubsetManifold(24, unseen_axes));
    } else if (unseen_axes.size() == 24) {
      problem_.SetParameterBlockConstant(parameters_.axes.data());
    }
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
    result.rms_after = plainRms();
    result.geometry = calibrated();
    spread(unseen_axes, 2.0 * summary.final_cost / (3.0 * result.positions - result.parameters), result);
    result.done = true;
    return result;
  }

 private:
  bool begin(GeometryCalibration& result) {
    targets_ = begin_.targets_at_zero;
    if (begin_.r0_from_loading) {
      start_.points_from_base = begin_.r0_from_loading->inverse();
    }
    const bool placed = begin_.r0_from_loading.has_value() &&
                        std::all_of(positions_.begin(), positions_.end(), [&](const UnloadedPosition& p) {
                          return targets_[static_cast<std::size_t>(p.target)].has_value();
                        });
    if (!placed) {
      const auto found = baseFromPostures(begin_, positions_, campaign_.targets.size());
      if (!found) {
        result.reason = Remark(RemarkId::base_not_placed);
        return false;
      }
      start_.points_from_base = found->points_from_base;
      targets_ = found->targets_at_zero;
    }
    start_.axes = begin_.arm.axes_in_base_at_zero;
    for (std::size_t j = 0; j < 6; ++j) {
      metrology::basisAcross(start_.axes[j].direction, start_.across_u[j], start_.across_v[j]);
    }
    return true;
  }

  void build() {
    parameters_.targets.resize(targets_.size());
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      if (targets_[k]) parameters_.targets[k] = {targets_[k]->x(), targets_[k]->y(), targets_[k]->z()};
    }
    for (const UnloadedPosition& position : positions_) {
      const auto k = static_cast<std::size_t>(position.target);
      if (std::find(used_targets_.begin(), used_targets_.end(), k) == used_targets_.end()) used_targets_.push_back(k);
      auto* cost = new PositionCost({start_, begin_.sagged(position.q), position.point, whitening(position)});
      costs_.push_back(cost);
      problem_.AddResidualBlock(cost, nullptr, parameters_.axes.data(), parameters_.base.data(),
                                parameters_.targets[k].data());
    }
    std::sort(used_targets_.begin(), used_targets_.end());
  }

  Eigen::Matrix3d whitening(const UnloadedPosition& position) const {
    if (!campaign_.tracker) return Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance =
        trackerNoise(*campaign_.tracker).covarianceAt(position.point) / position.readings;
    return covariance.inverse().llt().matrixU();
  }

  double plainRms() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      PositionResidual plain = costs_[i]->residual();
      plain.whiten.setIdentity();
      Eigen::Vector3d residual;
      plain(parameters_.axes.data(), parameters_.base.data(),
            parameters_.targets[static_cast<std::size_t>(positions_[i].target)].data(), residual.data());
      sum += residual.squaredNorm();
    }
    return std::sqrt(sum / (3.0 * static_cast<double>(positions_.size())));
  }

  /// Of the whitened residuals by base, reflectors, axes, in this order.
  Eigen::MatrixXd jacobian() {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {parameters_.base.data()};
    for (const std::size_t k : used_targets_) options.parameter_blocks.push_back(parameters_.targets[k].data());
    options.parameter_blocks.push_back(parameters_.axes.data());
    ceres::CRSMatrix sparse;
    problem_.Evaluate(options, nullptr, nullptr, nullptr, &sparse);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row) {
      for (int at = sparse.rows[static_cast<std::size_t>(row)]; at < sparse.rows[static_cast<std::size_t>(row) + 1];
           ++at) {
        dense(row, sparse.cols[static_cast<std::size_t>(at)]) = sparse.values[static_cast<std::size_t>(at)];
      }
    }
    return dense;
  }

  /// The numbers of a column of the Jacobian with the axes' fixed parameters taken out.
  std::vector<double*> freeNumbers(const std::vector<int>& unseen_axes) {
    std::vector<double*> numbers;
    for (double& one : parameters_.base) numbers.push_back(&one);
    for (const std::size_t k : used_targets_) {
      for (double& one : parameters_.targets[k]) numbers.push_back(&one);
    }
    for (int k = 0; k < 24; ++k) {
      if (std::find(unseen_axes.begin(), unseen_axes.end(), k) == unseen_axes.end()) {
        numbers.push_back(&parameters_.axes[static_cast<std::size_t>(k)]);
      }
    }
    return numbers;
  }

  void spread(const std::vector<int>& unseen_axes, double chi2_per_dof, GeometryCalibration& result) {
    const std::vector<double*> numbers = freeNumbers(unseen_axes);
    const auto free = static_cast<Eigen::Index>(numbers.size());
    // The manifold has taken the fixed columns out; without one all are free, or the axes' block is constant.
    const Eigen::MatrixXd columns = jacobian();
    if (columns.cols() != free) return;
    const Eigen::VectorXd scale = columns.colwise().norm().cwiseInverse();
    if (!scale.allFinite()) return;
    const Eigen::MatrixXd scaled = columns * scale.asDiagonal();
    const double factor = campaign_.tracker ? std::max(1.0, chi2_per_dof) : chi2_per_dof;
    const Eigen::LLT<Eigen::MatrixXd> normal(scaled.transpose() * scaled);
    if (normal.info() != Eigen::Success) return;
    // (L L^T)^-1 = S S^T, S = L^-T.
    const Eigen::MatrixXd root =
        std::sqrt(factor) * scale.asDiagonal() * normal.matrixU().solve(Eigen::MatrixXd::Identity(free, free));
    const CalibrationParameters found = parameters_;
    for (Eigen::Index k = 0; k < free; ++k) {
      for (Eigen::Index i = 0; i < free; ++i) *numbers[static_cast<std::size_t>(i)] += root(i, k);
      result.spread.push_back(calibrated());
      restore(found);
    }
  }

  /// In place: the solver and freeNumbers hold addresses.
  void restore(const CalibrationParameters& from) {
    parameters_.axes = from.axes;
    parameters_.base = from.base;
    std::copy(from.targets.begin(), from.targets.end(), parameters_.targets.begin());
  }

  /// Axis parameters whose column of the Jacobian lies in the span of those before it. Base and reflectors
  /// come first and the axes from the tip inwards, so that what is free by choice of frame is fixed in axes 1
  /// and 2, which define R0.
  std::vector<int> findUnseen() {
    const Eigen::MatrixXd columns = jacobian();
    const int axes_at = 6 + 3 * static_cast<int>(used_targets_.size());
    std::vector<int> order;
    for (int k = 0; k < axes_at; ++k) order.push_back(k);
    for (int axis = 5; axis >= 0; --axis) {
      for (int k = 0; k < 4; ++k) order.push_back(axes_at + 4 * axis + k);
    }
    std::vector<int> unseen;
    for (const int column : numerics::columnsInSpanOfEarlier(columns, order)) {
      if (column >= axes_at) unseen.push_back(column - axes_at);
    }
    std::sort(unseen.begin(), unseen.end());
    return unseen;
  }

  LoadingGeometry calibrated() const {
    LoadingGeometry geometry = begin_;
    for (std::size_t j = 0; j < 6; ++j) {
      const metrology::MeasuredLine from{start_.axes[j], start_.across_u[j], start_.across_v[j],
                                         Eigen::Matrix4d::Zero()};
      geometry.arm.axes_in_base_at_zero[j] = from.moved(Eigen::Map<const Eigen::Vector4d>(&parameters_.axes[4 * j]));
    }
    const Eigen::Isometry3d carry = flangeCarry(start_.axes, geometry.arm.axes_in_base_at_zero);
    geometry.arm.base_from_flange_at_zero = carry * geometry.arm.base_from_flange_at_zero;
    for (robot::LinkFrame& link : geometry.arm.links) {
      if (link.body == 6) link.base_from_link_at_zero = carry * link.base_from_link_at_zero;
    }
    for (const std::size_t k : used_targets_) {
      geometry.targets_at_zero[k] = Eigen::Map<const Eigen::Vector3d>(parameters_.targets[k].data());
    }
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    const Eigen::Map<const Eigen::Vector3d> turn(parameters_.base.data());
    if (turn.norm() > 0.0) moved.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    moved.translation() = Eigen::Map<const Eigen::Vector3d>(parameters_.base.data() + 3);
    geometry.r0_from_loading = (moved * start_.points_from_base).inverse();
    return geometry;
  }

  const campaign::Campaign& campaign_;
  const LoadingGeometry& begin_;
  std::vector<UnloadedPosition> positions_;
  std::vector<std::optional<Eigen::Vector3d>> targets_;
  std::vector<std::size_t> used_targets_;
  std::vector<const PositionCost*> costs_;  // owned by the problem
  CalibrationStart start_;
  CalibrationParameters parameters_;
  ceres::Problem problem_;
};

}  // namespace

GeometryCalibration calibrateGeometry(const campaign::Campaign& campaign, const LoadingGeometry& start) {
  return Calibration(campaign, start).run();
}

namespace {

/// A block of derivatives as the solver keeps it: row by row.
template <int Columns>
auto derivatives(double* at) {
  return Eigen::Map<Eigen::Matrix<double, 3, Columns, Eigen::RowMajor>>(at);
}

/// Derivatives of a step of the chain by its own numbers and by the point that comes in.
template <int Own>
struct Step {
  Eigen::Vector3d out;
  Eigen::Matrix<double, 3, Own> by_own;
  Eigen::Matrix3d by_point;
};

/// `step(own, point)` for numbers and points of any scalar.
template <int Own, class Function>
Step<Own> differentiated(const double* own, const Eigen::Vector3d& point, const Function& step) {
  using Jet = ceres::Jet<double, Own + 3>;
  std::array<Jet, Own> numbers;
  for (int k = 0; k < Own; ++k) numbers[static_cast<std::size_t>(k)] = Jet(own[k], k);
  const Eigen::Matrix<Jet, 3, 1> moving(Jet(point.x(), Own), Jet(point.y(), Own + 1), Jet(point.z(), Own + 2));
  const Eigen::Matrix<Jet, 3, 1> moved = step(numbers.data(), moving);
  Step<Own> result;
  for (int row = 0; row < 3; ++row) {
    result.out[row] = moved[row].a;
    result.by_own.row(row) = moved[row].v.template head<Own>().transpose();
    result.by_point.row(row) = moved[row].v.template tail<3>().transpose();
  }
  return result;
}

}  // namespace

bool PositionCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const double *axes = parameters[0], *base = parameters[1], *target = parameters[2];
  if (jacobians == nullptr) return residual_(axes, base, target, residuals);
  Eigen::Vector3d x(target[0], target[1], target[2]);
  std::array<Step<4>, 6> joints;
  for (int joint = 5; joint >= 0; --joint) {
    joints[static_cast<std::size_t>(joint)] = differentiated<4>(
        axes + 4 * joint, x, [&](const auto* own, const auto& point) { return residual_.turned(joint, own, point); });
    x = joints[static_cast<std::size_t>(joint)].out;
  }
  const Step<6> placed =
      differentiated<6>(base, x, [&](const auto* own, const auto& point) { return residual_.placed(own, point); });
  Eigen::Map<Eigen::Vector3d> left(residuals);
  left = residual_.whiten * (residual_.measured - placed.out);
  if (jacobians[1] != nullptr) derivatives<6>(jacobians[1]) = -residual_.whiten * placed.by_own;
  Eigen::Matrix3d chain = -residual_.whiten * placed.by_point;
  for (int joint = 0; joint < 6; ++joint) {
    const Step<4>& step = joints[static_cast<std::size_t>(joint)];
    if (jacobians[0] != nullptr) {
      derivatives<24>(jacobians[0]).middleCols<4>(4 * joint) = chain * step.by_own;
    }
    chain = (chain * step.by_point).eval();
  }
  if (jacobians[2] != nullptr) derivatives<3>(jacobians[2]) = chain;
  return true;
}

}  // namespace stiffscope::frames
