#include "core/input/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace stiffscope {

#if defined(MADV_HUGEPAGE)

void askForLargePages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (first + kPage - 1) / kPage * kPage, to = (first + bytes) / kPage * kPage;
  if (from < to) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);  // a hint: no matter if it fails
}

#else

void askForLargePages(void*, std::size_t) {}

#endif

}  // namespace stiffscope
