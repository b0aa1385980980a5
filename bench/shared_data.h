#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stiffscope::bench {

/// Takes `--data=FOLDER` out of the arguments: where the data of the benchmarks is written for what they are compared
/// with. Makes the folder. Empty without.
std::optional<std::filesystem::path> dataFolder(int& argc, char** argv);

/// Raw doubles in the machine's order, as numpy.fromfile reads them.
void writeDoubles(const std::filesystem::path& file, const std::vector<double>& values);

}  // namespace stiffscope::bench
