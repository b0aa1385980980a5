#include "app/report_files.h"

#include <fstream>
#include <set>
#include <vector>

#include "core/input/write_file.h"
#include "reports/json/json_values.h"

namespace stiffscope {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTables = "tables";

/// A picture's bare name or a table's in its folder: a results.json that names something else was not written here.
bool isOurs(const std::string& name) {
  const fs::path path(name);
  if (path.stem().empty()) return false;
  if (path.extension() == ".png") return path.filename() == path;
  return path.extension() == ".csv" && fs::path(kTables) / path.filename() == path;
}

std::string tableFile(const TableFile& table) { return std::string(kTables) + "/" + table.name + ".csv"; }

/// Pictures and tables that the report which is there now lists as its own.
std::vector<std::string> earlierFiles(const fs::path& folder) {
  std::ifstream file(folder / "results.json", std::ios::binary);
  if (!file) return {};
  constexpr bool kThrow = false;
  const Json results = Json::parse(file, nullptr, kThrow);
  if (!results.is_object() || !results.contains("files") || !results["files"].is_array()) return {};
  std::vector<std::string> files;
  for (const Json& name : results["files"]) {
    if (name.is_string() && isOurs(name.get<std::string>())) files.push_back(name.get<std::string>());
  }
  return files;
}

}  // namespace

void writeReportFiles(const fs::path& folder, const ReportContent& content, const ReportPage& page, Json results) {
  makeFolder(folder);
  makeFolder(folder / kTables);
  const std::vector<std::string> earlier = earlierFiles(folder);
  std::set<std::string> made;
  for (const Figure& figure : content.figures) {
    made.insert(pictureFile(figure));
    writeFileWhole(folder / pictureFile(figure),
                   {reinterpret_cast<const char*>(figure.png.data()), figure.png.size()});
  }
  for (const TableFile& table : page.tables) {
    made.insert(tableFile(table));
    results["files"].push_back(tableFile(table));
    writeFileWhole(folder / tableFile(table), table.csv);
  }
  writeFileWhole(folder / "results.json", results.dump(1) + '\n');
  writeFileWhole(folder / "report.html", page.html);
  for (const std::string& name : earlier) {
    std::error_code ignored;  // one that is gone already, or may not be removed, is no reason to fail
    if (!made.contains(name) && fs::is_regular_file(fs::symlink_status(folder / name, ignored))) {
      fs::remove(folder / name, ignored);
    }
  }
}

}  // namespace stiffscope
