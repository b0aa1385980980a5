#include <fmt/format.h>
#include <map>

#include "reports/json/interchange_json.h"
#include "reports/words/interchange_words.h"

namespace stiffscope::reports {

namespace {

std::string clockText(const interchange::ClockReport& clock, const std::string& start) {
  std::string text =
      start.empty()
          ? fmt::format("{}: the robot's clock is ahead of the tracker's by {:.3f} s", clock.log, clock.offset_s)
          : fmt::format("{}: at the tracker's {} the robot's clock shows {:.3f} s", clock.log, start, clock.offset_s);
  text += clock.stated ? ", as stated" : fmt::format(" +- {:.3f} s (limits)", clock.uncertainty_s);
  return text + fmt::format(";\n  {} of {} readings fall into its {} standstills\n", clock.inside, clock.readings,
                            clock.standstills);
}

}  // namespace

std::string importText(const interchange::ImportedDay& day) {
  std::string text = day.campaign.name + '\n';
  for (const auto& [table, rows] : day.rows) {
    text += fmt::format("  {:<14}{:>7} rows", table, rows.size());
    const auto misfit = day.misfit.find(table);
    if (misfit != day.misfit.end())
      text += fmt::format("; distances between the reflectors' places are off by {:.1f} mm from the nominal arm's",
                          1e3 * misfit->second);
    text += '\n';
  }
  for (const interchange::ClockReport& clock : day.clocks) text += clockText(clock, day.start);
  if (day.stated_over_declared)
    text += fmt::format("The uncertainties in the files, {:.1f} µm, are {:.2g} times the declared noise (medians).\n",
                        1e6 * *day.stated_sigma, *day.stated_over_declared);
  std::map<std::string, std::size_t> left_out;
  for (const interchange::SkippedOrigin& row : day.skipped)
    ++left_out[fmt::format("{}: {}", day.files[row.file].name, skipWords(row.row.reason))];
  for (const auto& [reason, count] : left_out) text += fmt::format("Left out, {} rows of {}\n", count, reason);
  return text;
}

}  // namespace stiffscope::reports
