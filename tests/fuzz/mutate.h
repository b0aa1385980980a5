#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stiffscope::fuzz {

/// Changes texts at random, the same way for the same seed on every machine: bytes flipped, cut, repeated, put in, and
/// pieces of other texts and of a list of words put in.
class Mutator {
 public:
  Mutator(std::vector<std::string> texts, std::vector<std::string> words, std::uint64_t seed)
      : texts_(std::move(texts)), words_(std::move(words)), state_(seed) {}

  /// One of the texts with one to eight changes.
  std::string next();

 private:
  std::size_t below(std::size_t count);
  void change(std::string& text);

  std::vector<std::string> texts_, words_;
  std::uint64_t state_;
};

}  // namespace stiffscope::fuzz
