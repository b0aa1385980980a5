#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/mistakes/cell_zero.h"
#include "core/mistakes/load_search.h"
#include "core/mistakes/remarks.h"

namespace stiffscope::mistakes {

std::optional<Suspected> weightNotTared(const campaign::Campaign& campaign, const ReadingsOfDay& day) {
  const double sigma = campaign.load_cell->force_sigma;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rows;  // gravity in the cell's axes, force
  double squares = 0.0;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step != 0) continue;
    rows.emplace_back(gravityInCell(campaign, day.robot, day.weight.gravity_in_base, row.q),
                      row.wrench_in_cell.head<3>());
    squares += rows.back().second.squaredNorm();
  }
  constexpr std::size_t kEnough = 6;
  if (rows.size() < kEnough) return std::nullopt;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const auto& [gravity, force] : rows) {
    Eigen::Matrix<double, 3, 4> design;
    design << gravity, Eigen::Matrix3d::Identity();
    normal += design.transpose() * design;
    right += design.transpose() * force;
  }
  normal.diagonal().array() += 1e-9;
  const Eigen::Vector4d found = normal.ldlt().solve(right);
  double left = 0.0;
  for (const auto& [gravity, force] : rows) left += (force - gravity * found[0] - found.tail<3>()).squaredNorm();
  const double count = static_cast<double>(rows.size()), mean = std::sqrt(squares / count),
               rest = std::sqrt(left / count), weight = std::abs(found[0]) * day.weight.gravity_in_base.norm();
  constexpr double kShare = 0.1, kSigmas = 10.0;
  const bool is_weight = weight > 5.0 * rest && rest < kShare * mean && weight > kSigmas * sigma && weight > 0.5 * mean;
  if (!is_weight) return std::nullopt;
  return Suspected{
      "not_tared",
      Remark(RemarkId::in_columns, std::string("fx_n to mz_nm"), std::vector<std::string>{campaign.states->file}),
      Remark(RemarkId::weight_not_tared, found[0], mean, rest),
      Remark(),
      mean,
      rest};
}

CellScatter unloadedScatter(const campaign::Campaign& campaign) {
  const campaign::LoadCell& cell = *campaign.load_cell;
  if (cell.force_sigma <= 0.0 || cell.moment_sigma <= 0.0) return {};
  Vector6d sum = Vector6d::Zero(), squares = Vector6d::Zero();
  double count = 0.0;
  for (const campaign::State& row : campaign.states->rows) {
    if (row.step != 0) continue;
    sum += row.wrench_in_cell;
    squares += row.wrench_in_cell.cwiseAbs2();
    count += 1.0;
  }
  constexpr double kEnough = 6.0;
  if (count < kEnough) return {};
  const Vector6d variance = (squares - sum.cwiseAbs2() / count) / (count - 1.0);
  return {std::sqrt(std::max(0.0, variance.head<3>().mean())) / cell.force_sigma,
          std::sqrt(std::max(0.0, variance.tail<3>().mean())) / cell.moment_sigma};
}

double sagBy(const ReadingsOfDay& day, const SpringFit& springs) {
  if (!day.weight.links_known || day.unloaded.empty()) return 0.0;
  NominalFitOptions options;
  options.springs = springs.compliance;
  return std::max(0.0, fitNominal(day, options).sag_factor);
}

std::optional<Suspected> gravityReversed(const ReadingsOfDay& day, const SpringFit& springs) {
  if (!day.weight.links_known || day.unloaded.empty()) return std::nullopt;
  constexpr double kLeast = 0.5, kMost = 2.0, kMends = 0.7;
  NominalFitOptions options;
  options.springs = springs.compliance;
  const NominalFit sagging = fitNominal(day, options);
  if (!sagging.done || sagging.sag_factor > -kLeast || sagging.sag_factor < -kMost) return std::nullopt;
  NominalFitOptions none;
  none.sag = false;
  const double without = fitNominal(day, none).rms;
  if (sagging.rms > kMends * without) return std::nullopt;
  return Suspected{"gravity_sign",
                   Remark(RemarkId::in_robot, std::string("gravity_m_s2")),
                   Remark(RemarkId::gravity_reversed, sagging.sag_factor),
                   Remark(RemarkId::misses_arm, without, sagging.rms),
                   without,
                   sagging.rms};
}

std::vector<Suspected> unitsByScatter(const campaign::Campaign& campaign, const ReadingsOfDay& day,
                                      const LoadsOfDay& loads, const SpringFit& as_read,
                                      const std::vector<LoadMistake>& table) {
  const CellScatter scatter = unloadedScatter(campaign);
  if (scatter.force <= 0.0 || scatter.moment <= 0.0) return {};
  constexpr double kOff = 1.0, kRight = 0.4, kSagRight = 0.5, kSagOff = 0.7;  // logarithms of factors
  std::vector<Suspected> cures;
  const auto off = [](double factor) { return std::abs(std::log(factor)); };
  if (std::max(off(scatter.force), off(scatter.moment)) < kOff) return {};
  const double sag = sagBy(day, as_read);
  for (const LoadMistake& mistake : table) {
    if (mistake.id != "wrench_unit") continue;
    const double forces = mistake.meant.on_force(0, 0), moments = mistake.meant.on_moment(0, 0);
    if (off(scatter.force * forces) > kRight || off(scatter.moment * moments) > kRight) continue;
    const SpringFit fit = loads.fit(mistake.meant);
    const double after = sagBy(day, fit);
    const bool by_sag = sag > 0.0 && off(sag) > kSagOff && after > 0.0 && off(after) < kSagRight;
    constexpr double kBetter = 0.93;
    const bool by_springs = fit.left < kBetter * as_read.left;
    if (!by_sag && !by_springs) continue;
    cures.push_back({mistake.id, mistake.where, mistake.remedy,
                     by_sag ? Remark(RemarkId::sag_against_load, 1.0 / sag, 1.0 / after)
                            : Remark(RemarkId::loads_left, as_read.left, fit.left),
                     by_sag ? 1.0 / sag : as_read.left, by_sag ? 1.0 / after : fit.left});
  }
  return cures;
}

}  // namespace stiffscope::mistakes
