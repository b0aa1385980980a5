#include "core/input/csv_marks.h"

#include <array>
#include <cstring>

namespace stiffscope {

namespace {

constexpr std::size_t kBlock = 64;

/// The lowest bits of eight bytes as one byte, the first byte's as the lowest.
std::uint64_t bitsOf(const unsigned char* flags) {
  std::uint64_t bits = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags, sizeof eight);
    bits =
        (eight * 0x0102040810204080ull) >> 56;  // each factor brings one byte's bit to its place at the top
  } else {
    for (std::size_t i = 0; i < 8; ++i) bits |= std::uint64_t{flags[i]} << i;
  }
  return bits;
}

/// Bit i: whether block[i] is no more than a comma. One comparison, which compilers make for many bytes at
/// once.
std::uint64_t marksIn(const char* block) {
  std::array<unsigned char, kBlock> flags;
  for (std::size_t i = 0; i < kBlock; ++i) flags[i] = static_cast<unsigned char>(block[i]) <= ',' ? 1 : 0;
  std::uint64_t marks = 0;
  for (std::size_t i = 0; i < kBlock; i += 8) marks |= bitsOf(flags.data() + i) << i;
  return marks;
}

}  // namespace

std::uint64_t CsvMarks::marksOfBlock(const char* block, const char* end) {
  const auto left = static_cast<std::size_t>(end - block);
  if (left >= kBlock) return marksIn(block);
  std::array<char, kBlock> last;
  last.fill('0');
  if (left > 0) std::memcpy(last.data(), block, left);
  return marksIn(last.data());
}

}  // namespace stiffscope
