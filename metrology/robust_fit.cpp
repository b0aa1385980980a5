#include "metrology/robust_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "metrology/shape_models.h"
#include "metrology/tail_probability.h"

namespace stiffscope::metrology {

namespace {

using Rows = Eigen::Matrix<double, 2, Observation::kMaxColumns>;
using Columns = Eigen::Matrix<double, Observation::kMaxColumns, Observation::kMaxColumns>;

/// The cofactor of the parameters that the readings of group k see; zero beyond them.
Columns cofactorOf(std::size_t k, const Model::Size& size, const Estimate& estimate) {
  Columns block = Columns::Zero();
  const auto place = [&](int i) {
    return static_cast<Eigen::Index>(i < size.shared ? i : i + size.own * static_cast<int>(k));
  };
  for (int i = 0; i < size.columns(); ++i) {
    for (int j = 0; j < size.columns(); ++j) block(i, j) = estimate.cofactor(place(i), place(j));
  }
  return block;
}

/// e' (I - H)^-1 e; 0 where the reading alone determines a parameter.
double controlled(const Observation& seen, const Model::Size& size, const Columns& cofactor) {
  // A single residual is one of two, the other being 0 whatever the parameters.
  Rows rows = Rows::Zero();
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  for (int r = 0; r < size.residuals; ++r) {
    residual[r] = seen.residual[r];
    for (int c = 0; c < size.columns(); ++c) rows(r, c) = seen.rows[r][c];
  }
  const Eigen::Matrix2d left = Eigen::Matrix2d::Identity() - rows * cofactor * rows.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(left);
  constexpr double kUncontrolled = 1e-8;  // beyond the rounding of the cofactor on arcs of some degrees
  if (!(eigen.eigenvalues()[0] > kUncontrolled)) return 0.0;
  const Eigen::Vector2d across = eigen.eigenvectors().transpose() * residual;
  return across.cwiseAbs2().cwiseQuotient(eigen.eigenvalues()).sum();
}

/// `model` and `own` stand at the fitted shape; a step or two bring the cofactor.
ReadingTests testsOf(Model&& model, const LocalPoints& local, const Eigen::MatrixXd& own = {}) {
  const Estimate estimate = fitLeastSquares(model, local, own);
  const Model::Size size = model.size();
  ReadingTests tests;
  tests.residuals = size.residuals;
  tests.variance_degrees = local.weighted() ? 0 : estimate.degreesOfFreedom() - size.residuals;
  if (!estimate.determined || (!local.weighted() && tests.variance_degrees < 1)) return tests;
  const double rounding = 4.0 * (local.rounding + std::numeric_limits<double>::epsilon());
  for (std::size_t k = 0; k < local.groups.size(); ++k) {
    const Columns cofactor = cofactorOf(k, size, estimate);
    const double* own_of_group = estimate.own.data() + static_cast<std::size_t>(size.own) * k;
    for (std::size_t i = 0; i < local.groups[k].points.size(); ++i) {
      const Observation seen = whitened(model, own_of_group, local, local.groups[k], i);
      const double square = controlled(seen, size, cofactor);
      const double others =
          local.weighted() ? 1.0 : std::max((estimate.chi2 - square) / tests.variance_degrees, rounding * rounding);
      tests.readings.push_back({k, i, std::sqrt(square / others)});
    }
  }
  return tests;
}

AxisFrame frameOf(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, const LocalPoints& local) {
  return {(point - local.origin) / local.scale, direction};
}

}  // namespace

double ReadingTests::criticalW(double level) const {
  return std::sqrt(variance_degrees == 0 ? chiSquareLimit(level, residuals)
                                         : residuals * fLimit(level, residuals, variance_degrees));
}

ReadingTests readingTests(const FittedLine& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(LineModel(frameOf(fit.line.point, fit.line.direction, local)), local);
}

ReadingTests readingTests(const FittedPlane& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  const double height = fit.plane.normal.dot(fit.plane.point - local.origin) / local.scale;
  return testsOf(PlanesModel(AxisFrame(Eigen::Vector3d::Zero(), fit.plane.normal)), local,
                 Eigen::MatrixXd::Constant(1, 1, height));
}

ReadingTests readingTests(const FittedCircle& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(CirclesModel(frameOf(fit.circle.centre, fit.circle.normal, local)), local,
                 Eigen::Vector2d(fit.circle.radius / local.scale, 0.0));
}

ReadingTests readingTests(const FittedSphere& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(SpheresModel((fit.sphere.centre - local.origin) / local.scale), local,
                 Eigen::MatrixXd::Constant(1, 1, fit.sphere.radius / local.scale));
}

ReadingTests readingTests(const FittedCylinder& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(CylindersModel(frameOf(fit.cylinder.axis.point, fit.cylinder.axis.direction, local)), local,
                 Eigen::MatrixXd::Constant(1, 1, fit.cylinder.radius / local.scale));
}

ReadingTests readingTests(const AxisFit& fit, const std::vector<CirclePoints>& circles) {
  const LocalPoints local = localPoints(circles.data(), circles.size());
  Eigen::MatrixXd own(2, static_cast<Eigen::Index>(circles.size()));
  for (std::size_t k = 0; k < circles.size(); ++k) {
    own(0, static_cast<Eigen::Index>(k)) = fit.circles[k].radius / local.scale;
    own(1, static_cast<Eigen::Index>(k)) = fit.circles[k].height / local.scale;
  }
  return testsOf(CirclesModel(frameOf(fit.axis.line.point, fit.axis.line.direction, local)), local, own);
}

ReadingTests readingTests(const SphereFit& fit, const std::vector<SpherePoints>& spheres) {
  const LocalPoints local = localPoints(spheres.data(), spheres.size());
  Eigen::MatrixXd radii(1, static_cast<Eigen::Index>(spheres.size()));
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    radii(0, static_cast<Eigen::Index>(k)) = fit.radii[k] / local.scale;
  }
  return testsOf(SpheresModel((fit.centre - local.origin) / local.scale), local, radii);
}

DataSnooping snoopReadings(std::vector<MeasuredPoints> readings, const FitAndTest& fit_and_test, double family_level) {
  std::size_t given = 0;
  std::vector<std::vector<std::size_t>> index(readings.size());  // of each reading that is left, as it was given
  for (std::size_t k = 0; k < readings.size(); ++k) {
    for (std::size_t i = 0; i < readings[k].points.size(); ++i) index[k].push_back(i);
    given += index[k].size();
  }
  DataSnooping found;
  for (std::optional<ReadingTests> tests = fit_and_test(readings); tests && !tests->readings.empty();
       tests = fit_and_test(readings)) {
    const double level = -std::expm1(std::log1p(-family_level) / static_cast<double>(tests->readings.size()));
    found.critical_w = tests->criticalW(level);
    const ReadingTest worst = *std::max_element(tests->readings.begin(), tests->readings.end(),
                                                [](const auto& a, const auto& b) { return a.w < b.w; });
    if (!(worst.w > found.critical_w)) break;
    const auto at = static_cast<std::ptrdiff_t>(worst.index);
    MeasuredPoints& from = readings[worst.group];
    found.rejected.push_back({worst.group, index[worst.group][worst.index], worst.w, found.critical_w});
    index[worst.group].erase(index[worst.group].begin() + at);
    from.points.erase(from.points.begin() + at);
    if (!from.covariances.empty()) from.covariances.erase(from.covariances.begin() + at);
    if (3 * found.rejected.size() > given) {
      found.contradictory = true;
      break;
    }
  }
  return found;
}

}  // namespace stiffscope::metrology
