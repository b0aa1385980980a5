#pragma once

namespace stiffscope {

/// Parses the command line and runs the command. Returns the exit status; throws what the command throws.
int runCommandLine(int count, char** words);

}  // namespace stiffscope
