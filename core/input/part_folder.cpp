#include "core/input/part_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace stiffscope {

namespace fs = std::filesystem;

namespace {

std::string prefixFor(const fs::path& target) { return "." + target.filename().string() + ".part-"; }

/// Descriptor of a folder that is locked now; -1 where another process holds it, or it is gone.
int lockedFolder(const fs::path& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (folder < 0) return -1;
  struct ::stat status {};
  if (::flock(folder, LOCK_EX | LOCK_NB) == 0 && ::fstat(folder, &status) == 0 && status.st_nlink > 0) return folder;
  ::close(folder);
  return -1;
}

void removeAbandoned(const fs::path& parent, const std::string& prefix) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    if (!entry.path().filename().string().starts_with(prefix)) continue;
    const int folder = lockedFolder(entry.path());
    if (folder < 0) continue;
    fs::remove_all(entry.path(), error);
    ::close(folder);
  }
}

}  // namespace

PartFolder::PartFolder(const fs::path& target) {
  const fs::path parent = target.parent_path();
  removeAbandoned(parent, prefixFor(target));
  // Between making and locking it another run may take it for abandoned: then it is gone, and another is made.
  constexpr int kTries = 100;
  for (int i = 0; i < kTries && lock_ < 0; ++i) {
    std::string name = (parent / (prefixFor(target) + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr) break;
    path_ = name;
    lock_ = lockedFolder(path_);
  }
  if (lock_ < 0) {
    throw fs::filesystem_error("cannot be written", parent, std::error_code(errno, std::generic_category()));
  }
}

PartFolder::~PartFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  ::close(lock_);
}

}  // namespace stiffscope
