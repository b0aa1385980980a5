#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/campaign/read_campaign.h"
#include "core/io/write_file.h"
#include "reports/json/json_document.h"

namespace stiffscope::app {

/// Exit statuses of the command line.
inline constexpr int kDone = 0;
inline constexpr int kNotUsable = 1;  ///< done, but the result does not serve its purpose
inline constexpr int kBadInput = 2;

/// Reads a campaign; its warnings go to standard error.
campaign::Campaign openCampaign(const std::string& folder_or_xml, campaign::Hashes hashes = campaign::Hashes::taken);

/// Those for a result that only the JSON names the inputs of.
inline campaign::Hashes hashesFor(const std::string& json_file) {
  return json_file.empty() ? campaign::Hashes::left : campaign::Hashes::taken;
}

void printWarnings(const std::vector<std::string>& warnings);

/// Print to standard output; throw std::runtime_error with the reason where that fails (a full disk, a closed file).
/// Text may hold names out of a file: what would command a terminal becomes '?'.
void printText(std::string_view text);
void printBytes(std::string_view text);

/// The result: as JSON alone to standard output where `json_file` is that (isStandardOutput); else as text there, and
/// as JSON to the file that is named, if any; std::runtime_error where that file was read. Only what is asked for is
/// made.
void deliver(const std::function<reports::JsonDocument()>& json, const std::function<std::string()>& text,
             const std::string& json_file);

/// The same of a text that comes in pieces.
void deliverPieces(const std::function<reports::JsonDocument()>& json, const io::ByteSource& text,
                   const std::string& json_file);

/// Where the result of a computation goes: the command line prints it, the Python module makes objects of it.
struct Outlet {
  /// Takes the result as JSON and as text for a terminal, and makes at once what it wants of the two: what they are
  /// made from lives no longer than this call.
  std::function<void(const std::function<reports::JsonDocument()>& json, const std::function<std::string()>& text)>
      deliver;
  std::function<void(const std::string&)> warn;     ///< of the input, one line
  std::function<void(const std::string&)> explain;  ///< why the result does not serve its purpose, one line
};

/// The command line's: deliver() to `json_file`, the lines to standard error.
Outlet commandLineOutlet(const std::string& json_file);

/// A file that an option names for a result; empty where it was not given.
struct ResultFile {
  std::string option, file;
};

/// Whether a file is where standard output goes: `-`, /dev/stdout, the file that a shell redirects it to.
bool isStandardOutput(const std::string& file);

/// Throws std::runtime_error where two options name one file, or an option other than --json the file that standard
/// output goes to: of two results in it one would be lost.
void requireOwnFiles(const std::vector<ResultFile>& files);

/// JSON as it is written to files, a line a value. Bytes of names that are not UTF-8, which paths may have, become
/// U+FFFD.
std::string textOf(const reports::Json& json);

/// Hands what textOf gives, and a line end, to `sink`, in parts; long lists of it are made and written on all cores, a
/// few thousand rows at a time, so that neither a hundred megabytes of values nor their text stands in memory.
void writeJson(const reports::JsonDocument& document, const io::ByteSink& sink);

}  // namespace stiffscope::app
