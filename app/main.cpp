#include <cstdio>
#include <exception>

#include "app/command_line.h"

// The only place that catches and prints.
int main(int count, char** words) {
  try {
    return stiffscope::runCommandLine(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stiffscope: %s\n", error.what());
    return 2;
  }
}
