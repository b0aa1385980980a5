#pragma once

#include <vector>

#include "core/accuracy/accuracy_diagnosis.h"
#include "core/calibration/fitted_arm.h"
#include "core/diagnosis/diagnosis.h"

namespace stiffscope::accuracy {

/// Where a calibrated arm leaves the readings: the rms per coordinate (m), that of the tracker's noise, the share of
/// the squares and how far beyond noise (a normal deviate), by reflector, axis of base_link, along and across the beam,
/// joint (what a turn of that joint would explain, posture by posture; shares overlap), quarter of the day, height and
/// reach in the workspace (quarters of the readings), and posture. Readings of weight 0 take no part.
std::vector<diagnosis::WhereTable> whereLeft(const calibration::UnloadedDay& day, const calibration::ArmFit& fit);

/// What to measure next: what separates the members of each class of the verdict, what makes something testable, and
/// what would find an unknown cause.
std::vector<Remark> nextMeasurements(const AccuracyDiagnosis& diagnosis);

}  // namespace stiffscope::accuracy
