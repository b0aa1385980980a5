#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/interchange/point_formats.h"

namespace stiffscope::interchange {

inline constexpr std::string_view kExportComment = "//";

/// What the comments of SpatialAnalyzer's export say, in whichever language: by structure. Words tell only what a share
/// or sigma is of; where they are of none of the languages known, the coverage is not said.
struct ExportComments {
  std::string frame;                 ///< 'Collection::Frame'
  std::optional<double> unit;        ///< m, in brackets with the axes
  std::string unit_word;             ///< a unit's name that stands elsewhere than with the axes
  std::optional<int> uncertainties;  ///< cells a row has of them; nullopt: the axes are not commented
  double coverage = 0.0;             ///< k, by a number before sigma or % in a comment of uncertainties; 0: not said
};

/// Throws InputError, with the line, for axes that are not Cartesian, a unit that is none, and where exports that were
/// appended to each other state another frame, unit or coverage.
ExportComments exportCommentsOf(const FileText& text);

/// Metres in the unit of the axes. Throws InputError for a unit that the comments name elsewhere, or another than the
/// user's: neither is to be taken for granted.
double statedUnitOf(const FileText& text, const ExportComments& header, std::vector<std::string>& warnings);

}  // namespace stiffscope::interchange
