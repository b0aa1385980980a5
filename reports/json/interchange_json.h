#pragma once

#include <string>
#include <vector>

#include "core/interchange/import_day.h"
#include "core/interchange/point_reading.h"
#include "core/io/write_file.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// A file of points with its name as the user gave it.
struct NamedPoints {
  std::string file;
  interchange::PointFile points;
};

/// What a file of points says: format, encoding, frame, points (collection, group, name, occurrence, xyz_m, u_m:
/// standard uncertainties, time: ISO 8601, or seconds of a clock without a date, line), skipped (line, reason). What
/// the file does not say is null. The file has to live as long as the document.
JsonDocument pointsJson(const interchange::PointFile& file);

/// Contents of one file; of several `files`, with `file` in each.
JsonDocument pointsJson(const std::vector<NamedPoints>& files);

/// import.json beside an imported campaign: `start` (the tracker's date and time at time_s = 0), `files` (name, role,
/// format, encoding, sha256), `clocks` (log, offset_s of the robot's clock against the tracker's, uncertainty_s: the
/// offset lies within it, stated, readings, inside, standstills, misfit_mm), `misfit_mm` by table (distances between
/// the reflectors' places against the nominal arm's), `stated_sigma_um` (median standard uncertainty that the
/// files state), `stated_over_declared` (that over the declared noise), `rows` by table (a list for each of its
/// rows, in order: file, by its place in `files`, line, last_line), `wrenches` (the origin of the rows of states, where
/// a file of loads has them), `skipped` (file, line, reason), `warnings`. The day has to live as
/// long as the document.
JsonDocument importJson(const interchange::ImportedDay& day);

/// The same for a terminal, without the rows.
std::string importText(const interchange::ImportedDay& day);

/// The same for a terminal: what the file is, and a line a point.
/// Handed on in pieces of whole lines: of a large file it is longer than the file.
void pointsText(const std::vector<NamedPoints>& files, const io::ByteSink& sink);

}  // namespace stiffscope::reports
