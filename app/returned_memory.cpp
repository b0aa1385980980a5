#include "app/returned_memory.h"

#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace stiffscope {

void returnFreedMemory() {
#if defined(M_MMAP_THRESHOLD)
  constexpr int kLarge = 1 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

}  // namespace stiffscope
