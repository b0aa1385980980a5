#include "bench/shared_data.h"

#include <algorithm>
#include <fstream>
#include <string_view>

namespace stiffscope::bench {

std::optional<std::filesystem::path> dataFolder(int& argc, char** argv) {
  constexpr std::string_view kFlag = "--data=";
  char** const end = argv + argc;
  char** const at = std::find_if(argv, end, [&](std::string_view word) { return word.starts_with(kFlag); });
  if (at == end) return std::nullopt;
  std::filesystem::path folder(std::string_view(*at).substr(kFlag.size()));
  std::filesystem::create_directories(folder);
  std::copy(at + 1, end, at);
  --argc;
  return folder;
}

void writeDoubles(const std::filesystem::path& file, const std::vector<double>& values) {
  std::ofstream out(file, std::ios::binary);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(double)));
}

}  // namespace stiffscope::bench
