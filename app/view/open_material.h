#pragma once

#include <vector>

#include "app/view/view_material.h"
#include "app/view/view_options.h"
#include "core/campaign/campaign.h"

namespace stiffscope {

/// What there is to see, and where to start.
struct OpenedMaterial {
  std::vector<ViewMaterial> by_method;  ///< the method asked for first, then the others that are available
  std::size_t first = 0;
};

/// The loads of a campaign; where it has none that can be shown, its circle sweeps. Throws InputError for a
/// method, posture or load step that is not there, or, with the reason, where there is nothing to show.
OpenedMaterial openMaterial(const Campaign& campaign, const ViewOptions& options);

}  // namespace stiffscope
