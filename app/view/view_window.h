#pragma once

#include "app/view/view_material.h"

namespace stiffscope::app {

/// Opens the window and shows the campaign until it is closed, or once for a screenshot. Returns the exit
/// status; throws NoDisplay, InputError, and what reading and drawing throw.
int viewCampaign(const ViewOptions& options);

}  // namespace stiffscope::app
