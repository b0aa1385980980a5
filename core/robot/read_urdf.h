#pragma once

#include <filesystem>
#include <string>

#include "core/robot/robot.h"

namespace stiffscope {

/// Reads the chain from `base_link` to `flange_link` of a URDF: exactly six revolute (or continuous) joints,
/// any fixed joints between them. Links and joints off the chain are skipped, but for those rigidly fixed to
/// a chain link: they are named in Robot::links, and their masses count with the body that carries them.
/// Throws InputError with the reason where the chain is not six revolute joints.
Robot readUrdf(const std::filesystem::path& file, const std::string& base_link,
               const std::string& flange_link);

}  // namespace stiffscope
