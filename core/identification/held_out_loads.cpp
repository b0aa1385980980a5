#include "core/identification/held_out_loads.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/identification/identifiability.h"
#include "core/identification/load_case.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/method_solution.h"
#include "core/identification/outliers.h"
#include "core/identification/subsets.h"
#include "core/preparation/subsample.h"
#include "core/robot/kinematics.h"

namespace stiffscope::identification {

LoadDirection directionOf(const Eigen::Vector3d& force, const Eigen::Vector3d& point, const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d down = gravity.norm() > 0.0 ? gravity.normalized() : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
  const double along = force.dot(down);
  const Eigen::Vector2d rest = (force - along * down).head<2>(), from_axis = point.head<2>();
  if (std::abs(along) >= rest.norm()) return along > 0.0 ? LoadDirection::down : LoadDirection::up;
  if (!(from_axis.norm() > 0.0)) return LoadDirection::sideways;
  const double radial = rest.dot(from_axis.normalized());
  if (2.0 * radial * radial < rest.squaredNorm()) return LoadDirection::sideways;
  return radial > 0.0 ? LoadDirection::outward : LoadDirection::inward;
}

namespace {

using Key = std::pair<int, int>;  // pose and step

/// Sums over its points of what is displaced, by case, m.
struct Displaced {
  std::map<Key, double> wrist, targets;
};

LoadedArm casesOf(const LoadedArm& arm, const auto& wanted) {
  LoadedArm part;
  part.geometry = arm.geometry;
  part.cases.reserve(static_cast<std::size_t>(std::count_if(arm.cases.begin(), arm.cases.end(), wanted)));
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    if (!wanted(arm.cases[i])) continue;
    part.cases.push_back(arm.cases[i]);
    if (!arm.wrist.empty()) part.wrist.push_back(arm.wrist[i]);
    part.torques.push_back(arm.torques[i]);
  }
  return part;
}

double sumOver(const std::vector<LoadCase>& cases, const std::map<Key, double>& by_case) {
  double sum = 0.0;
  for (const LoadCase& one : cases) {
    const auto found = by_case.find({one.pose, one.step});
    if (found != by_case.end()) sum += found->second;
  }
  return sum;
}

class MethodLoads {
 public:
  MethodLoads(const campaign::Campaign& campaign, const campaign::Campaign& as_read, const IdentifyOptions& options,
              const Identification& result, Method method)
      : campaign_(campaign), options_(options), result_(result), own_(result.of(method)), method_(method) {
    const std::vector<int> steps = loadedSteps(campaign);
    arm_ = loadedArm(campaign, LoadReadings(campaign, steps), own_.geometry, result.frames.wrist, steps);
    if (&campaign == &as_read) {
      displaced_ = displacedIn(arm_);
    } else {
      displaced_ =
          displacedIn(loadedArm(as_read, LoadReadings(as_read, steps), own_.geometry, result.frames.wrist, steps));
    }
  }

  std::vector<HeldOutLoad> levels() const {
    std::vector<HeldOutLoad> all;
    for (const int step : loadedSteps(campaign_)) {
      const auto level = [&](const LoadCase& one) { return one.step == step; };
      const auto others = [&](const LoadCase& one) { return one.step != step && identifies(one); };
      if (auto one = predicted(casesOf(arm_, level), casesOf(arm_, others))) {
        one->step = step;
        all.push_back(*one);
      }
    }
    return all;
  }

  std::vector<HeldOutLoad> directions() const {
    std::vector<HeldOutLoad> all;
    for (std::size_t d = 0; d < kLoadDirections; ++d) {
      const auto direction = static_cast<LoadDirection>(d);
      const auto own = [&](const LoadCase& one) { return identifies(one) && directionIn(one) == direction; };
      const auto others = [&](const LoadCase& one) { return identifies(one) && directionIn(one) != direction; };
      if (auto one = predicted(casesOf(arm_, own), casesOf(arm_, others))) {
        one->direction = direction;
        all.push_back(*one);
      }
    }
    return all;
  }

  std::array<int, kLoadDirections> states() const {
    std::array<int, kLoadDirections> count{};
    for (const LoadCase& one : arm_.cases)
      if (identifies(one)) ++count[static_cast<std::size_t>(directionIn(one))];
    return count;
  }

 private:
  bool identifies(const LoadCase& one) const {
    return std::find(result_.steps.begin(), result_.steps.end(), one.step) != result_.steps.end();
  }

  LoadDirection directionIn(const LoadCase& one) const {
    return directionOf(one.wrench.force, one.wrench.point, own_.geometry.weight.gravity_in_base);
  }

  static Displaced displacedIn(const LoadedArm& arm) {
    Displaced sums;
    const auto fill = [&](const std::vector<CaseEquations>& rows, std::map<Key, double>& out) {
      if (rows.empty()) return;
      const DeflectionJudge judge(rows);
      for (std::size_t i = 0; i < arm.cases.size(); ++i)
        out[{arm.cases[i].pose, arm.cases[i].step}] = judge.displacement()[i];
    };
    fill(reflectorEquations(arm), sums.targets);
    if (!arm.wrist.empty()) fill(wristPointEquations(arm), sums.wrist);
    return sums;
  }

  /// Empty where either part is too small to say anything.
  std::optional<HeldOutLoad> predicted(LoadedArm part, LoadedArm others) const {
    constexpr std::size_t kFewest = 3;
    if (part.cases.size() < kFewest || others.cases.size() < kFewest) return std::nullopt;
    if (method_ == Method::complete_pose && !others.hasFlangePoses()) return std::nullopt;
    if (method_ == Method::decoupled_partial_pose && others.wrist.empty()) return std::nullopt;
    HeldOutLoad one;
    one.states = static_cast<int>(part.cases.size());
    for (const LoadCase& load_case : part.cases)
      one.mean_force += load_case.wrench.force.norm() / static_cast<double>(part.cases.size());
    const campaign::LoadCell& cell = *campaign_.load_cell;
    const robot::JointMask turned = evaluateTorques(part.geometry, part.cases, cell, options_.trust).mask();
    const robot::JointMask seen =
        evaluateIdentifiability(others.geometry, others.cases, cell, reflectorEquations(others), options_.trust).mask();
    if (std::none_of(seen.begin(), seen.end(), [](bool joint) { return joint; })) return std::nullopt;
    for (std::size_t j = 0; j < turned.size(); ++j) one.not_by_the_others.push_back(turned[j] && !seen[j]);
    const MethodSolution how{method_, result_.frames.tcp_in_flange, result_.characteristic_length.length, seen,
                             nullptr};
    const JointVector compliance = how.solvedCompliance(others, options_.finite_deflection);
    solveLoadedArm(part, options_.finite_deflection, [&](const LoadedArm&) { return compliance; });
    const auto share = [&](const std::vector<CaseEquations>& rows,
                           const std::map<Key, double>& displaced) -> std::optional<double> {
      const double whole = sumOver(part.cases, displaced);
      if (rows.empty() || !(whole > 0.0)) return std::nullopt;
      double left = 0.0;
      for (const double own : DeflectionJudge(rows).residual(compliance)) left += own;
      return 1.0 - left / whole;
    };
    one.at_targets = share(reflectorEquations(part), displaced_.targets);
    if (!part.wrist.empty()) one.at_wrist = share(wristPointEquations(part), displaced_.wrist);
    return one;
  }

  const campaign::Campaign& campaign_;
  const IdentifyOptions& options_;
  const Identification& result_;
  const MethodResult& own_;
  Method method_;
  LoadedArm arm_;  // all load steps, in the method's geometry
  Displaced displaced_;
};

/// Of a long day, as many of each load step as a mean takes, and enough, by where the model's flange stands, of each
/// direction.
std::vector<std::size_t> posturesPredicted(const campaign::Campaign& campaign, const Identification& result) {
  std::set<std::size_t> postures;
  for (const int step : loadedSteps(campaign)) {
    for (const std::size_t one : preparation::spreadPostures(campaign, preparation::kMostAveraged, {step}))
      postures.insert(one);
  }
  const frames::LoadingGeometry& geometry = result.of(bestMethod(result)).geometry;
  std::array<std::vector<std::size_t>, kLoadDirections> by_direction;
  for (const campaign::State& state : campaign.states->rows) {
    if (std::find(result.steps.begin(), result.steps.end(), state.step) == result.steps.end()) continue;
    const robot::Wrench wrench = cellWrench(*campaign.load_cell, geometry, robot::postureAt(geometry.arm, state.q),
                                            std::nullopt, std::nullopt, state.wrench_in_cell);
    const LoadDirection direction = directionOf(wrench.force, wrench.point, geometry.weight.gravity_in_base);
    by_direction[static_cast<std::size_t>(direction)].push_back(static_cast<std::size_t>(state.pose));
  }
  for (const std::vector<std::size_t>& own : by_direction) {
    constexpr std::size_t kEnough = preparation::kMostAveraged / kLoadDirections;
    const auto has = std::count_if(own.begin(), own.end(), [&](std::size_t one) { return postures.contains(one); });
    if (static_cast<std::size_t>(has) >= kEnough) continue;
    for (const std::size_t k : preparation::evenlySpreadIndices(own.size(), kEnough)) postures.insert(own[k]);
  }
  return {postures.begin(), postures.end()};
}

}  // namespace

HeldOutLoads heldOutLoads(const campaign::Campaign& campaign, const campaign::Campaign& as_read,
                          const IdentifyOptions& options, const Identification& result) {
  HeldOutLoads all;
  if (!result.of(bestMethod(result)).available) return all;
  std::optional<campaign::Campaign> rest, some, some_as_read;
  if (result.robust) rest = withoutPostures(campaign, result.outlying);
  const campaign::Campaign* used = rest ? &*rest : &campaign;
  const campaign::Campaign* read = &campaign == &as_read ? used : &as_read;
  if (used->pose_ids.size() > preparation::kMostAveraged) {
    const std::vector<std::size_t> postures = posturesPredicted(*used, result);
    if (read != used) read = &some_as_read.emplace(preparation::ofPostures(*read, postures));
    some = preparation::ofPostures(*used, postures);
    if (read == used) read = &*some;
    used = &*some;
  }
  for (const Method method : kMethods) {
    if (!result.of(method).available) continue;
    const MethodLoads loads(*used, *read, options, result, method);
    all.levels[static_cast<std::size_t>(method)] = loads.levels();
    all.directions[static_cast<std::size_t>(method)] = loads.directions();
    all.states = loads.states();
  }
  return all;
}

}  // namespace stiffscope::identification
