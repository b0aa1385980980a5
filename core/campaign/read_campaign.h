#pragma once

#include <filesystem>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/campaign_xml.h"
#include "core/io/read_file.h"

namespace stiffscope::campaign {

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

  io::TextFile readXml();

  /// Bytes of a file that campaign.xml names. Throws InputError where it is missing, larger than `largest` or
  /// not a text file, or where its path is absolute or leads out of the folder, through ".." or through a link.
  io::TextFile read(const FileReference& reference, std::size_t largest);

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
    io::FileStamp stamp;
    std::future<std::string> sha256;
  };

  io::TextFile readAndRecord(const std::filesystem::path& path, const std::string& name, std::size_t largest);

  std::filesystem::path folder_, xml_;
  bool hashed_;
  std::vector<Read> read_;
};

struct CampaignReading {
  Campaign campaign;
  std::vector<std::string> warnings;  ///< one line each: `FILE:LINE: COLUMN: 'VALUE': FINDING`
};

/// Whether the files' hashes are wanted: what shows none is quicker without.
enum class Hashes { taken, left };

/// Reads a campaign folder, or its campaign.xml, with every table it names (campaign format, version 1).
/// Converts to SI and radians; poses and nests are numbered in order of first appearance, the tables taken in
/// the format's order. Each file is read once, and hashed as it was read (else Campaign::inputs has no hashes). What
/// the format does not know (columns, elements, attributes) is ignored with a warning. Throws InputError for anything
/// the format does not allow, with file, line, column and value: missing or repeated elements, columns and keys,
/// numbers that are none or cannot be meant (angles beyond 720 deg, coordinates beyond 200 m, displacements beyond 1 m,
/// forces and moments beyond 1e6), unknown targets and links, load states without a row in `states`, files outside the
/// folder.
CampaignReading readCampaign(const std::filesystem::path& folder_or_xml, Hashes hashes = Hashes::taken);

}  // namespace stiffscope::campaign
