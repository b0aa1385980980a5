#include "app/large_heap.h"

#include <cstdint>
#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#include <sys/mman.h>
#endif

namespace stiffscope {

#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)

void useLargeHeapPages() {
  constexpr int kKeep = 1 << 30;
  constexpr std::size_t kHeap = std::size_t{1} << 28, kPage = std::size_t{1} << 21;
  if (::mallopt(M_MMAP_THRESHOLD, kKeep) == 0) return;  // of the heap, however large
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
  // Address space alone: what is not used is never there.
  void* const heap = std::malloc(kHeap);
  if (heap == nullptr) return;
  const auto first = (reinterpret_cast<std::uintptr_t>(heap) + kPage - 1) / kPage * kPage;
  ::madvise(reinterpret_cast<void*>(first), kHeap - kPage, MADV_HUGEPAGE);
  std::free(heap);
}

#else

void useLargeHeapPages() {}

#endif

}  // namespace stiffscope
