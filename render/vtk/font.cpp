#include "render/vtk/font.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace stiffscope {

namespace {

std::vector<std::string> foldersToSearch() {
  if (const char* chosen = std::getenv("STIFFSCOPE_FONTS"); chosen != nullptr && *chosen != '\0')
    return {chosen};
  return {
#ifdef STIFFSCOPE_FONT_DIR
      STIFFSCOPE_FONT_DIR,
#endif
      "/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
      "/usr/share/fonts/TTF"};
}

}  // namespace

Fonts findFonts() {
  const std::vector<std::string> folders = foldersToSearch();
  for (const std::filesystem::path folder : folders) {
    std::error_code ignored;
    const auto regular = folder / "DejaVuSans.ttf";
    const auto bold = folder / "DejaVuSans-Bold.ttf";
    if (std::filesystem::exists(regular, ignored) && std::filesystem::exists(bold, ignored)) {
      return {regular.string(), bold.string()};
    }
  }
  throw std::runtime_error(
      fmt::format("cannot draw pictures: no DejaVuSans.ttf and DejaVuSans-Bold.ttf in {} (Debian package "
                  "fonts-dejavu-core; STIFFSCOPE_FONTS names another folder)",
                  fmt::join(folders, ", ")));
}

}  // namespace stiffscope
