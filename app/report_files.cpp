#include "app/report_files.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "app/output.h"
#include "core/io/write_folder.h"
#include "reports/json/json_document.h"
#include "reports/json/results_json.h"

namespace stiffscope::app {

namespace {

namespace fs = std::filesystem;

/// A picture's or a table's bare name: a results.json that names something else was not written here.
bool isPictureOrTable(const std::string& name) {
  const fs::path path(name);
  return (path.extension() == ".png" || path.extension() == ".csv") && path.filename() == path &&
         !path.stem().empty();
}

/// Pictures and tables that the report which is there now lists as its own.
std::vector<std::string> earlierFiles(const fs::path& folder) {
  std::ifstream file(folder / "results.json", std::ios::binary);
  if (!file) return {};
  // Of what may be tens of megabytes nothing else is kept.
  const auto only_files = [](int depth, reports::Json::parse_event_t event, const reports::Json& parsed) {
    return depth != 1 || event != reports::Json::parse_event_t::key || parsed == "files";
  };
  constexpr bool kThrow = false;
  const reports::Json results = reports::Json::parse(file, only_files, kThrow);
  if (!results.is_object() || !results.contains("files") || !results["files"].is_array()) return {};
  std::vector<std::string> names;
  for (const reports::Json& name : results["files"]) {
    if (name.is_string() && isPictureOrTable(name.get<std::string>()))
      names.push_back(name.get<std::string>());
  }
  return names;
}

std::set<std::string> namesIn(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) names.insert(entry.path().filename().string());
  return names;
}

/// Throws std::runtime_error where a file to be made is `there` and not `earlier` made by a report: it is the user's.
void requireOwn(const fs::path& folder, const std::set<std::string>& there, const std::vector<std::string>& earlier,
                const std::set<std::string>& made) {
  for (const std::string& name : made) {
    if (!there.contains(name) || std::find(earlier.begin(), earlier.end(), name) != earlier.end()) continue;
    if ((name == "results.json" || name == "report.html") && !earlier.empty()) continue;
    throw std::runtime_error((folder / name).string() +
                             ": not written: it is there and of no earlier report; expected another folder, or that file away");
  }
}

}  // namespace

void writeReportFiles(const fs::path& folder, const reports::ReportContent& content, const page::ReportPage& page) {
  // What is there is looked at before what is listed: another run may replace both between the two.
  const std::set<std::string> there = namesIn(folder);
  std::vector<std::string> superseded = earlierFiles(folder);
  std::vector<io::FileToWrite> files;
  for (const reports::Figure& figure : content.figures) {
    files.push_back({reports::pictureFile(figure), {figure.png.begin(), figure.png.end()}});
  }
  for (const reports::TableFile& table : page.tables) files.push_back({table.name + ".csv", table.csv});
  std::set<std::string> made{"results.json", "report.html"};
  for (const io::FileToWrite& file : files) made.insert(file.name);
  requireOwn(folder, there, superseded, made);
  reports::JsonDocument results = reports::resultsJson(content);
  results.json["files"] = made;
  files.push_back(
      {"results.json", io::ByteSource([&results](const io::ByteSink& sink) { writeJson(results, sink); })});
  files.push_back({"report.html", page.html});
  std::erase_if(superseded, [&](const std::string& name) { return made.contains(name); });
  io::writeFolderWhole(folder, files, superseded);
}

}  // namespace stiffscope::app
