#include "app/returned_memory.h"

#include <cstddef>
#include <cstdint>
#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#if defined(__GLIBC__)




#endif

namespace stiffscope::app {

#if defined(__GLIBC__)

namespace {

/// Relocations in code, which would be lost; distributions do not build such libraries.
bool hasRelocatedCode(const dl_phdr_info& library) {
  for (int k = 0; k < library.dlpi_phnum; ++k) {
    const ElfW(Phdr)& part = library.dlpi_phdr[k];
    if (part.p_type != PT_DYNAMIC) continue;
    const auto* entry = reinterpret_cast<const ElfW(Dyn)*>(library.dlpi_addr + part.p_vaddr);
    for (; entry->d_tag != DT_NULL; ++entry) {
      if (entry->d_tag == DT_TEXTREL || (entry->d_tag == DT_FLAGS && (entry->d_un.d_val & DF_TEXTREL) != 0)) return true;
    }
  }
  return false;
}

/// Unmaps the pages of what nobody writes: they are read from the file again where they are used again.
void letGoOfCode(const dl_phdr_info& library) {
  if (hasRelocatedCode(library)) return;
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  for (int k = 0; k < library.dlpi_phnum; ++k) {
    const ElfW(Phdr)& part = library.dlpi_phdr[k];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_W) != 0) continue;
    const std::uintptr_t start = library.dlpi_addr + part.p_vaddr;
    const std::uintptr_t from = start / page * page, to = (start + part.p_filesz) / page * page;
    if (to > from) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);  // a hint: no matter if it fails
  }
}

}  // namespace

void returnLargeBlocks() {
  constexpr int kLarge = 1 << 20, kKeep = 1 << 26;
  ::mallopt(M_MMAP_THRESHOLD, kLarge);
  // Mesa takes and frees forty megabytes in small blocks for every picture: these are kept for the next.
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
}

void returnFreeMemory() {
  constexpr std::size_t kKeepNothing = 0;
  ::malloc_trim(kKeepNothing);
  constexpr auto kOfEach = [](dl_phdr_info* library, std::size_t, void*) { return letGoOfCode(*library), 0; };
  ::dl_iterate_phdr(kOfEach, nullptr);
}

#else

void returnLargeBlocks() {}
void returnFreeMemory() {}

#endif

}  // namespace stiffscope::app
