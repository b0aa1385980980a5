#include "core/input/files_read.h"

#include <cstdint>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>

namespace stiffscope {

namespace {

struct FilesRead {
  std::mutex mutex;
  std::set<std::pair<std::uint64_t, std::uint64_t>> ids;  ///< device and inode
};

FilesRead& filesRead() {
  static FilesRead files;
  return files;
}

}  // namespace

void recordRead(const FileStamp& stamp) {
  FilesRead& files = filesRead();
  const std::lock_guard lock(files.mutex);
  files.ids.emplace(stamp.device, stamp.inode);
}

void requireNotRead(const std::filesystem::path& path) {
  const auto stamp = stampOf(path);
  FilesRead& files = filesRead();
  const std::lock_guard lock(files.mutex);
  if (!stamp || !files.ids.contains({stamp->device, stamp->inode})) return;
  throw std::runtime_error(path.string() + ": not written: it is an input of this run; expected another file");
}

}  // namespace stiffscope
