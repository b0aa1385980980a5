#pragma once

namespace CLI {
class App;
}

namespace stiffscope {

/// Refuses, for every option of every command, what its type would take and nobody means: an empty value, a number that is
/// not finite, and of a whole number one that is negative or does not fit.
void checkOptionValues(CLI::App& app);

}  // namespace stiffscope
