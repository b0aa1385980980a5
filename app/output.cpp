#include "app/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "app/write_json.h"
#include "core/input/files_read.h"
#include "core/input/one_line.h"
#include "core/input/write_file.h"

namespace stiffscope {

Campaign openCampaign(const std::string& folder_or_xml, Hashes hashes) {
  CampaignReading reading = readCampaign(folder_or_xml, hashes);
  printWarnings(reading.warnings);
  return std::move(reading.campaign);
}

void printWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::fprintf(stderr, "stiffscope: warning: %s\n", warning.c_str());
}

void deliver(const std::function<JsonDocument()>& json, const std::function<std::string()>& text, const std::string& json_file) {
  const bool json_only = json_file == "-";
  if (json_only) return writeJson(json(), printBytes);
  if (!json_file.empty()) {
    requireNotRead(json_file);
    const JsonDocument values = json();
    writeFileWhole(json_file, [&values](const ByteSink& sink) { writeJson(values, sink); });
  }
  printText(text());
}

void printText(std::string_view text) { printBytes(withoutControls(text)); }

void printBytes(std::string_view text) {
  errno = 0;
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(std::string("standard output: cannot be written: ") + std::strerror(errno));
}

}  // namespace stiffscope
