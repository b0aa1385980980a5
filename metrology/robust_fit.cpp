#include "metrology/robust_fit.h"

#include <cmath>
#include <limits>

#include "metrology/shape_models.h"
#include "metrology/tail_probability.h"

namespace stiffscope::metrology {

namespace {

template <class Model>
constexpr int kColumns = Model::kShared + Model::kOwn;

/// The cofactor of the parameters that the readings of group k see.
template <class Model, int Groups>
Eigen::Matrix<double, kColumns<Model>, kColumns<Model>> cofactorOf(std::size_t k,
                                                                   const Estimate<Model, Groups>& estimate) {
  Eigen::Matrix<double, kColumns<Model>, kColumns<Model>> block;
  const auto place = [k](int i) {
    return static_cast<Eigen::Index>(i < Model::kShared ? i : i + Model::kOwn * static_cast<int>(k));
  };
  for (int i = 0; i < kColumns<Model>; ++i) {
    for (int j = 0; j < kColumns<Model>; ++j) block(i, j) = estimate.cofactor(place(i), place(j));
  }
  return block;
}

/// e' (I - H)^-1 e; 0 where the reading alone determines a parameter.
template <class Model>
double controlled(const Observation<Model>& seen,
                  const Eigen::Matrix<double, kColumns<Model>, kColumns<Model>>& cofactor) {
  using Square = Eigen::Matrix<double, Model::kResiduals, Model::kResiduals>;
  const Square left = Square::Identity() - seen.rows * cofactor * seen.rows.transpose();
  const Eigen::SelfAdjointEigenSolver<Square> eigen(left);
  constexpr double kUncontrolled = 1e-8;  // beyond the rounding of the cofactor on arcs of some degrees
  if (!(eigen.eigenvalues()[0] > kUncontrolled)) return 0.0;
  const auto across = (eigen.eigenvectors().transpose() * seen.residual).eval();
  return across.cwiseAbs2().cwiseQuotient(eigen.eigenvalues()).sum();
}

/// `estimate` stands at the fitted shape; a step or two of `refine` bring its cofactor.
template <class Model, int Groups>
ReadingTests testsOf(Estimate<Model, Groups> estimate, const LocalPoints& local) {
  refine(estimate, local);
  ReadingTests tests;
  tests.residuals = Model::kResiduals;
  tests.variance_degrees = local.weighted() ? 0 : estimate.degreesOfFreedom() - Model::kResiduals;
  if (!estimate.determined || (!local.weighted() && tests.variance_degrees < 1)) return tests;
  const double rounding = 4.0 * (local.rounding + std::numeric_limits<double>::epsilon());
  for (std::size_t k = 0; k < local.groups.size(); ++k) {
    const auto cofactor = cofactorOf(k, estimate);
    for (std::size_t i = 0; i < local.groups[k].points.size(); ++i) {
      const auto seen = whitened<Model>(estimate.model, estimate.own.col(static_cast<Eigen::Index>(k)), local,
                                        local.groups[k], i);
      const double square = controlled<Model>(seen, cofactor);
      const double others =
          local.weighted() ? 1.0
                           : std::max((estimate.chi2 - square) / tests.variance_degrees, rounding * rounding);
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
  return std::sqrt(variance_degrees == 0 ? chiSquareLimit(level, residuals) : residuals * fLimit(level, residuals, variance_degrees));
}

ReadingTests readingTests(const FittedLine& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(Estimate<LineModel, 1>{{frameOf(fit.line.point, fit.line.direction, local)}}, local);
}

ReadingTests readingTests(const FittedPlane& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  const AxisFrame normal(Eigen::Vector3d::Zero(), fit.plane.normal);
  const double height = fit.plane.normal.dot(fit.plane.point - local.origin) / local.scale;
  return testsOf(Estimate<PlanesModel, 1>{{normal}, Eigen::Matrix<double, 1, 1>(height)}, local);
}

ReadingTests readingTests(const FittedCircle& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(Estimate<CirclesModel, 1>{{frameOf(fit.circle.centre, fit.circle.normal, local)},
                                           Eigen::Vector2d(fit.circle.radius / local.scale, 0.0)},
                 local);
}

ReadingTests readingTests(const FittedSphere& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(Estimate<SpheresModel, 1>{{(fit.sphere.centre - local.origin) / local.scale},
                                           Eigen::Matrix<double, 1, 1>(fit.sphere.radius / local.scale)},
                 local);
}

ReadingTests readingTests(const FittedCylinder& fit, const MeasuredPoints& points) {
  const LocalPoints local = localPoints(&points, 1);
  return testsOf(
      Estimate<CylindersModel, 1>{{frameOf(fit.cylinder.axis.point, fit.cylinder.axis.direction, local)},
                                  Eigen::Matrix<double, 1, 1>(fit.cylinder.radius / local.scale)},
      local);
}

ReadingTests readingTests(const AxisFit& fit, const std::vector<CirclePoints>& circles) {
  const LocalPoints local = localPoints(circles.data(), circles.size());
  Eigen::Matrix2Xd own(2, static_cast<Eigen::Index>(circles.size()));
  for (std::size_t k = 0; k < circles.size(); ++k) {
    own.col(static_cast<Eigen::Index>(k)) << fit.circles[k].radius / local.scale,
        fit.circles[k].height / local.scale;
  }
  return testsOf(
      Estimate<CirclesModel, Eigen::Dynamic>{{frameOf(fit.axis.line.point, fit.axis.line.direction, local)},
                                             own},
      local);
}

ReadingTests readingTests(const SphereFit& fit, const std::vector<SpherePoints>& spheres) {
  const LocalPoints local = localPoints(spheres.data(), spheres.size());
  const Eigen::RowVectorXd radii =
      Eigen::Map<const Eigen::RowVectorXd>(fit.radii.data(), static_cast<Eigen::Index>(fit.radii.size())) /
      local.scale;
  return testsOf(Estimate<SpheresModel, Eigen::Dynamic>{{(fit.centre - local.origin) / local.scale}, radii},
                 local);
}

}  // namespace stiffscope::metrology
