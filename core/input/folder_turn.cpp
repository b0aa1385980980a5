#include "core/input/folder_turn.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

namespace stiffscope {

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

}  // namespace stiffscope
