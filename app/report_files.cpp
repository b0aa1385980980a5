#include "app/report_files.h"

#include <fstream>
#include <set>
#include <vector>

#include "core/input/write_file.h"
#include "reports/json/json_values.h"

namespace stiffscope {

namespace {

namespace fs = std::filesystem;

/// A picture's bare name: a results.json that names something else was not written here.
bool isPicture(const std::string& name) {
  const fs::path path(name);
  return path.extension() == ".png" && path.filename() == path && !path.stem().empty();
}

/// Pictures that the report which is there now lists as its own.
std::vector<std::string> earlierPictures(const fs::path& folder) {
  std::ifstream file(folder / "results.json", std::ios::binary);
  if (!file) return {};
  constexpr bool kThrow = false;
  const Json results = Json::parse(file, nullptr, kThrow);
  if (!results.is_object() || !results.contains("files") || !results["files"].is_array()) return {};
  std::vector<std::string> pictures;
  for (const Json& name : results["files"]) {
    if (name.is_string() && isPicture(name.get<std::string>())) pictures.push_back(name.get<std::string>());
  }
  return pictures;
}

}  // namespace

void writeReportFiles(const fs::path& folder, const ReportContent& content, const std::string& page,
                      const std::string& results) {
  makeFolder(folder);
  const std::vector<std::string> earlier = earlierPictures(folder);
  std::set<std::string> made;
  for (const Figure& figure : content.figures) {
    made.insert(pictureFile(figure));
    writeFileWhole(folder / pictureFile(figure),
                   {reinterpret_cast<const char*>(figure.png.data()), figure.png.size()});
  }
  writeFileWhole(folder / "results.json", results);
  writeFileWhole(folder / "report.html", page);
  for (const std::string& name : earlier) {
    std::error_code ignored;  // one that is gone already, or may not be removed, is no reason to fail
    if (!made.contains(name) && fs::is_regular_file(fs::symlink_status(folder / name, ignored))) {
      fs::remove(folder / name, ignored);
    }
  }
}

}  // namespace stiffscope
