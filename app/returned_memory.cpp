#include "app/returned_memory.h"

#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace stiffscope {

#if defined(__GLIBC__)

void returnLargeBlocks() {
  constexpr int kLarge = 1 << 20, kKeep = 1 << 26;
  ::mallopt(M_MMAP_THRESHOLD, kLarge);
  // Mesa takes and frees forty megabytes in small blocks for every picture: these are kept for the next.
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
}

void returnFreeMemory() {
  constexpr std::size_t kKeepNothing = 0;
  ::malloc_trim(kKeepNothing);
}

#else

void returnLargeBlocks() {}
void returnFreeMemory() {}

#endif

}  // namespace stiffscope
