#include "metrology/axis_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrology/swept_arc.h"

namespace stiffscope {

namespace {

/// Radial and axial place of a point in a cylinder frame, with the unit vector of the radial direction.
struct CylinderPlace {
  double radius, height;
  Eigen::Vector3d outward;
};

CylinderPlace placeAbout(const Line& axis, const Eigen::Vector3d& point) {
  const Eigen::Vector3d from_axis = point - axis.point;
  const double height = axis.direction.dot(from_axis);
  const Eigen::Vector3d radial = from_axis - height * axis.direction;
  const double radius = radial.norm();
  return {radius, height, radius > 0.0 ? Eigen::Vector3d(radial / radius) : axis.direction.unitOrthogonal()};
}

Eigen::Vector3d centroid(const CirclePoints& circle) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& point : circle.points) sum += point;
  return sum / static_cast<double>(circle.points.size());
}

/// Normal of the planes that the circles share: least spread of all points about their own centroids.
/// Returns false where the points do not span a plane.
bool pooledNormal(const std::vector<CirclePoints>& circles, Eigen::Vector3d& normal) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& circle : circles) {
    if (circle.points.size() < 3) continue;
    const Eigen::Vector3d mean = centroid(circle);
    for (const auto& point : circle.points) scatter += (point - mean) * (point - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  normal = eigen.eigenvectors().col(0);
  constexpr double kFlat = 1e-12;  // second spread against first: points on one line, squared
  return eigen.eigenvalues()[1] > kFlat * eigen.eigenvalues()[2] && eigen.eigenvalues()[2] > 0.0;
}

/// Common centre of concentric circles in the plane across `normal`: |x|^2 - 2 c.x + s_k = 0 is linear in c and
/// s_k; subtracting each circle's mean removes s_k.
Eigen::Vector3d algebraicCentre(const std::vector<CirclePoints>& circles, const Eigen::Vector3d& normal) {
  Eigen::Vector3d u, v;
  basisAcross(normal, u, v);
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& circle : circles) {
    for (const auto& point : circle.points) origin += point, count += 1.0;
  }
  origin /= count;
  Eigen::Matrix2d normal_matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const auto& circle : circles) {
    if (circle.points.size() < 3) continue;
    const double n = static_cast<double>(circle.points.size());
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    double mean_square = 0.0;
    for (const auto& point : circle.points) {
      const Eigen::Vector2d flat(u.dot(point - origin), v.dot(point - origin));
      mean += flat / n;
      mean_square += flat.squaredNorm() / n;
    }
    for (const auto& point : circle.points) {
      const Eigen::Vector2d flat(u.dot(point - origin), v.dot(point - origin));
      normal_matrix += (flat - mean) * (flat - mean).transpose();
      right += 0.5 * (flat.squaredNorm() - mean_square) * (flat - mean);
    }
  }
  const Eigen::Vector2d centre = normal_matrix.colPivHouseholderQr().solve(right);
  return origin + centre[0] * u + centre[1] * v;
}

/// Weighted normal equations of one step: parameters (shift_u, shift_v, tilt_u, tilt_v, r_1, h_1, r_2, ...).
struct Step {
  Eigen::MatrixXd normal_matrix;
  Eigen::VectorXd right;
  double chi2 = 0.0;
  double plain = 0.0;
  int residuals = 0;
};

Step linearise(const std::vector<CirclePoints>& circles, const MeasuredLine& axis,
               const std::vector<AxisCircle>& shapes) {
  const int size = 4 + 2 * static_cast<int>(circles.size());
  Step step{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (std::size_t k = 0; k < circles.size(); ++k) {
    const int at = 4 + 2 * static_cast<int>(k);
    for (std::size_t i = 0; i < circles[k].points.size(); ++i) {
      const CylinderPlace place = placeAbout(axis.line, circles[k].points[i]);
      const double eu = place.outward.dot(axis.across_u), ev = place.outward.dot(axis.across_v);
      Eigen::Matrix<double, 2, 6> rows;  // of (radius - r_k, height - h_k) by (line, r_k, h_k)
      rows << -eu, -ev, -place.height * eu, -place.height * ev, -1.0, 0.0,  //
          0.0, 0.0, place.radius * eu, place.radius * ev, 0.0, -1.0;
      Eigen::Vector2d residual(place.radius - shapes[k].radius, place.height - shapes[k].height);
      step.plain += residual.squaredNorm();
      if (!circles[k].covariances.empty()) {
        Eigen::Matrix<double, 3, 2> directions;
        directions << place.outward, axis.line.direction;
        const Eigen::Matrix2d covariance = directions.transpose() * circles[k].covariances[i] * directions;
        const Eigen::LLT<Eigen::Matrix2d> cholesky(covariance);
        rows = cholesky.matrixL().solve(rows).eval();
        residual = cholesky.matrixL().solve(residual).eval();
      }
      step.chi2 += residual.squaredNorm();
      step.residuals += 2;
      Eigen::Matrix<double, 6, 6> block = rows.transpose() * rows;
      const Eigen::Matrix<double, 6, 1> gradient = rows.transpose() * residual;
      step.normal_matrix.topLeftCorner<4, 4>() += block.topLeftCorner<4, 4>();
      step.normal_matrix.block<4, 2>(0, at) += block.topRightCorner<4, 2>();
      step.normal_matrix.block<2, 4>(at, 0) += block.bottomLeftCorner<2, 4>();
      step.normal_matrix.block<2, 2>(at, at) += block.bottomRightCorner<2, 2>();
      step.right.head<4>() -= gradient.head<4>();
      step.right.segment<2>(at) -= gradient.tail<2>();
    }
  }
  return step;
}

std::vector<AxisCircle> shapesAbout(const Line& axis, const std::vector<CirclePoints>& circles) {
  std::vector<AxisCircle> shapes(circles.size());
  for (std::size_t k = 0; k < circles.size(); ++k) {
    for (const auto& point : circles[k].points) {
      const CylinderPlace place = placeAbout(axis, point);
      shapes[k].radius += place.radius / static_cast<double>(circles[k].points.size());
      shapes[k].height += place.height / static_cast<double>(circles[k].points.size());
    }
  }
  return shapes;
}

void describeCircles(const std::vector<CirclePoints>& circles, AxisFit& fit) {
  for (std::size_t k = 0; k < circles.size(); ++k) {
    double sum = 0.0;
    for (const auto& point : circles[k].points) {
      const CylinderPlace place = placeAbout(fit.axis.line, point);
      sum += std::pow(place.radius - fit.circles[k].radius, 2) + std::pow(place.height - fit.circles[k].height, 2);
    }
    fit.circles[k].rms = std::sqrt(sum / (2.0 * static_cast<double>(circles[k].points.size())));
    fit.circles[k].arc = sweptArc(fit.axis.line, circles[k].points);
  }
}

}  // namespace

AxisFit fitAxis(const std::vector<CirclePoints>& circles) {
  AxisFit fit;
  const bool enough = std::any_of(circles.begin(), circles.end(),
                                  [](const CirclePoints& circle) { return circle.points.size() >= 3; });
  if (!enough) {
    fit.reason = "no reflector has three readings or more";
    return fit;
  }
  if (std::any_of(circles.begin(), circles.end(), [](const CirclePoints& circle) { return circle.points.empty(); })) {
    fit.reason = "a reflector has no readings";
    return fit;
  }
  if (!pooledNormal(circles, fit.axis.line.direction)) {
    fit.reason = "the readings lie on one line or in one place";
    return fit;
  }
  fit.axis.line.point = algebraicCentre(circles, fit.axis.line.direction);
  fit.circles = shapesAbout(fit.axis.line, circles);

  Step step;
  constexpr int kMostSteps = 50;
  for (int iteration = 0; iteration < kMostSteps; ++iteration) {
    basisAcross(fit.axis.line.direction, fit.axis.across_u, fit.axis.across_v);
    step = linearise(circles, fit.axis, fit.circles);
    const Eigen::LDLT<Eigen::MatrixXd> solver(step.normal_matrix);
    const Eigen::VectorXd change = solver.solve(step.right);
    if (!change.allFinite()) {
      fit.reason = "the readings do not determine the axis";
      return fit;
    }
    fit.axis.line = fit.axis.moved(change.head<4>());
    for (std::size_t k = 0; k < circles.size(); ++k) {
      fit.circles[k].radius += change[4 + 2 * static_cast<int>(k)];
      fit.circles[k].height += change[5 + 2 * static_cast<int>(k)];
    }
    if (change.cwiseAbs().maxCoeff() < 1e-12) break;
  }

  basisAcross(fit.axis.line.direction, fit.axis.across_u, fit.axis.across_v);
  step = linearise(circles, fit.axis, fit.circles);
  fit.degrees_of_freedom = step.residuals - static_cast<int>(step.right.size());
  if (fit.degrees_of_freedom < 1) {
    fit.reason = "too few readings for an axis with its uncertainty";
    return fit;
  }
  const bool weighted = !circles.front().covariances.empty();
  const double variance = step.chi2 / fit.degrees_of_freedom;
  fit.chi2_per_dof = weighted ? variance : 1.0;
  const double scale = weighted ? std::max(1.0, variance) : variance;
  const Eigen::MatrixXd inverse =
      step.normal_matrix.ldlt().solve(Eigen::MatrixXd::Identity(step.right.size(), step.right.size()));
  fit.axis.covariance = scale * inverse.topLeftCorner<4, 4>();
  fit.rms = std::sqrt(step.plain / step.residuals);
  describeCircles(circles, fit);
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope
