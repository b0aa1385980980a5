#include "core/campaign/campaign_files.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "core/input/input_error.h"
#include "core/input/read_file.h"
#include "core/input/sha256.h"

namespace stiffscope {

namespace fs = std::filesystem;

namespace {

bool leadsInside(const fs::path& folder, const fs::path& path) {
  const fs::path root = fs::weakly_canonical(folder);
  const fs::path file = fs::weakly_canonical(path);
  return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

bool isXml(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".xml";
}

}  // namespace

CampaignFiles::CampaignFiles(const fs::path& folder_or_xml, bool hashed) : hashed_(hashed) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_or_xml, error);
  if (!fs::exists(status)) {
    throw InputError({folder_or_xml.string(), 0, ""}, "",
                     "expected a campaign folder or its campaign.xml; there is none");
  }
  const bool is_folder = fs::is_directory(status);
  if (!is_folder && !isXml(folder_or_xml)) {
    throw InputError({folder_or_xml.string(), 0, ""}, "",
                     "expected a campaign folder or its campaign.xml: give the folder that holds this file");
  }
  xml_ = is_folder ? folder_or_xml / "campaign.xml" : folder_or_xml;
  folder_ = is_folder ? folder_or_xml : folder_or_xml.parent_path();
  if (folder_.empty()) folder_ = ".";
  if (is_folder && !fs::exists(xml_, error)) {
    throw InputError({folder_or_xml.string(), 0, ""}, "",
                     "expected a campaign folder; it holds no campaign.xml");
  }
}

TextFile CampaignFiles::readXml() { return readAndRecord(xml_, xml_.filename().string(), kLargestXml); }

TextFile CampaignFiles::read(const FileReference& reference, std::size_t largest) {
  const auto refuse = [&](const std::string& why) {
    throw InputError({xmlName(), reference.line, reference.attribute}, reference.name,
                     "expected a file inside the campaign's folder; " + why);
  };
  const fs::path name(reference.name);
  if (name.is_absolute()) refuse("this path is absolute");
  const fs::path normal = name.lexically_normal();
  if (!normal.empty() && *normal.begin() == "..") refuse("this path leads out of it");
  const fs::path path = folder_ / normal;
  std::error_code error;
  if (!fs::exists(path, error)) refuse("there is none of this name");
  if (!leadsInside(folder_, path)) refuse("a link leads out of it");
  return readAndRecord(path, reference.name, largest);
}

TextFile CampaignFiles::readAndRecord(const fs::path& path, const std::string& name, std::size_t largest) {
  TextFile file = readTextFileWithStamp(path, largest);
  read_.push_back({path, name, file.stamp, {}});
  if (!hashed_) return file;
  constexpr std::size_t kOwnThread = 1 << 20;  // hashed in a millisecond
  // Where no thread is to be had, either policy lets it be hashed when the hash is asked for.
  const auto when = file.size < kOwnThread ? std::launch::deferred : std::launch::async | std::launch::deferred;
  // What is hashed goes: the rows of all tables come while the hashes wait to be asked for.
  read_.back().sha256 = std::async(when, [text = file]() mutable { return sha256Hex(std::exchange(text, {}).text()); });
  return file;
}

std::vector<InputFile> CampaignFiles::takeInputs() {
  std::vector<InputFile> inputs;
  for (Read& file : read_) inputs.push_back({file.name, hashed_ ? file.sha256.get() : std::string()});
  read_.clear();
  return inputs;
}

void CampaignFiles::requireUnchanged() const {
  for (const Read& file : read_) {
    if (stampOf(file.path) == file.stamp) continue;
    throw InputError({file.path.string(), 0, ""}, "",
                     "expected a file that stays as it is; it changed while the campaign was read");
  }
}

}  // namespace stiffscope
