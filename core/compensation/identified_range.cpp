#include "core/compensation/compensate.h"

#include <algorithm>
#include <cmath>

#include "core/extended_model/method_equations.h"
#include "core/identification/equations.h"
#include "metrology/lines.h"

namespace stiffscope::compensation {

namespace {

using identification::Identification;
using identification::LoadCase;
using identification::Method;

/// The method's equations by posture, nothing but joint springs to be moved in them.
extended_model::MethodEquations springEquations(const Identification& result, Method method) {
  std::vector<extended_model::CaseEffects> none(result.cases.size());
  for (std::size_t i = 0; i < none.size(); ++i)
    none[i].by_steps.resize(static_cast<Eigen::Index>(3 * result.cases[i].targets.size()), 0);
  return extended_model::methodEquations(result, method, none);
}

double modelError(const Identification& result, Method method, const std::vector<double>& load_of_posture) {
  const extended_model::MethodEquations equations = springEquations(result, method);
  const std::size_t postures = equations.reflectors.size();
  if (postures < 2 || load_of_posture.size() != postures) return 0.0;
  constexpr std::size_t kMostFolds = 50;
  const std::size_t folds = std::min(postures, kMostFolds);
  const Eigen::VectorXd no_steps(0);
  double squares = 0.0, rows = 0.0, loads = 0.0;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<double> weights(postures, 1.0);
    for (std::size_t p = fold; p < postures; p += folds) weights[p] = 0.0;
    const JointVector compliance =
        extended_model::solvedCompliance(equations, method, result.of(method).estimate.identifiable, weights, no_steps);
    for (std::size_t p = fold; p < postures; p += folds) {
      const identification::CaseEquations& own = equations.reflectors[p].springs;
      squares += (own.right - own.matrix * compliance).squaredNorm();
      rows += static_cast<double>(own.right.size());
      loads += static_cast<double>(own.right.size()) * load_of_posture[p] * load_of_posture[p];
    }
  }
  const double noise = result.noise ? result.noise->per_coordinate : 0.0;
  return loads > 0.0 ? std::sqrt(std::max(0.0, squares - rows * noise * noise) / loads) : 0.0;
}

double toolSize(const frames::LoadingGeometry& geometry) {
  std::vector<Eigen::Vector3d> places;
  for (const auto& place : geometry.targets_at_zero) {
    if (place) places.push_back(*place);
  }
  if (places.size() < 2) return 0.0;
  const auto count = static_cast<double>(places.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : places) middle += place / count;
  double squares = 0.0;
  for (const Eigen::Vector3d& place : places) squares += (place - middle).squaredNorm() / count;
  return std::sqrt(squares);
}

}  // namespace

Eigen::Vector3d wristOf(const robot::ArmAxes& axes) {
  const metrology::Line &last = axes.back(), &before = axes[axes.size() - 2];
  constexpr double kParallel = 0.0175;  // rad, a degree
  if (metrology::angleBetween(before, last) < kParallel)
    return 0.5 * (last.point + metrology::nearestPoint(before, last.point));
  const metrology::CommonPerpendicular between = metrology::commonPerpendicular(before, last);
  return 0.5 * (between.foot_on_first + between.foot_on_second);
}

double loadRatio(const IdentifiedRange& range, const robot::Wrench& wrench, const robot::ArmAxes& axes) {
  const double moment = wrench.about(wristOf(axes)).moment.norm();
  return std::max(range.force > 0.0 ? wrench.force.norm() / range.force : 0.0,
                  range.moment > 0.0 ? moment / range.moment : 0.0);
}

IdentifiedRange identifiedRange(const Identification& result, Method method) {
  IdentifiedRange range(result.geometry.arm.joints());
  if (result.cases.empty()) return range;
  range.low = range.high = result.cases.front().q;
  for (const LoadCase& one : result.cases) {
    // By its lever, so that forces of a day that happen to pass the wrist are no smaller moments than they could be.
    const Eigen::Vector3d lever = one.wrench.point - wristOf(one.axes);
    range.force = std::max(range.force, one.wrench.force.norm());
    range.moment = std::max(
        {range.moment, one.wrench.about(wristOf(one.axes)).moment.norm(), lever.norm() * one.wrench.force.norm()});
    range.low = range.low.cwiseMin(one.q);
    range.high = range.high.cwiseMax(one.q);
  }
  for (const JointVector& torque : identification::jointTorques(result.cases))
    range.torque = range.torque.cwiseMax(torque.cwiseAbs());
  std::vector<double> load_of_posture;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const LoadCase& one = result.cases[i];
    const double load = loadRatio(range, one.wrench, one.axes);
    if (i > 0 && one.pose == result.cases[i - 1].pose) {
      load_of_posture.back() = std::max(load_of_posture.back(), load);
    } else {
      load_of_posture.push_back(load);
    }
  }
  range.model_error = modelError(result, method, load_of_posture);
  range.tool_size = toolSize(result.of(method).geometry);
  return range;
}

}  // namespace stiffscope::compensation
