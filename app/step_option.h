#pragma once

#include <optional>
#include <string>

namespace stiffscope {

/// The load step that `--step` names; empty where it was not given. Throws InputError, naming the option, for
/// anything but a whole number; `also` is what the command takes besides, as its words say it (", or all").
std::optional<int> loadStepNamed(const std::string& step, const std::string& also = {});

}  // namespace stiffscope
