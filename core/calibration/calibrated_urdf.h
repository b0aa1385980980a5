#pragma once

#include <string>
#include <string_view>

#include "core/robot/robot.h"

namespace stiffscope::calibration {

/// A URDF with the origins of the joints between `base_link` and `flange_link` changed so that its axes and its
/// flange stand where those of `calibrated` do; everything else (names, axes in their joints, limits, meshes, masses,
/// comments, what other programs put there) is as in `bytes`. A link's frame keeps its nominal place but for the turn
/// that brings its axis onto the calibrated one and the shift to the nearest point of it; the frame of the last joint
/// is carried with the flange. `nominal`: as those bytes read. Throws InputError where the bytes are no XML,
/// std::runtime_error where the chain is not in them.
std::string calibratedUrdf(std::string_view bytes, const std::string& file, const std::string& base_link,
                           const std::string& flange_link, const robot::Robot& nominal, const robot::Robot& calibrated);

}  // namespace stiffscope::calibration
