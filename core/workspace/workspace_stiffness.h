#pragma once

#include <optional>
#include <vector>

#include "core/effects/effect.h"
#include "core/extended_model/extended_model.h"
#include "core/workspace/placement.h"
#include "core/workspace/point_stiffness.h"
#include "core/workspace/slice.h"

namespace stiffscope::workspace {

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
  std::vector<int> unknown;              ///< joints (0..5) of unknown stiffness
  std::vector<PointStiffness> postures;  ///< those that identified, in their order
  StiffnessSlice slice;
  std::optional<PlacementStudy> placement;
};

/// Of an identified day with at least one load case. `model`: null for joint springs alone.
WorkspaceStiffness workspaceStiffness(const DeflectingArm& arm, const identification::Identification& result,
                                      const extended_model::ExtendedModel* model, identification::Method method,
                                      const WorkspaceOptions& options = {});

}  // namespace stiffscope::workspace
