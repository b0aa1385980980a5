#pragma once

#include <vector>

#include "core/accuracy/accuracy_diagnosis.h"

namespace stiffscope::accuracy {

/// What to measure next: what separates the members of each class of the verdict, what makes something testable, and
/// what would find an unknown cause.
std::vector<Remark> nextMeasurements(const AccuracyDiagnosis& diagnosis);

}  // namespace stiffscope::accuracy
