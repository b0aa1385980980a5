#pragma once

#include <string>
#include <vector>

#include "core/workspace/workspace_stiffness.h"

namespace stiffscope::reports {

/// What the stiffnesses hold and what not, a sentence each; plain texts.
std::vector<std::string> workspaceNotes(const workspace::WorkspaceStiffness& found);

/// "vertical plane through axis 1 at 3.2 deg, tool turned as in posture 7, places 200 mm apart"; a plain text.
std::string sliceWords(const workspace::StiffnessSlice& slice);

/// Where the workpiece deflects least, how much, and what the place it has now does; a plain text.
std::string placementWords(const workspace::PlacementStudy& study);

/// Why an offset is not judged; empty where it is. A plain text.
std::string notJudgedWords(const workspace::Placement& placement, std::size_t postures);

}  // namespace stiffscope::reports
