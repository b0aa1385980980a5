#include "core/io/write_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/io/write_file.h"

namespace stiffscope::io {

/// Held by one run at a time of those that write folders beside each other, as long as its process lives. A folder that
/// was replaced stands unlocked under the name of a part, where another run would take it for abandoned.
class FolderTurn {
 public:
  /// Waits for it some seconds, and then, or where nothing can be locked, does without: a run that stands still must
  /// not hold up others for ever.
  explicit FolderTurn(const std::filesystem::path& parent);
  ~FolderTurn();
  FolderTurn(const FolderTurn&) = delete;
  FolderTurn& operator=(const FolderTurn&) = delete;

 private:
  int parent_;
};

/// A new folder beside `target`, named after it, that is removed with this object. It is locked as long as its process
/// lives; those that killed processes left unlocked are removed when a new one is made.
class PartFolder {
 public:
  /// Throws std::filesystem::filesystem_error where no folder can be made there.
  explicit PartFolder(const std::filesystem::path& target);
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

FolderTurn::FolderTurn(const std::filesystem::path& parent)
    : parent_(::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  constexpr int kTries = 2000;
  constexpr std::chrono::milliseconds kPause(5);
  for (int i = 0; i < kTries && ::flock(parent_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; ++i) {
    std::this_thread::sleep_for(kPause);
  }
}

FolderTurn::~FolderTurn() {
  if (parent_ >= 0) ::close(parent_);
}

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
    const int reason = errno;
    std::error_code none;
    if (lock_ >= 0 || !fs::exists(path_, none)) continue;
    fs::remove(path_, none);  // not to be locked at all, for want of descriptors: it would be left
    errno = reason;
    break;
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

namespace fs = std::filesystem;

namespace {

[[noreturn]] void failFolder(const fs::path& folder, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", folder.string(), reason));
}

// Links what `from` holds and `to` lacks into `to`, folders within it anew; where the file system has no links, or does
// not permit one, the file is copied.
void carryOver(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path target = to / entry.path().filename();
    if (entry.is_directory() && !entry.is_symlink()) {
      fs::create_directory(target, entry.path());
      carryOver(entry.path(), target);
    } else if (::linkat(AT_FDCWD, entry.path().c_str(), AT_FDCWD, target.c_str(), 0) != 0 && errno != EEXIST) {
      fs::copy(entry.path(), target, fs::copy_options::copy_symlinks | fs::copy_options::skip_existing);
    }
  }
}

void takeModeAndOwner(const fs::path& from, const fs::path& to) {
  struct ::stat status {};
  if (::stat(from.c_str(), &status) != 0) return;
  // Only root may give a folder away; that it stays with who writes is no reason to write nothing.
  if (::chown(to.c_str(), status.st_uid, status.st_gid) != 0) errno = 0;
  ::chmod(to.c_str(), status.st_mode & 07777);
}

void giveDefaultMode(const fs::path& folder) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::chmod(folder.c_str(), 0777 & ~mask);
}

/// Puts the new folder in the place of `folder`; false where that cannot be done here. What was there is at the new
/// folder's path afterwards.
bool exchange(const fs::path& fresh, const fs::path& folder) {
  // A run beside this one may make the folder between the two calls, once.
  for (int i = 0; i < 3; ++i) {
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno != EEXIST) return false;
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) return true;
    if (errno != ENOENT) return false;
  }
  return false;
}

bool holdsCurrentFolder(const fs::path& folder) {
  std::error_code error;
  const fs::path here = fs::current_path(error);
  return std::mismatch(folder.begin(), folder.end(), here.begin(), here.end()).first == folder.end();
}

/// Nothing but files goes; one that is gone already, or may not be removed, is no reason to fail.
void removeFiles(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::symlink_status(folder / name, ignored))) fs::remove(folder / name, ignored);
  }
}

bool writeByExchange(const fs::path& folder, const std::vector<FileToWrite>& files,
                     const std::vector<std::string>& superseded) {
  if (holdsCurrentFolder(folder) || ::access(folder.parent_path().c_str(), W_OK | X_OK) != 0) return false;
  const PartFolder part(folder);
  for (const FileToWrite& file : files) writeFileNamed(part.path() / file.name, file.bytes, folder / file.name);
  try {
    const bool replaces = fs::exists(folder);
    if (replaces) carryOver(folder, part.path());
    removeFiles(part.path(), superseded);
    replaces ? takeModeAndOwner(folder, part.path()) : giveDefaultMode(part.path());
  } catch (const fs::filesystem_error&) {
    return false;  // it holds what this user may neither link nor copy
  }
  if (!exchange(part.path(), folder)) return false;
  // What came into the old folder while it was linked.
  std::error_code error;
  if (fs::exists(part.path(), error)) {
    removeFiles(part.path(), superseded);
    carryOver(part.path(), folder);
  }
  return true;
}

/// Files of a folder under other names, which are removed with this object unless they were renamed.
class Prepared {
 public:
  Prepared(const fs::path& folder, const std::vector<FileToWrite>& files) : folder_(folder), files_(files) {}
  ~Prepared() {
    std::error_code ignored;
    for (const FileToWrite& file : files_) fs::remove(partOf(file), ignored);
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  void write() const {
    for (const FileToWrite& file : files_) writeFileNamed(partOf(file), file.bytes, folder_ / file.name);
  }
  void rename() const {
    for (const FileToWrite& file : files_) fs::rename(partOf(file), folder_ / file.name);
  }

 private:
  fs::path partOf(const FileToWrite& file) const { return folder_ / fmt::format(".{}.{}.part", file.name, ::getpid()); }

  const fs::path& folder_;
  const std::vector<FileToWrite>& files_;
};

}  // namespace

void writeFolderWhole(const fs::path& folder, const std::vector<FileToWrite>& files,
                      const std::vector<std::string>& superseded) try {
  if (folder.empty()) failFolder(folder, "it names no folder; expected the name of one");
  // Links are followed and a slash at the end is cut, so that the folder itself has a name beside which to write.
  fs::path target = fs::weakly_canonical(fs::absolute(folder));
  if (target.filename().empty()) target = target.parent_path();
  const fs::file_status status = fs::status(target);
  if (!fs::exists(status) && fs::is_symlink(fs::symlink_status(target)))
    failFolder(folder, "it is a link to what is not there; expected the name of a folder");
  if (fs::exists(status) && !fs::is_directory(status)) failFolder(folder, "it is no folder; expected the name of one");
  if (fs::exists(status) && ::access(target.c_str(), W_OK | X_OK) != 0)
    failFolder(folder, fmt::format("{}; expected a folder that can be written", std::strerror(errno)));
  if (!fs::exists(status)) makeFolder(target.parent_path());
  const FolderTurn turn(target.parent_path());
  if (writeByExchange(target, files, superseded)) return;
  makeFolder(target);
  const Prepared prepared(target, files);
  prepared.write();
  prepared.rename();
  removeFiles(target, superseded);
} catch (const fs::filesystem_error& error) {
  failFolder(folder, error.code().message() + "; expected a folder that can be made and written");
}

}  // namespace stiffscope::io
