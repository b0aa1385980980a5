#include "app/large_heap.h"

#include <cstdlib>
#include <malloc.h>

#include "core/io/read_file.h"

#if defined(__GLIBC__)

#endif

namespace stiffscope::app {

#if defined(__GLIBC__)

void useLargeHeapPages() {
  constexpr int kKeep = 1 << 30;
  constexpr std::size_t kHeap = std::size_t{1} << 28;
  if (::mallopt(M_MMAP_THRESHOLD, kKeep) == 0) return;  // of the heap, however large
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
  // Address space alone: what is not used is never there.
  void* const heap = std::malloc(kHeap);
  if (heap == nullptr) return;
  io::askForLargePages(heap, kHeap);
  std::free(heap);
}

#else

void useLargeHeapPages() {}

#endif

}  // namespace stiffscope::app
