#pragma once

#include <filesystem>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/campaign_xml.h"
#include "core/input/read_file.h"

namespace stiffscope {

/// The files of one campaign folder. Each is read once, so that the hash that the report lists is the hash of
/// the very bytes that were used; none outside the folder is read. Large files are hashed by a thread of their own
/// while the caller uses their bytes, which stay as they are.
class CampaignFiles {
 public:
  /// Throws InputError where the path is neither a folder with a campaign.xml nor such a file. Not `hashed`: takeInputs
  /// gives names alone.
  explicit CampaignFiles(const std::filesystem::path& folder_or_xml, bool hashed = true);

  const std::filesystem::path& folder() const { return folder_; }
  std::string xmlName() const { return xml_.string(); }  ///< for messages

  TextFile readXml();

  /// Bytes of a file that campaign.xml names. Throws InputError where it is missing, larger than `largest` or
  /// not a text file, or where its path is absolute or leads out of the folder, through ".." or through a link.
  TextFile read(const FileReference& reference, std::size_t largest);

  /// Throws InputError where a file that was read is no longer as it was: tables of two different moments
  /// are no campaign.
  void requireUnchanged() const;

  /// The name of such a file for messages: the folder as the user gave it, and the name.
  std::string shown(const FileReference& reference) const { return (folder_ / reference.name).string(); }

  /// Those read since the last call, in their order; waits for their hashes.
  std::vector<InputFile> takeInputs();

 private:
  /// A file that was read.
  struct Read {
    std::filesystem::path path;
    std::string name;
    FileStamp stamp;
    std::future<std::string> sha256;
  };

  TextFile readAndRecord(const std::filesystem::path& path, const std::string& name, std::size_t largest);

  std::filesystem::path folder_, xml_;
  bool hashed_;
  std::vector<Read> read_;
};

}  // namespace stiffscope
