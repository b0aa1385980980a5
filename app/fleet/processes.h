#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stiffscope::app {

/// How a process ended, and what it wrote to the stream that was listened to.
struct Ended {
  int status = 0;  ///< of exit
  int signal = 0;  ///< that ended it; 0: none
  std::string said;

  bool well() const { return signal == 0 && status == 0; }
};

enum class Listen { standard_output, standard_error };

/// Runs a program to its end, with no input; the stream that is not listened to is this process's own. `variables`
/// (NAME=VALUE) replace those of the environment. Throws std::runtime_error where it cannot be started.
Ended runProcess(const std::string& program, const std::vector<std::string>& arguments, Listen listen,
                 const std::vector<std::string>& variables = {});

/// A path as a word of a command line that is not taken for an option: one that begins with a dash is named from here.
std::string pathWord(const std::filesystem::path& path);

/// This program's file, for processes of itself.
std::filesystem::path ownProgram();

}  // namespace stiffscope::app
