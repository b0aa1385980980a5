#pragma once

#include <pybind11/pybind11.h>

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

}  // namespace stiffscope::python
