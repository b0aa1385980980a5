#pragma once

#include <string>
#include <vector>

#include "core/comparison/geometry_change.h"

// What moved between two days without a load, in the words of its text and JSON.

namespace stiffscope::reports {

const char* nameOf(comparison::NumberKind kind);                ///< "joint_zero", "along", "distance", ..., "off_x"
std::string nameOf(const comparison::CauseEvidence& evidence);  ///< "joint_zero", "link", "axis", ..., "turn_about_6"

std::string numberName(const comparison::GeometryNumber& number);  ///< "zero of joint 3", "distance of axes 2 and 3"

/// "the zero of joint 3 moved by 0.0115 deg (0.200 mrad) +- 0.009 mrad".
std::string causeWords(const comparison::CauseEvidence& evidence);

/// What changed and what explains it, a sentence each: of the machine, of its best cause, of the reflectors.
std::vector<std::string> changeWords(const comparison::GeometryChange& change);

}  // namespace stiffscope::reports
