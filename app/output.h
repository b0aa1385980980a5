#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/campaign/read_campaign.h"
#include "reports/json/json_document.h"

namespace stiffscope {

/// Exit statuses of the command line.
inline constexpr int kDone = 0;
inline constexpr int kNotUsable = 1;  ///< done, but the result does not serve its purpose
inline constexpr int kBadInput = 2;

/// Reads a campaign; its warnings go to standard error.
Campaign openCampaign(const std::string& folder_or_xml, Hashes hashes = Hashes::taken);

/// Those for a result that only the JSON names the inputs of.
inline Hashes hashesFor(const std::string& json_file) { return json_file.empty() ? Hashes::left : Hashes::taken; }

void printWarnings(const std::vector<std::string>& warnings);

/// Print to standard output; throw std::runtime_error with the reason where that fails (a full disk, a closed file). Text may
/// hold names out of a file: what would command a terminal becomes '?'.
void printText(std::string_view text);
void printBytes(std::string_view text);

/// The result: as JSON alone to standard output where `json_file` is `-`; else as text there, and as JSON to the file that
/// is named, if any; std::runtime_error where that file was read. Only what is asked for is made.
void deliver(const std::function<JsonDocument()>& json, const std::function<std::string()>& text, const std::string& json_file);

}  // namespace stiffscope
