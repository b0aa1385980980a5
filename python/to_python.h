#pragma once

#include <pybind11/pybind11.h>

#include "core/campaign/campaign.h"
#include "reports/json/json_document.h"

namespace stiffscope::python {

/// A result as Python has it, under the names of the JSON. Objects become Record (a dict), lists of objects Rows (a
/// list). A list of numbers, nested as deep as it is, becomes a numpy array of float64, or of int64 where all are whole
/// numbers; of truth values one of bool. null in it is NaN, and stands for as many as its neighbours have: an interval
/// that was not determined is a row of NaN. Elsewhere null is None. Lists of unequal lengths stay lists.
///
/// Rows that are not made yet are made on all cores. Call it without the GIL; it is taken where Python's objects are
/// made, and the result must be touched with it.
pybind11::object toPython(const reports::JsonDocument& document);

/// The tables of a campaign: a dict by their element in campaign.xml, each a dict of columns as the campaign format
/// names them and in its units; numbers as float64, steps and axes as int64, names as lists. Optional columns that no
/// row fills are left out. Of a campaign as it was read; joint angles are the controller's figures where it states how
/// these become angles.
pybind11::dict tablesOf(campaign::Campaign campaign);

}  // namespace stiffscope::python
