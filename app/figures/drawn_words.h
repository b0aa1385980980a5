#pragma once

#include <cstddef>
#include <string>

namespace stiffscope {

/// " Drawn: 100 of 10000 postures, spread evenly." for a caption where evenlySpreadIndices left some out; empty where all are
/// drawn. More marks in one picture hide each other, and what lies on top is taken for all.
std::string drawnWords(std::size_t count, std::size_t most, const std::string& what);

}  // namespace stiffscope
