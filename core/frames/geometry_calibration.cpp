#include "core/frames/geometry_calibration.h"

#include <ceres/ceres.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/frames/arm_parameters.h"
#include "core/frames/remarks.h"
#include "core/numerics/normal_equations.h"
#include "core/numerics/parallel.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::frames {

namespace {

struct ReflectorReading {
  std::size_t target;
  Eigen::Vector3d at_zero;  ///< of the reflector, to start with
  Eigen::Vector3d point;    ///< in R0 as the start has it
  Eigen::Matrix3d whiten;
};

struct UnloadedPosture {
  JointVector q;  ///< with the sag in
  std::vector<ReflectorReading> reflectors;
};

/// Of all readings at some values of the parameters, what least squares takes of them.
struct PositionSums {
  Eigen::MatrixXd products;  ///< [J r]^T [J r], r the whitened residuals and J their Jacobian; lower triangle
  double weighted = 0.0;     ///< r^T r
  double plain = 0.0;        ///< the same not whitened, m^2

  PositionSums& operator+=(const PositionSums& other) {
    if (products.size() == 0)
      products = other.products;
    else if (other.products.size() > 0)
      products += other.products;
    weighted += other.weighted;
    plain += other.plain;
    return *this;
  }
};

/// Measured less modelled places of all reflectors, whitened, by ArmParameters. Thousands of rows reach the solver as
/// the few of a triangular factor: with U^T U = [J r]^T [J r], the last column of U as residuals and the others as
/// their Jacobian make the same normal equations and the same cost.
class PositionsCost : public ceres::CostFunction {
 public:
  PositionsCost(const AxesAtStart& axes, const Eigen::Vector3d& centre, std::vector<UnloadedPosture> postures,
                Eigen::Index parameters)
      : axes_(axes), places_(static_cast<int>(axes.size())), centre_(centre), postures_(std::move(postures)) {
    for (const UnloadedPosture& one : postures_) rows_ += 3 * static_cast<Eigen::Index>(one.reflectors.size());
    set_num_residuals(static_cast<int>(parameters) + 1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index count = parameter_block_sizes().front();
    const Eigen::Map<const Eigen::VectorXd> steps(parameters[0], count);
    Eigen::Map<Eigen::VectorXd> left(residuals, count + 1);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      left.setZero();
      left[0] = std::sqrt(sumsAt(steps, false).weighted);
      return true;
    }
    const Eigen::MatrixXd& factor = factorAt(steps);
    left = factor.col(count);
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(jacobians[0], count + 1, count) =
        factor.leftCols(count);
    return true;
  }

  /// That of the factor: its columns have the lengths of the whole one's, and the angles between them.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& steps) const { return factorAt(steps).leftCols(steps.size()); }

  /// Plain, per coordinate, m.
  double rms(const Eigen::VectorXd& steps) const {
    return std::sqrt(sumsAt(steps, false).plain / static_cast<double>(rows_));
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

  /// U at these steps; where they are those asked for last, as computed then.
  const Eigen::MatrixXd& factorAt(const Eigen::Ref<const Eigen::VectorXd>& steps) const {
    if (factor_.size() > 0 && steps == factor_steps_) return factor_;
    const Eigen::LDLT<Eigen::MatrixXd> square(sumsAt(steps, true).products);
    factor_ = square.transpositionsP() * Eigen::MatrixXd::Identity(steps.size() + 1, steps.size() + 1);
    factor_ = square.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() * Eigen::MatrixXd(square.matrixU() * factor_);
    factor_steps_ = steps;
    return factor_;
  }

  PositionSums sumsAt(const Eigen::Ref<const Eigen::VectorXd>& steps, bool with_products) const {
    const PlacedArm arm(axes_, centre_, steps.head(places_.axes()),
                        steps.segment<ArmParameters::kBase>(places_.baseAt()));
    constexpr std::size_t kTogether = 16, kMicroseconds = 64;  // postures, and what they take
    return numerics::sumInBlocks<PositionSums>(
        (postures_.size() + kTogether - 1) / kTogether,
        [&](std::size_t block, PositionSums& sum) {
          const std::size_t from = block * kTogether;
          add(arm, steps, std::span(postures_).subspan(from, std::min(kTogether, postures_.size() - from)),
              with_products, sum);
        },
        kMicroseconds);
  }

  void add(const PlacedArm& arm, const Eigen::Ref<const Eigen::VectorXd>& steps,
           std::span<const UnloadedPosture> postures, bool with_products, PositionSums& sum) const {
    const Eigen::Index count = steps.size();
    std::size_t readings = 0;
    for (const UnloadedPosture& one : postures) readings += one.reflectors.size();
    Rows rows;
    if (with_products) rows.setZero(3 * static_cast<Eigen::Index>(readings), count + 1);
    Eigen::Index row = 0;
    for (const UnloadedPosture& one : postures) {
      const PlacedPosture posture(arm, one.q);
      for (const ReflectorReading& reading : one.reflectors) {
        const Eigen::Index target = places_.targetAt(reading.target);
        const Eigen::Vector3d position = posture.position(reading.at_zero + steps.segment<3>(target));
        const Eigen::Vector3d off = reading.point - position, left = reading.whiten * off;
        sum.weighted += left.squaredNorm();
        sum.plain += off.squaredNorm();
        if (!with_products) continue;
        auto own = rows.middleRows<3>(row);
        own.leftCols(places_.axes()).noalias() = -reading.whiten * posture.byAxes(position);
        own.middleCols<ArmParameters::kBase>(places_.baseAt()).noalias() = -reading.whiten * posture.byBase(position);
        own.middleCols<3>(target).noalias() = -reading.whiten * posture.byTarget();
        own.col(count) = left;
        row += 3;
      }
    }
    if (!with_products) return;
    if (sum.products.size() == 0) sum.products.setZero(count + 1, count + 1);
    sum.products.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  }

  AxesAtStart axes_;
  ArmParameters places_;
  Eigen::Vector3d centre_;
  std::vector<UnloadedPosture> postures_;
  Eigen::Index rows_ = 0;
  mutable Eigen::VectorXd factor_steps_;
  mutable Eigen::MatrixXd factor_;
};

class Calibration {
 public:
  Calibration(const campaign::Campaign& campaign, const LoadingGeometry& start)
      : campaign_(campaign), start_(start), places_(start.arm.axes()) {}

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
    const std::vector<int> unseen = unseenParameters();
    const std::vector<int> free = freeParameters(unseen);
    result.parameters = static_cast<int>(free.size());
    if (3 * result.positions <= result.parameters) {
      result.reason = Remark(RemarkId::too_few_positions, result.positions, result.parameters);
      return result;
    }
    const auto of_axes = std::lower_bound(unseen.begin(), unseen.end(), static_cast<int>(places_.axes()));
    for (auto k = unseen.begin(); k != of_axes; ++k)
      result.fixed.push_back(Remark(RemarkId::axis_parameter, *k / 4 + 1, *k % 4));
    if (of_axes != unseen.end())
      result.fixed.push_back(Remark(RemarkId::base_against_reflectors, unseen.end() - of_axes));
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
    if (summary.termination_type != ceres::CONVERGENCE) {
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
    std::vector<UnloadedPosition> standing = positions_;
    for (UnloadedPosition& position : standing) position.q = start_.sagged(position.q);
    auto found = baseFromPostures(start_.arm, standing, campaign_.targets.size());
    if (!found) return start_.r0_from_loading && placeReflectors(standing);
    std::optional<Eigen::Isometry3d> stated;
    if (start_.r0_from_loading) stated = start_.r0_from_loading->inverse();
    slideToStated(start_.targets_at_zero, stated, *found);
    start_.r0_from_loading = found->points_from_base.inverse();
    for (std::size_t t = 0; t < found->targets_at_zero.size(); ++t) {
      if (found->targets_at_zero[t]) start_.targets_at_zero[t] = found->targets_at_zero[t];
    }
    return true;
  }

  /// Those that nothing places, by the base as it is stated: the mean of where the postures show them.
  bool placeReflectors(const std::vector<UnloadedPosition>& standing) {
    std::vector<Eigen::Vector3d> sums(start_.targets_at_zero.size(), Eigen::Vector3d::Zero());
    std::vector<int> counts(sums.size(), 0);
    for (const UnloadedPosition& position : standing) {
      const auto target = static_cast<std::size_t>(position.target);
      sums[target] +=
          robot::postureAt(start_.arm, position.q).motion.back().inverse() * (*start_.r0_from_loading * position.point);
      ++counts[target];
    }
    for (std::size_t t = 0; t < sums.size(); ++t) {
      if (counts[t] > 0 && !start_.targets_at_zero[t]) start_.targets_at_zero[t] = sums[t] / counts[t];
    }
    return true;
  }

  void build() {
    std::vector<UnloadedPosture> postures;
    std::vector<std::size_t> first;  // of a posture's positions
    int pose = -1;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const UnloadedPosition& position = positions_[i];
      if (position.pose != pose) postures.push_back({position.q, {}}), first.push_back(i);
      pose = position.pose;
      const auto target = static_cast<std::size_t>(position.target);
      const Eigen::Vector3d point = *start_.r0_from_loading * position.point;
      centre_ += point / static_cast<double>(positions_.size());
      postures.back().reflectors.push_back({target, *start_.targets_at_zero[target], point, {}});
      if (std::find(used_targets_.begin(), used_targets_.end(), target) == used_targets_.end())
        used_targets_.push_back(target);
    }
    numerics::smallWorkOnAllCores(postures.size(), [&](std::size_t p) {
      postures[p].q = start_.sagged(postures[p].q);
      std::vector<ReflectorReading>& own = postures[p].reflectors;
      for (std::size_t k = 0; k < own.size(); ++k) own[k].whiten = whitening(positions_[first[p] + k]);
    });
    std::sort(used_targets_.begin(), used_targets_.end());
    steps_ = Eigen::VectorXd::Zero(places_.count(start_.targets_at_zero.size()));
    if (turnsAboutOneDirection(postures)) ideal_ = postures;
    cost_ =
        new PositionsCost(axesAtStart(start_.arm.axes_in_base_at_zero), centre_, std::move(postures), steps_.size());
    problem_.AddResidualBlock(cost_, nullptr, steps_.data());
  }

  /// The URDF's axes in R0.
  robot::ArmAxes drawnAxes() const {
    robot::ArmAxes axes = campaign_.robot.axes_in_base_at_zero;
    for (metrology::Line& axis : axes)
      axis = {start_.r0_from_base_link * axis.point, start_.r0_from_base_link.linear() * axis.direction};
    return axes;
  }

  /// Whether the arm of the URDF turns its flange about one direction only in these postures.
  bool turnsAboutOneDirection(const std::vector<UnloadedPosture>& postures) const {
    const robot::ArmAxes axes = drawnAxes();
    std::optional<Eigen::Matrix3d> first;
    Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
    for (const UnloadedPosture& one : postures) {
      const Eigen::Matrix3d now = robot::postureAt(axes, one.q, Eigen::Isometry3d::Identity()).motion.back().linear();
      if (!first) first = now;
      const Eigen::Vector3d turn = robot::rotationVector(now * first->transpose());
      turns += turn * turn.transpose();
    }
    constexpr double kOther = 1e-6;  // a thousandth of the angle: what the sag makes of it
    const Eigen::VectorXd values = symmetricEigenvalues(turns);
    return values[1] <= kOther * values[2];
  }

  Eigen::Matrix3d whitening(const UnloadedPosition& position) const {
    if (!campaign_.tracker) return Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance =
        trackerNoise(*campaign_.tracker).covarianceAt(position.point, position.from) / position.readings +
        campaign::stationCovariance(campaign_, position.station, position.point);
    const Eigen::Matrix3d in_loading = Eigen::Matrix3d(covariance.inverse()).llt().matrixU();
    return in_loading * start_.r0_from_loading->linear().transpose();
  }

  /// In the order in which fits would rather determine them: base, reflectors, then of the axes; none that is `unseen`.
  std::vector<int> freeParameters(const std::vector<int>& unseen) const {
    std::vector<int> free;
    for (int k = 0; k < ArmParameters::kBase; ++k) free.push_back(static_cast<int>(places_.baseAt()) + k);
    for (const std::size_t t : used_targets_) {
      for (int k = 0; k < 3; ++k) free.push_back(static_cast<int>(places_.targetAt(t)) + k);
    }
    for (int k = 0; k < places_.axes(); ++k) free.push_back(k);
    std::erase_if(free, [&](int k) { return std::binary_search(unseen.begin(), unseen.end(), k); });
    return free;
  }

  /// Parameters whose column of the Jacobian lies in the span of those before it, ascending. Base and reflectors
  /// come first and the axes from the tip inwards, so that what is free by choice of frame is fixed in axes 1
  /// and 2, which define R0. Of base and reflectors it is what no posture tells apart: where the flange turns about one
  /// direction only, how far along it they stand. Of such an arm it is judged by the arm as drawn: the little that its
  /// errors tilt the flange would leave what then is seen a thousand times less certain than the rest.
  std::vector<int> unseenParameters() const {
    std::vector<int> order = freeParameters({});
    auto axes = order.end() - places_.axes();
    for (int axis = start_.arm.axes() - 1; axis >= 0; --axis) {
      for (int k = 0; k < 4; ++k) *axes++ = 4 * axis + k;
    }
    const Eigen::MatrixXd jacobian =
        ideal_ ? PositionsCost(axesAtStart(drawnAxes()), centre_, *ideal_, steps_.size()).jacobian(steps_)
               : cost_->jacobian(steps_);
    std::vector<int> unseen = numerics::columnsInSpanOfEarlier(jacobian, order);
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
  ArmParameters places_;
  std::vector<UnloadedPosition> positions_;
  std::vector<std::size_t> used_targets_;
  std::optional<std::vector<UnloadedPosture>> ideal_;  ///< where the drawn arm says what is seen
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();   ///< mean of the measured points, in R0
  Eigen::VectorXd steps_;                              ///< ArmParameters; the solver holds its address
  PositionsCost* cost_ = nullptr;                      ///< owned by the problem
  ceres::Problem problem_;
};

}  // namespace

GeometryCalibration calibrateGeometry(const campaign::Campaign& campaign, const LoadingGeometry& start) {
  return Calibration(campaign, start).run();
}

}  // namespace stiffscope::frames
