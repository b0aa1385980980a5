#include <fcntl.h>
#include <glog/logging.h>
#ifdef __GLIBC__
#include <malloc.h>
#include <sys/auxv.h>
#endif
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <system_error>
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

/// Whether a limit of this process is so much, or there is none.
template <class Resource>
bool mayUse(Resource resource, ::rlim_t least) {
  ::rlimit limit{};
  return ::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= least;
}

/// Runs `work` with a stack of 8 MiB, which the decompositions of small matrices need some of; a shell may allow less
/// (ulimit -s). Where addresses are limited (ulimit -v), too: a thread has its stack from the beginning, while the
/// first one's grows, and where that fails a signal ends the program without a word. All threads that `work` starts
/// have as much.
int onWideStack(const std::function<int()>& work) {
  constexpr std::size_t kWide = std::size_t{8} << 20;
  if (mayUse(RLIMIT_STACK, kWide) && mayUse(RLIMIT_AS, RLIM_INFINITY)) return work();
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
/// Starts this program once more in its own place with the heap in pages of 2 MiB, which the C library takes from its
/// environment at the start alone. A fault and an address translation then serve 512 small pages: a tenth of the time
/// of most commands on a long day. Where the system gives no such pages nothing changes; where the program cannot be
/// started again, or somebody has tuned the library, it goes on as it is.
void restartWithLargePages(char** words) {
  constexpr const char* kTunables = "GLIBC_TUNABLES";
  if (::getauxval(AT_SECURE) != 0) return;  // the loader takes the variable away: this would begin again for ever
  if (std::getenv(kTunables) != nullptr || !mayUse(RLIMIT_AS, RLIM_INFINITY))
    return;  // large pages take more addresses, which are scarce where they are limited
  std::error_code unknown;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (unknown || own.filename() != "stiffscope") return;  // the loader or an emulator, which wants other words
  ::setenv(kTunables, "glibc.malloc.hugetlb=1", 1);
  ::execv(own.c_str(), words);
}
#endif

/// Memory that is given back to the system comes again as zeroed pages, one fault each: matrices and pictures, which
/// are made and dropped by the hundred, cost a sixth of a report's time that way. The process keeps what it had.
void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMany = 1 << 30, kStep = 16 << 20;      // bytes
  if (::mallopt(M_MMAP_THRESHOLD, kMany) == 0) return;  // the others alone would map every matrix anew
  ::mallopt(M_TRIM_THRESHOLD, kMany);
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
#ifdef __GLIBC__
  restartWithLargePages(words);
#endif
  holdStandardStreams();
  // A file size limit is then an error of the write like any other, which says what could not be written.
  std::signal(SIGXFSZ, SIG_IGN);
  // Ceres logs each step that fails; results say what could not be determined.
  FLAGS_minloglevel = google::GLOG_FATAL;
  stiffscope::numerics::sumAlikeEverywhere();
  keepFreedMemory();
  return onWideStack([&] { return statusOf(count, words); });
}
