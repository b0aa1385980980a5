#include "metrology/registration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "metrology/least_squares.h"
#include "metrology/remarks.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::metrology {

namespace {

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Axes of a triangle: along its first side, across it in its plane, normal to it. Columns.
Eigen::Matrix3d axesOf(const std::vector<Eigen::Vector3d>& triangle) {
  const Eigen::Vector3d side = (triangle[1] - triangle[0]).normalized();
  const Eigen::Vector3d normal = side.cross(triangle[2] - triangle[0]).normalized();
  Eigen::Matrix3d axes;
  axes << side, normal.cross(side), normal;
  return axes;
}

/// The rotation of two triangles, `cross` as below: it brings plane onto plane, and within the plane a polar
/// factor of two by two numbers has its angle in closed form. Empty where a triangle is nearly a line, or
/// turned over in the plane.
std::optional<Eigen::Matrix3d> rotationOfTriangles(const std::vector<Eigen::Vector3d>& source,
                                                   const std::vector<Eigen::Vector3d>& to,
                                                   const Eigen::Matrix3d& cross) {
  const Eigen::Matrix3d from_axes = axesOf(source), to_axes = axesOf(to);
  const Eigen::Matrix2d plane = (to_axes.transpose() * cross * from_axes).topLeftCorner<2, 2>();
  constexpr double kSlender = 1e-6;  // of the two sizes of the cross products
  if (!(plane.determinant() > kSlender * plane.squaredNorm())) return std::nullopt;
  const double sine = plane(1, 0) - plane(0, 1), cosine = plane(0, 0) + plane(1, 1), size = std::hypot(sine, cosine);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << cosine / size, -sine / size, sine / size, cosine / size;
  return to_axes * turn * from_axes.transpose();
}

/// Of least squares by the singular vectors of `cross`; empty for points on one line.
std::optional<Eigen::Matrix3d> rotationOf(const Eigen::Matrix3d& cross) {
  const NearestRotation nearest = nearestRotation(cross);
  constexpr double kOnOneLine = 1e-12;
  if (!(nearest.singular_values[1] > kOnOneLine * nearest.singular_values[0])) return std::nullopt;
  return nearest.rotation;
}

}  // namespace

bool nearlyOnOneLine(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kSlender = 1e-4;  // of squares
  if (points.size() < 3) return true;
  const Eigen::Vector3d middle = mean(points);
  if (points.size() == 3) {
    // In their plane, by the sum and the product of both sums of squares: many thousand times a day.
    double sum = 0.0;
    for (const Eigen::Vector3d& point : points) sum += (point - middle).squaredNorm();
    const double product = (points[1] - points[0]).cross(points[2] - points[0]).squaredNorm() / 3.0;
    const double larger = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
    return !(product > kSlender * larger * larger);
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) spread += (point - middle) * (point - middle).transpose();
  const Eigen::Vector3d sizes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  return !(sizes[1] > kSlender * sizes[2]);
}

RigidRegistration registerRigid(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& to) {
  RigidRegistration result;
  if (source.size() < 3 || source.size() != to.size()) {
    result.reason = Remark(RemarkId::too_few_common_points);
    return result;
  }
  const Eigen::Vector3d source_mean = mean(source), to_mean = mean(to);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    cross += (to[i] - to_mean) * (source[i] - source_mean).transpose();
  }
  std::optional<Eigen::Matrix3d> rotation;
  if (source.size() == 3) rotation = rotationOfTriangles(source, to, cross);
  if (!rotation) rotation = rotationOf(cross);
  if (!rotation) {
    result.reason = Remark(RemarkId::points_on_one_line);
    return result;
  }
  result.to_from_source.linear() = *rotation;
  result.to_from_source.translation() = to_mean - result.to_from_source.linear() * source_mean;
  double sum = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) sum += (result.to_from_source * source[i] - to[i]).squaredNorm();
  result.rms = std::sqrt(sum / (3.0 * static_cast<double>(source.size())));
  result.determined = true;
  return result;
}

namespace {

/// A rigid motion by differences m(source_i) - to_i, in the local units of `to`. Shared parameters: rotation
/// vector about the local origin, shift, both after the motion.
class MotionModel : public Model {
 public:
  MotionModel(const Eigen::Isometry3d& start, const std::vector<Eigen::Vector3d>& from)
      : to_from_source(start), source_(from), before_(start) {}

  Size size() const override { return {6, 0, 3}; }
  void observe(std::size_t i, const Eigen::Vector3d& to, const double*, Observation& seen) const override {
    const Eigen::Vector3d moved = to_from_source * source_[i];
    seen.residual = {moved.x() - to.x(), moved.y() - to.y(), moved.z() - to.z()};
    seen.rows[0] = {0.0, moved.z(), -moved.y(), 1.0, 0.0, 0.0};
    seen.rows[1] = {-moved.z(), 0.0, moved.x(), 0.0, 1.0, 0.0};
    seen.rows[2] = {moved.y(), -moved.x(), 0.0, 0.0, 0.0, 1.0};
    seen.directions = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  }
  void move(const Eigen::VectorXd& step) override {
    before_ = to_from_source;
    const double angle = step.head<3>().norm();
    const Eigen::Vector3d about = angle > 0.0 ? Eigen::Vector3d(step.head<3>() / angle) : Eigen::Vector3d::UnitX();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, about).toRotationMatrix();
    to_from_source.linear() = Eigen::Quaterniond(turn * to_from_source.linear()).normalized().toRotationMatrix();
    to_from_source.translation() = turn * to_from_source.translation() + step.tail<3>();
  }
  void undo() override { to_from_source = before_; }

  Eigen::Isometry3d to_from_source;  ///< of source points about their mean, in local units

 private:
  const std::vector<Eigen::Vector3d>& source_;
  Eigen::Isometry3d before_;
};

}  // namespace

WeightedRegistration registerRigid(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& to,
                                   const std::vector<Eigen::Matrix3d>& covariances) {
  WeightedRegistration result;
  static_cast<RigidRegistration&>(result) = registerRigid(source, to);
  if (!result.determined) return result;
  result.determined = false;
  const MeasuredPoints goal{to, covariances};
  const LocalPoints local = localPoints(&goal, 1);
  result.reason = !local.flaw.empty()   ? local.flaw
                  : covariances.empty() ? Remark(RemarkId::covariances_not_one_a_pair)
                                        : Remark();
  if (!result.reason.empty()) return result;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : source) source_mean += point / static_cast<double>(source.size());
  std::vector<Eigen::Vector3d> from;
  for (const Eigen::Vector3d& point : source) from.push_back((point - source_mean) / local.scale);

  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.linear() = result.to_from_source.linear();
  start.translation() = (result.to_from_source * source_mean - local.origin) / local.scale;
  MotionModel model(start, from);
  const Estimate estimate = fitLeastSquares(model, local);
  if (!estimate.determined) {
    result.reason = Remark(RemarkId::motion_not_determined);
    return result;
  }
  const Eigen::Isometry3d& found = model.to_from_source;
  result.to_from_source.linear() = found.linear();
  result.to_from_source.translation() = local.origin + local.scale * found.translation() - found.linear() * source_mean;
  Eigen::Matrix<double, 6, 1> units;
  units << 1.0, 1.0, 1.0, local.scale, local.scale, local.scale;
  const Eigen::Matrix<double, 6, 6> cofactor = estimate.cofactor;
  result.covariance = varianceFactor(estimate, true) * (units.asDiagonal() * cofactor * units.asDiagonal());
  result.pivot = local.origin;
  result.degrees_of_freedom = estimate.degreesOfFreedom();
  result.chi2_per_dof = estimate.chi2 / result.degrees_of_freedom;
  result.rms = local.scale * std::sqrt(estimate.plain / estimate.residuals);
  result.determined = true;
  return result;
}

}  // namespace stiffscope::metrology
