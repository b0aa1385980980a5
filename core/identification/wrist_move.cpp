#include "core/identification/wrist_move.h"

#include <cmath>

#include "metrology/trilateration.h"

namespace stiffscope {

namespace {

using Three = std::array<const TargetMove*, 3>;

std::optional<Three> largestTriangle(const LoadCase& load_case, const std::vector<double>& radii) {
  std::vector<const TargetMove*> known;
  for (const TargetMove& move : load_case.targets) {
    if (!std::isnan(radii[static_cast<std::size_t>(move.target)])) known.push_back(&move);
  }
  std::optional<Three> best;
  double most = 0.0;
  for (std::size_t a = 0; a < known.size(); ++a) {
    for (std::size_t b = a + 1; b < known.size(); ++b) {
      for (std::size_t c = b + 1; c < known.size(); ++c) {
        const double area =
            (known[b]->unloaded - known[a]->unloaded).cross(known[c]->unloaded - known[a]->unloaded).norm();
        if (area > most) most = area, best = Three{known[a], known[b], known[c]};
      }
    }
  }
  return best;
}

}  // namespace

Eigen::Vector3d modelledWrist(const Robot& arm, const LoadCase& load_case,
                              const Eigen::Vector3d& centre_at_zero) {
  return unloadedPosture(arm, load_case).motion[3] * centre_at_zero;
}

std::optional<WristMove> wristMove(const LoadCase& load_case, const std::vector<double>& radii,
                                   const Eigen::Vector3d& modelled) {
  if (!load_case.absolute) return std::nullopt;
  const auto three = largestTriangle(load_case, radii);
  if (!three) return std::nullopt;
  const auto& [a, b, c] = *three;
  const std::array<double, 3> known{radii[static_cast<std::size_t>(a->target)],
                                    radii[static_cast<std::size_t>(b->target)],
                                    radii[static_cast<std::size_t>(c->target)]};
  const auto unloaded = trilaterate({a->unloaded, b->unloaded, c->unloaded}, known);
  const auto loaded = trilaterate({a->loaded, b->loaded, c->loaded}, known);
  if (!unloaded || !loaded) return std::nullopt;
  return WristMove{nearerRoot(*unloaded, modelled), nearerRoot(*loaded, modelled)};
}

CaseEquations wristEquations(const LoadCase& load_case, const WristMove& wrist, const Vector6d& torque) {
  const Eigen::Vector3d point = jacobianPoint(load_case, wrist.unloaded, wrist.loaded);
  return {pointRows(jacobianAxes(load_case), point, torque), wrist.displacement(), load_case.pose};
}

}  // namespace stiffscope
