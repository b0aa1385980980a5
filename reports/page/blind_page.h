#pragma once

#include <string>

#include "core/blind/run_blind.h"

namespace stiffscope {

/// The blind test as one self-contained page: what was done, the seal, the rates, accuracy against size, the
/// confusion matrix, effects one by one, the promised shrink against the true one.
std::string blindPage(const blind::BlindOptions& options, const blind::BlindResult& result);

}  // namespace stiffscope
