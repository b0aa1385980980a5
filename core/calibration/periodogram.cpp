#include "core/calibration/family_fit.h"

#include <cmath>

#include "core/numerics/parallel.h"

namespace stiffscope::calibration {

namespace {

/// sin and cos of all orders at an angle, by turning on from order to order; every sixteenth anew against rounding.
void wavesAt(double angle, Eigen::MatrixXd& waves, Eigen::Index row) {
  constexpr int kAnew = 16;
  const double turn_sin = std::sin(Periodogram::kStep * angle), turn_cos = std::cos(Periodogram::kStep * angle);
  double sine = 0.0, cosine = 1.0;
  for (int k = 0; k < Periodogram::kOrders; ++k) {
    if (k % kAnew == 0) {
      const double order = Periodogram::kFirst + Periodogram::kStep * k;
      sine = std::sin(order * angle);
      cosine = std::cos(order * angle);
    } else {
      const double next = sine * turn_cos + cosine * turn_sin;
      cosine = cosine * turn_cos - sine * turn_sin;
      sine = next;
    }
    waves(row, k) = sine;
    waves(row, Periodogram::kOrders + k) = cosine;
  }
}

}  // namespace

Periodogram::Periodogram(const std::vector<PostureEquations>& equations, const std::vector<std::size_t>& postures,
                         const UnloadedDay& day, const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual)
    : equations_(&equations), joints_(static_cast<std::size_t>(day.arm.joints())) {
  const auto count = static_cast<Eigen::Index>(postures.size());
  numerics::onAllCores(joints_.size(), [&](std::size_t j) {
    OfJoint& joint = joints_[j];
    const auto waves = std::make_shared<Eigen::MatrixXd>(count, 2 * kOrders);
    joint.waves = waves;
    Eigen::VectorXd squares(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      wavesAt(day.postures[postures[at]].q[static_cast<Eigen::Index>(j)], *waves, i);
      squares[i] = equations[at].by_angles.col(static_cast<Eigen::Index>(j)).squaredNorm();
    }
    const auto sines = waves->leftCols(kOrders).array(), cosines = waves->rightCols(kOrders).array();
    const Eigen::ArrayXd weight = squares.array();
    joint.ss = joint.ss_all = (sines.square().colwise() * weight).colwise().sum().transpose();
    joint.cc = joint.cc_all = (cosines.square().colwise() * weight).colwise().sum().transpose();
    joint.sc = ((sines * cosines).colwise() * weight).colwise().sum().transpose();
    joint.right = productsOf(j, residual).col(0);
    takeOff(j, productsOf(j, basis));
  });
}

Eigen::MatrixXd Periodogram::productsOf(std::size_t joint, const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd by_posture(static_cast<Eigen::Index>(equations_->size()), columns.cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < equations_->size(); ++i) {
    const auto own = (*equations_)[i].by_angles.col(static_cast<Eigen::Index>(joint));
    by_posture.row(static_cast<Eigen::Index>(i)).noalias() = own.transpose() * columns.middleRows(row, own.size());
    row += own.size();
  }
  const Eigen::MatrixXd& waves = *joints_[joint].waves;
  constexpr Eigen::Index kFew = 4;
  if (columns.cols() > kFew) return waves.transpose() * by_posture;
  // A product of matrices would copy all waves into another order first.
  Eigen::MatrixXd products(waves.cols(), columns.cols());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) products.col(k).noalias() = waves.transpose() * by_posture.col(k);
  return products;
}

void Periodogram::takeOff(std::size_t j, const Eigen::MatrixXd& products) {
  OfJoint& joint = joints_[j];
  const auto sines = products.topRows(kOrders).array(), cosines = products.bottomRows(kOrders).array();
  joint.ss -= sines.square().rowwise().sum();
  joint.cc -= cosines.square().rowwise().sum();
  joint.sc -= (sines * cosines).rowwise().sum();
}

void Periodogram::projectOff(const Eigen::MatrixXd& directions, const Eigen::VectorXd& coefficients) {
  if (directions.cols() == 0) return;
  constexpr Eigen::Index kWorthSharing = 1000;  // numbers: each is multiplied with all waves
  numerics::onAllCores(
      joints_.size(),
      [&](std::size_t j) {
        const Eigen::MatrixXd products = productsOf(j, directions);
        joints_[j].right -= products * coefficients;
        takeOff(j, products);
      },
      directions.size() > kWorthSharing);
}

std::vector<PeriodicPeak> Periodogram::peaks() const {
  std::vector<PeriodicPeak> peaks;
  constexpr double kAliased = 1e-4;  // of the squares: what the basis nearly does itself has no size of its own
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const OfJoint& joint = joints_[j];
    PeriodicPeak best{static_cast<int>(j), 0.0, 0.0};
    for (Eigen::Index k = 0; k < kOrders; ++k) {
      const double ss = joint.ss[k], cc = joint.cc[k], sc = joint.sc[k], determinant = ss * cc - sc * sc;
      const double all = std::max(joint.ss_all[k], joint.cc_all[k]);
      if (!(std::min(ss, cc) > kAliased * all) || !(determinant > kAliased * ss * cc)) continue;
      const double s = joint.right[k], c = joint.right[kOrders + k];
      const double gain = (cc * s * s - 2.0 * sc * s * c + ss * c * c) / determinant;
      if (gain > best.gain) {
        best.gain = gain;
        best.order = kFirst + kStep * static_cast<double>(k);
      }
    }
    if (best.gain > 0.0) peaks.push_back(best);
  }
  return peaks;
}

}  // namespace stiffscope::calibration
