#include "app/fleet/processes.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace stiffscope::app {

namespace {

std::vector<char*> pointersTo(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(const std::vector<std::string>& variables) {
  std::vector<std::string> all = variables;
  for (char** one = environ; *one != nullptr; ++one) {
    const std::string entry = *one;
    const auto sameName = [&](const std::string& given) {
      return entry.compare(0, entry.find('=') + 1, given, 0, given.find('=') + 1) == 0;
    };
    bool replaced = false;
    for (const std::string& given : variables) replaced = replaced || sameName(given);
    if (!replaced) all.push_back(entry);
  }
  return all;
}

/// Both ends are closed in programs that are started, but for what is put in the place of a stream.
struct Pipe {
  std::array<int, 2> ends{-1, -1};

  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() { closeWriting(), ::close(ends[0]); }

  void closeWriting() {
    if (ends[1] >= 0) ::close(ends[1]);
    ends[1] = -1;
  }

  std::string readAll() {
    std::string all;
    std::array<char, 4096> part;
    while (true) {
      const ssize_t got = ::read(ends[0], part.data(), part.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return all;
      all.append(part.data(), static_cast<std::size_t>(got));
    }
  }
};

}  // namespace

Ended runProcess(const std::string& program, const std::vector<std::string>& arguments, Listen listen,
                 const std::vector<std::string>& variables) {
  Pipe pipe;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe.ends[1],
                                   listen == Listen::standard_output ? STDOUT_FILENO : STDERR_FILENO);
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<std::string> environment = environmentWith(variables);
  pid_t process = 0;
  const int refused = ::posix_spawnp(&process, program.c_str(), &actions, nullptr, pointersTo(words).data(),
                                     pointersTo(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  if (refused != 0) throw std::runtime_error(program + ": not started: " + std::strerror(refused));
  pipe.closeWriting();
  Ended ended;
  ended.said = pipe.readAll();
  int state = 0;
  while (::waitpid(process, &state, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(state)) ended.signal = WTERMSIG(state);
  if (WIFEXITED(state)) ended.status = WEXITSTATUS(state);
  return ended;
}

std::string pathWord(const std::filesystem::path& path) {
  const std::string word = path.string();
  return word.starts_with('-') ? "./" + word : word;
}

std::filesystem::path ownProgram() { return std::filesystem::read_symlink("/proc/self/exe"); }

}  // namespace stiffscope::app
