#pragma once

#include <string>

#include "core/validation/run_blind.h"

namespace stiffscope::page {

/// The blind test as one self-contained page: what was done, the seal, the rates, accuracy against size, the
/// confusion matrix, effects one by one, the promised shrink against the true one.
std::string blindPage(const validation::BlindOptions& options, const validation::BlindResult& result);

}  // namespace stiffscope::page
