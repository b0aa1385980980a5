#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/robot/robot.h"

namespace stiffscope::robot {

/// Reads the chain from `base_link` to `flange_link` of a URDF: four to eight revolute (or continuous) joints,
/// any fixed joints between them. A joint with `mimic` is an axis that follows a joint of the chain (Couplings). Links
/// and joints off the chain are skipped, but for those rigidly fixed to a chain link: they are named in Robot::links,
/// and their masses count with the body that carries them. Lengths in the file are m, angles rad, masses kg. A mass of
/// 0, or no `inertial`, means not known. Throws InputError with the reason where the file cannot be read, where the
/// chain is not of so many revolute joints (another kind of joint on it, one that follows a joint which is not, a loop,
/// a link that is missing or has two parents), or where a number on the chain is none (xacro that was not expanded).
Robot readUrdf(const std::filesystem::path& file, const std::string& base_link, const std::string& flange_link);

/// The same from the bytes of a URDF; `file` is its name for messages.
Robot parseUrdf(std::string_view bytes, const std::string& file, const std::string& base_link,
                const std::string& flange_link);

}  // namespace stiffscope::robot
