#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include "app/command_line.h"
#include "core/io/input_error.h"

// The only place that catches and prints.
int main(int count, char** words) {
  // A file size limit is then an error of the write like any other, which says what could not be written.
  std::signal(SIGXFSZ, SIG_IGN);
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
