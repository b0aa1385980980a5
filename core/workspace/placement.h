#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/workspace/slice.h"

namespace stiffscope::workspace {

/// How far the workpiece is moved from where the postures have it, R0.
struct Offset {
  std::string id;
  Eigen::Vector3d by = Eigen::Vector3d::Zero();  ///< m
};

/// `count` steps of `spacing` either way along x0, y0 and z0, none among them.
std::vector<Offset> offsetGrid(double spacing, int count = 2);

/// From a CSV file: `offset` (any name, not repeated), `dx_mm dy_mm dz_mm` in R0; columns in any order. Throws
/// InputError as the campaign's tables do; unknown columns go to `warnings`.
std::vector<Offset> readOffsets(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The workpiece at one offset: all of its postures moved along, the tool turned as in each.
struct Placement {
  Offset offset;
  std::size_t reached = 0;  ///< postures that the arm reaches there (continuedAngles)
  std::string worst;        ///< the posture that deflects most, by name
  /// Of that posture, predicted by the model as `compensate` does; deflections of P_TCP, m.
  compensation::CompensatedPosture prediction;
  Remark reason;  ///< why it is not judged: the first refusal of a posture; empty where it is, or out of reach

  bool judged() const { return reason.empty() && prediction.predicted; }
  double deflection() const { return prediction.tcp.deflection.norm(); }  ///< m
};

/// Where a workpiece stands best for one force.
struct PlacementStudy {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on P_TCP, kept in R0, N
  std::vector<NamedPosture> postures;               ///< of the workpiece where it stands now
  std::vector<Placement> placements;                ///< in the order of the offsets
  std::optional<std::size_t> best;  ///< of those judged, the one that deflects least; the first of equals
  std::optional<std::size_t> now;   ///< the one without an offset
};

/// Predicts at each offset the deflection of P_TCP under `force` in every posture of the workpiece; the largest is the
/// offset's. The prediction is that of compensation::compensate with its uncertainty, effects of the machine in it, and
/// refused where that refuses: beyond what the day's loads and postures say, near singularities, outside limits, and
/// where the force turns a joint of unknown stiffness.
PlacementStudy studyPlacements(const DeflectingArm& arm, const Eigen::Vector3d& force,
                               const std::vector<NamedPosture>& postures, const std::vector<Offset>& offsets);

}  // namespace stiffscope::workspace
