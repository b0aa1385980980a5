#pragma once

#include <pybind11/pybind11.h>

#include "core/campaign/campaign.h"

namespace stiffscope::python {

/// The tables of a campaign: a dict by their element in campaign.xml, each a dict of columns as the campaign format
/// names them and in its units; numbers as float64, steps and axes as int64, names as lists. Optional columns that no
/// row fills are left out. Of a campaign as it was read; joint angles are the controller's figures where it states how
/// these become angles.
pybind11::dict tablesOf(campaign::Campaign campaign);

}  // namespace stiffscope::python
