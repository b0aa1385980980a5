#include "core/diagnosis/geometry_columns.h"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "core/frames/arm_parameters.h"
#include "core/numerics/parallel.h"

namespace stiffscope::diagnosis {

namespace {

Eigen::VectorXd stacked(const std::vector<Eigen::Vector3d>& points) {
  return Eigen::Map<const Eigen::VectorXd>(points.front().data(), 3 * static_cast<Eigen::Index>(points.size()));
}

Eigen::VectorXd deflectionOf(const SystemRows& rows, const SystemState& state) {
  return rows.by_compliance * state.at.compliance;
}

/// Differences of the rows themselves.
std::vector<Eigen::MatrixXd> columnsOfLoading(const SystemState& state, bool absolute, const LoadingRows& maker,
                                              const std::vector<SystemRows>& rows) {
  constexpr double kStep = frames::ArmParameters::kSmall;
  const Eigen::Index steps =
      frames::ArmParameters(state.geometry.arm.axes()).count(state.geometry.targets_at_zero.size());
  std::vector<Eigen::MatrixXd> columns;
  for (const SystemRows& one : rows)
    columns.emplace_back((absolute ? one.position.size() : 0) + one.displacement.size(), steps);
  numerics::onAllCores(static_cast<std::size_t>(steps), [&](std::size_t step) {
    const auto k = static_cast<Eigen::Index>(step);
    const frames::LoadingGeometry there =
        frames::moved(state.geometry, kStep * Eigen::VectorXd::Unit(steps, k), state.at.epoch_centre);
    const auto other = maker.rows(there, state.at, state.corrections);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto column = columns[i].col(k);
      if (absolute) column.head(rows[i].position.size()) = (rows[i].position - other[i].position) / kStep;
      column.tail(rows[i].displacement.size()) = ((rows[i].displacement - deflectionOf(rows[i], state)) -
                                                  (other[i].displacement - deflectionOf(other[i], state))) /
                                                 kStep;
    }
  });
  return columns;
}

std::vector<Eigen::MatrixXd> columnsOfSweeps(const SystemState& state, const std::vector<SweepRows>& rows) {
  const PositionByGeometry by_geometry(state.geometry, state.at, state.at.epoch_centre);
  std::vector<Eigen::MatrixXd> columns(rows.size());
  numerics::onAllCores(rows.size(), [&](std::size_t i) { columns[i] = by_geometry.of(rows[i].state); });
  return columns;
}

}  // namespace

bool GeometryColumns::Place::is(const Place& other) const {
  const auto same = [](const std::vector<Eigen::VectorXd>& a, const std::vector<Eigen::VectorXd>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& one, const auto& two) { return one.size() == two.size() && one == two; });
  };
  return same(points, other.points) && same(deflection, other.deflection);
}

const GeometryColumns::Columns& GeometryColumns::of(const SystemState& state, bool absolute, const LoadingRows& maker,
                                                    const std::vector<SystemRows>& loading,
                                                    const std::vector<SweepRows>& sweeps) {
  Place here;
  const auto add = [&](const effects::ArmState& rest, const Eigen::VectorXd& position) {
    here.points.push_back(stacked(rest.points));
    if (position.size() > 0) here.points.push_back(here.points.back() - position);
  };
  for (const SystemRows& one : loading) {
    add(one.states.front(), one.position);
    here.deflection.push_back(deflectionOf(one, state));
  }
  for (const SweepRows& one : sweeps) add(one.state, one.position);
  const auto found = std::find_if(places_.begin(), places_.end(), [&](const Place& one) { return one.is(here); });
  if (found != places_.end()) return found->columns;
  here.columns = {columnsOfLoading(state, absolute, maker, loading), columnsOfSweeps(state, sweeps)};
  constexpr std::size_t kPlaces = 2;  // where a fit began, and where it is
  if (places_.size() == kPlaces) places_.pop_back();
  return places_.emplace_back(std::move(here)).columns;
}

}  // namespace stiffscope::diagnosis
