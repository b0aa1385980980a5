#include "app/report_files.h"

#include <fstream>
#include <set>
#include <vector>

#include "core/input/write_folder.h"
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
  std::vector<FileToWrite> files;
  std::set<std::string> made;
  for (const Figure& figure : content.figures) {
    made.insert(pictureFile(figure));
    files.push_back({pictureFile(figure), {figure.png.begin(), figure.png.end()}});
  }
  files.push_back({"results.json", results});
  files.push_back({"report.html", page});
  std::vector<std::string> superseded = earlierPictures(folder);
  std::erase_if(superseded, [&](const std::string& name) { return made.contains(name); });
  writeFolderWhole(folder, files, superseded);
}

}  // namespace stiffscope
