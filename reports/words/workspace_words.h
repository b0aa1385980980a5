#pragma once

#include <string>
#include <vector>

#include "core/workspace/workspace_stiffness.h"

namespace stiffscope::reports {

/// The unit in which the stiffnesses of a day are printed: N/µm, or N/mm of an arm whose softest posture has less than
/// a tenth of a N/µm, so that no column begins with zeros.
struct LinearStiffnessUnit {
  double size = 1e6;  ///< N/m
  const char* name = "N/µm";
};
LinearStiffnessUnit stiffnessUnit(const workspace::WorkspaceStiffness& found);

/// Whether a joint of known stiffness moves P_TCP in the slice's plane at one of its places: else there is nothing to
/// draw there.
bool givesInSlice(const workspace::StiffnessSlice& slice);

/// What the stiffnesses hold and what not, a sentence each; plain texts.
std::vector<std::string> workspaceNotes(const workspace::WorkspaceStiffness& found);

/// "vertical plane through axis 1 at 3.2 deg, tool turned as in posture 7, places 200 mm apart"; a plain text.
std::string sliceWords(const workspace::StiffnessSlice& slice);

/// Where the workpiece deflects least, how much, and what the place it has now does; a plain text.
std::string placementWords(const workspace::PlacementStudy& study);

/// Why an offset is not judged; empty where it is. A plain text.
std::string notJudgedWords(const workspace::Placement& placement, std::size_t postures);

}  // namespace stiffscope::reports
