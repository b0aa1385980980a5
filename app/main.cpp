#include <fcntl.h>
#include <glog/logging.h>
#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#endif
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <string_view>
#include "app/command_line.h"
#include "core/io/input_error.h"
#include "core/numerics/parallel.h"

namespace {

/// A standard stream that is closed would be the number of the next file that is opened, and what is printed would be
/// written into that.
void holdStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // Standard output as one that cannot be written, so that a result that nobody gets is said to be lost.
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// Runs `work` with a stack of 8 MiB, which the decompositions of small matrices need some of; a shell may allow less
/// (ulimit -s). All threads that `work` starts have as much.
int onWideStack(const std::function<int()>& work) {
  constexpr std::size_t kWide = std::size_t{8} << 20;
  ::rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kWide)
    return work();
  struct Task {
    const std::function<int()>& work;
    int status = 2;
  } task{work};
  pthread_attr_t wide;
  pthread_t thread{};
  pthread_attr_init(&wide);
  pthread_attr_setstacksize(&wide, kWide);
  pthread_setattr_default_np(&wide);
  const auto run = [](void* given) -> void* {
    auto& own = *static_cast<Task*>(given);
    own.status = own.work();
    return nullptr;
  };
  const bool started = pthread_create(&thread, &wide, run, &task) == 0;
  pthread_attr_destroy(&wide);
  if (!started) return work();
  pthread_join(thread, nullptr);
  return task.status;
}

#ifdef __GLIBC__
/// Asks for the first of the heap in pages of 2 MiB where the system gives them to those who ask: one fault then in
/// place of 512, a twentieth of a report's time. Reserved addresses cost nothing until they are written to.
void takeLargePages() {
#ifdef MADV_HUGEPAGE
  constexpr int kReserved = 256 << 20;  // bytes: what a report of two campaigns needs
  ::rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY)
    return;  // addresses themselves are scarce
  if (::mallopt(M_TOP_PAD, kReserved) == 0) return;
  constexpr std::size_t kMore = 1 << 20;  // more than the heap has left: it grows
  void* const first = std::malloc(kMore);
  if (first == nullptr) return;
  constexpr std::uintptr_t kLarge = std::uintptr_t{2} << 20;
  const std::uintptr_t from = (reinterpret_cast<std::uintptr_t>(first) + kLarge - 1) / kLarge * kLarge;
  const auto end = reinterpret_cast<std::uintptr_t>(::sbrk(0));
  // Where the block is no part of the heap it lies beyond its end.
  if (end > from) ::madvise(reinterpret_cast<void*>(from), end - from, MADV_HUGEPAGE);
  std::free(first);
#endif
}
#endif

/// Memory that is given back to the system comes again as zeroed pages, one fault each: matrices and pictures, which
/// are made and dropped by the hundred, cost a sixth of a report's time that way. The process keeps what it had. Large
/// pages pay where most of the heap is used; `identify` of a large day lost a fiftieth by them.
void keepFreedMemory(bool uses_much) {
#ifdef __GLIBC__
  constexpr int kMany = 1 << 30, kStep = 16 << 20;      // bytes
  if (::mallopt(M_MMAP_THRESHOLD, kMany) == 0) return;  // the others alone would map every matrix anew
  ::mallopt(M_TRIM_THRESHOLD, kMany);
  if (uses_much) takeLargePages();
  ::mallopt(M_TOP_PAD, kStep);
#endif
}

/// The only place that catches and prints.
int statusOf(int count, char** words) {
  try {
    return stiffscope::app::runCommandLine(count, words);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "stiffscope: the memory this process may have is used up\n");
    return 2;
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "stiffscope: %s: expected a file or folder that can be used: %s\n",
                 stiffscope::io::oneLine(error.path1().string(), 1000).c_str(), error.code().message().c_str());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stiffscope: %s\n", error.what());
    return 2;
  }
}

}  // namespace

int main(int count, char** words) {
  holdStandardStreams();
  // A file size limit is then an error of the write like any other, which says what could not be written.
  std::signal(SIGXFSZ, SIG_IGN);
  // Ceres logs each step that fails; results say what could not be determined.
  FLAGS_minloglevel = google::GLOG_FATAL;
  stiffscope::numerics::sumAlikeEverywhere();
  keepFreedMemory(count > 1 && std::string_view(words[1]) == "report");
  return onWideStack([&] { return statusOf(count, words); });
}
