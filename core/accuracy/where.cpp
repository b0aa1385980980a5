#include "core/accuracy/where_next.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/calibration/fitted_day.h"
#include "core/numerics/distributions.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::accuracy {

namespace {

using calibration::ArmFit;
using calibration::UnloadedDay;

/// Squares of a part of the residual, and of the noise there.
struct Part {
  std::string name;
  double squares = 0.0, noise = 0.0, coordinates = 0.0;

  void add(double square, double variance, double count) {
    squares += square;
    noise += variance;
    coordinates += count;
  }
};

/// A reading's residual and covariance in base_link.
struct Left {
  std::size_t posture = 0;
  int target = 0;
  Eigen::Vector3d residual, at, beam;
  Eigen::Matrix3d covariance;
};

std::vector<Left> leftOver(const UnloadedDay& day, const ArmFit& fit) {
  const std::vector<Eigen::Vector3d> residuals = calibration::residualsOf(day, fit);
  const Eigen::Isometry3d& base_from_points = fit.place.base_from_points;
  std::vector<Left> left;
  std::size_t at = 0;
  for (std::size_t i = 0; i < day.postures.size(); ++i) {
    for (const calibration::Reading& reading : day.postures[i].readings) {
      if (fit.weights[at] > 0.0) {
        const Eigen::Vector3d point = base_from_points * reading.point;
        const Eigen::Vector3d station = base_from_points * day.stationOf(reading);
        left.push_back({i, reading.target, residuals[at], point, (point - station).normalized(),
                        base_from_points.linear() * reading.covariance * base_from_points.linear().transpose()});
      }
      ++at;
    }
  }
  return left;
}

diagnosis::WhereTable tableOf(std::string by, const std::vector<Part>& parts, double all_squares) {
  diagnosis::WhereTable table{std::move(by), {}};
  for (const Part& part : parts) {
    if (part.coordinates <= 0.0) continue;
    diagnosis::WhereRow row;
    row.name = part.name;
    row.rms = std::sqrt(part.squares / part.coordinates);
    row.noise = std::sqrt(part.noise / part.coordinates);
    row.share = all_squares > 0.0 ? part.squares / all_squares : 0.0;
    row.significance = part.noise > 0.0
                           ? numerics::chiSquareDeviate(part.squares / part.noise * part.coordinates, part.coordinates)
                           : 0.0;
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Quarters by a figure of each reading.
template <class Figure>
std::vector<Part> quarters(const std::vector<Left>& left, const char* format, double unit, const Figure& figure) {
  std::vector<double> values;
  for (const Left& one : left) values.push_back(figure(one));
  std::sort(values.begin(), values.end());
  std::array<double, 5> limits{};
  for (std::size_t k = 0; k < limits.size(); ++k) limits[k] = numerics::quantile(values, 0.25 * static_cast<double>(k));
  std::vector<Part> parts;
  for (std::size_t k = 0; k < 4; ++k)
    parts.push_back({fmt::format(fmt::runtime(format), limits[k] / unit, limits[k + 1] / unit)});
  for (const Left& one : left) {
    std::size_t k = 0;
    while (k < 3 && figure(one) > limits[k + 1]) ++k;
    parts[k].add(one.residual.squaredNorm(), one.covariance.trace(), 3.0);
  }
  return parts;
}

/// What a turn of each joint alone explains of a posture's residuals. Several can explain the same: their shares are
/// those of what all together explain, in proportion to what each does alone.
diagnosis::WhereTable byJoint(const UnloadedDay& day, const ArmFit& fit, const std::vector<Left>& left,
                              double all_squares) {
  const calibration::FittedDay fitted(day, fit);
  const int joints = day.arm.joints();
  std::vector<Part> named(static_cast<std::size_t>(joints));
  double together = 0.0;
  for (std::size_t from = 0; from < left.size();) {
    std::size_t end = from;
    while (end < left.size() && left[end].posture == left[from].posture) ++end;
    const calibration::Posture& posture = day.postures[left[from].posture];
    const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture));
    const auto rows = 3 * static_cast<Eigen::Index>(end - from);
    Eigen::MatrixXd by_angles(rows, joints);
    Eigen::VectorXd residual(rows), noise = Eigen::VectorXd::Zero(joints);
    for (std::size_t k = from; k < end; ++k) {
      const auto row = 3 * static_cast<Eigen::Index>(k - from);
      const PointJacobian own = placed.byAngles(left[k].at);
      by_angles.middleRows<3>(row) = own;
      residual.segment<3>(row) = left[k].residual;
      noise += (own.transpose() * left[k].covariance * own).diagonal();
    }
    const Eigen::VectorXd product = by_angles.transpose() * residual, square = by_angles.colwise().squaredNorm();
    for (std::size_t j = 0; j < named.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      if (square[at] > 0.0) named[j].add(product[at] * product[at] / square[at], noise[at] / square[at], 1.0);
    }
    // Of more than six joints there is always a turn that nothing shows, which rounding must not fill.
    constexpr double kNotSeen = 1e-9;
    together += residual.dot(Eigen::VectorXd(by_angles * leastSquaresSolution(by_angles, residual, kNotSeen)));
    from = end;
  }
  double alone = 0.0;
  for (std::size_t j = 0; j < named.size(); ++j) {
    named[j].name = fmt::format("joint {}", j + 1);
    alone += named[j].squares;
  }
  diagnosis::WhereTable table = tableOf("joint", named, all_squares);
  table.overlaps = true;
  table.explained = all_squares > 0.0 ? together / all_squares : 0.0;
  for (diagnosis::WhereRow& row : table.rows) row.share *= alone > 0.0 ? together / alone : 0.0;
  return table;
}

}  // namespace

std::vector<diagnosis::WhereTable> whereLeft(const UnloadedDay& day, const ArmFit& fit) {
  const std::vector<Left> left = leftOver(day, fit);
  if (left.empty()) return {};
  double all = 0.0;
  for (const Left& one : left) all += one.residual.squaredNorm();
  std::vector<Part> reflectors, axes{{"x"}, {"y"}, {"z"}}, beam{{"along"}, {"across"}}, times, postures;
  for (const std::string& name : day.targets) reflectors.push_back({name});
  for (int quarter = 1; quarter <= 4; ++quarter) times.push_back({fmt::format("quarter {}", quarter)});
  for (const calibration::Posture& posture : day.postures)
    postures.push_back({day.pose_ids[static_cast<std::size_t>(posture.pose)]});
  for (const Left& one : left) {
    const double square = one.residual.squaredNorm(), variance = one.covariance.trace();
    reflectors[static_cast<std::size_t>(one.target)].add(square, variance, 3.0);
    for (Eigen::Index k = 0; k < 3; ++k)
      axes[static_cast<std::size_t>(k)].add(one.residual[k] * one.residual[k], one.covariance(k, k), 1.0);
    const double along = one.beam.dot(one.residual), along_variance = one.beam.dot(one.covariance * one.beam);
    beam[0].add(along * along, along_variance, 1.0);
    beam[1].add(square - along * along, variance - along_variance, 2.0);
    const double time = day.postures[one.posture].time;
    times[std::min<std::size_t>(3, static_cast<std::size_t>(4.0 * time))].add(square, variance, 3.0);
    postures[one.posture].add(square, variance, 3.0);
  }
  return {
      tableOf("reflector", reflectors, all),
      tableOf("base axes", axes, all),
      tableOf("beam", beam, all),
      byJoint(day, fit, left, all),
      tableOf("time", times, all),
      tableOf("height", quarters(left, "{:.2f} to {:.2f} m", 1.0, [](const Left& one) { return one.at.z(); }), all),
      tableOf("reach",
              quarters(left, "{:.2f} to {:.2f} m", 1.0, [](const Left& one) { return one.at.head<2>().norm(); }), all),
      tableOf("posture", postures, all)};
}

}  // namespace stiffscope::accuracy
