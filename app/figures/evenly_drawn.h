#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace stiffscope {

/// Which of `count` things to draw: all up to `most`, beyond it so many, spread evenly, in order. More marks in one picture
/// hide each other, and what lies on top is taken for all.
std::vector<std::size_t> evenlyDrawn(std::size_t count, std::size_t most);

/// " Drawn: 100 of 10000 postures, spread evenly." for a caption; empty where all are drawn.
std::string drawnWords(std::size_t count, std::size_t most, const std::string& what);

}  // namespace stiffscope
