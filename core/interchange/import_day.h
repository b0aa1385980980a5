#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/interchange/day_files.h"
#include "core/interchange/state_join.h"

namespace stiffscope::interchange {

/// Lines of a file that a row of a table came from. No file that is read has 2^32 of them.
struct RowOrigin {
  std::uint32_t file = 0;  ///< of ImportedDay::files
  std::uint32_t line = 0, last_line = 0;

  RowOrigin(std::size_t of_file, std::size_t first, std::size_t last)
      : file(static_cast<std::uint32_t>(of_file)),
        line(static_cast<std::uint32_t>(first)),
        last_line(static_cast<std::uint32_t>(last)) {}
};

struct SkippedOrigin {
  std::size_t file = 0;
  SkippedRow row;
};

/// A day as a campaign, and where each of its rows came from.
struct ImportedDay {
  campaign::Campaign campaign;
  std::filesystem::path urdf;
  std::vector<ImportedFile> files;
  std::map<std::string, std::vector<RowOrigin>> rows;  ///< by table; of states: the log's lines
  std::vector<RowOrigin> wrenches;  ///< of each row of states, where a file of loads has them; else empty
  std::vector<SkippedOrigin> skipped;
  std::vector<ClockReport> clocks;
  std::vector<std::string> warnings;
  std::map<std::string, double> misfit;  ///< by table, m: state_join.h
  std::string start;  ///< the tracker's date and time at time_s = 0, ISO 8601; empty where its times have no date
  std::optional<double> stated_sigma;          ///< m, median of the files' standard uncertainties, rms of x, y, z
  std::optional<double> stated_over_declared;  ///< the same over the noise declared of the tracker, median
};

/// Reads DAY.xml and every file it names, and joins them. Nothing is written. Throws InputError for anything that
/// cannot be read, joined, or that the campaign format does not allow.
ImportedDay importDay(const std::filesystem::path& day_xml);

}  // namespace stiffscope::interchange
