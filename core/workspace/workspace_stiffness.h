#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/effects/effect.h"
#include "core/extended_model/extended_model.h"
#include "core/workspace/point_stiffness.h"
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
  std::size_t reached =
      0;              ///< postures that the arm reaches there (continuedAngles), the tool turned by 1e-3 rad at most
  std::string worst;  ///< the posture that deflects most, by name
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

struct WorkspaceOptions {
  SliceOptions slice;
  std::optional<Eigen::Vector3d> force;  ///< on P_TCP, R0, N: where does a workpiece deflect least; empty: not asked
  std::vector<Offset> offsets;           ///< of the workpiece; empty: offsetGrid of the slice's spacing
  std::vector<NamedPosture> workpiece;   ///< empty: the slice's posture alone
};

/// Stiffness at P_TCP over the workspace, by one method.
struct WorkspaceStiffness {
  identification::Method method{};
  /// Effects of the machine in the model: what PointStiffness::model holds besides the springs of the joints.
  std::vector<effects::Effect> held;
  std::vector<int> unknown;              ///< joints (from 0) of unknown stiffness
  std::vector<PointStiffness> postures;  ///< those that identified, in their order
  StiffnessSlice slice;
  std::optional<PlacementStudy> placement;
};

/// Of an identified day with at least one load case. `model`: null for joint springs alone.
WorkspaceStiffness workspaceStiffness(const DeflectingArm& arm, const identification::Identification& result,
                                      const extended_model::ExtendedModel* model, identification::Method method,
                                      const WorkspaceOptions& options = {});

}  // namespace stiffscope::workspace
