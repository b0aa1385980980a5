#pragma once

#include <string>
#include <vector>

#include "metrology/remark.h"

namespace stiffscope::reports {

/// A remark in words: a sentence, or a part of one without its full stop, as its maker meant it. Empty where there is
/// nothing to say. The words of each library are in the file that bears its name.
std::string words(const Remark& remark);

std::vector<std::string> words(const std::vector<Remark>& remarks);

}  // namespace stiffscope::reports
