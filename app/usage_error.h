#pragma once

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace stiffscope {

/// One line to standard error for a command line that cannot be understood; a word that is not known gets the
/// nearest one that is. Returns the exit status.
int explainUsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace stiffscope
