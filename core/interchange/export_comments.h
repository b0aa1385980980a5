#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/interchange/point_formats.h"

namespace stiffscope::interchange {

inline constexpr std::string_view kExportComment = "//";

/// The axis, 0 to 2, of each of three columns.
using AxisOrder = std::array<int, 3>;
inline constexpr AxisOrder kUsualOrder{0, 1, 2};

/// What the comments of SpatialAnalyzer's export say, in whichever language: by structure. Words tell only what a share
/// or sigma is of; where they are of none of the languages known, the coverage is not said.
struct ExportComments {
  std::string frame;                 ///< 'Collection::Frame'
  std::optional<double> unit;        ///< m, in brackets with the axes
  std::string unit_word;             ///< a unit's name that stands elsewhere than with the axes
  std::optional<int> uncertainties;  ///< cells a row has of them; nullopt: the axes are not commented
  double coverage = 0.0;             ///< k, by a number before sigma or % in a comment of uncertainties; 0: not said
  /// As the comment of the axes lists them: {1, 0, 2} of "Y, X, Z". nullopt: not listed, x y z; of uncertainties, as
  /// their coordinates.
  std::optional<AxisOrder> axes, uncertainty_axes;
};

/// Throws InputError, with the line, for axes that are not Cartesian, have a sign or are in an order that is not clear,
/// a unit that is none, and where exports that were appended to each other state another frame, unit, coverage or order
/// of axes.
ExportComments exportCommentsOf(const FileText& text);

/// Metres in the unit of the axes. Throws InputError for a unit that the comments name elsewhere, or another than the
/// user's: neither is to be taken for granted.
double statedUnitOf(const FileText& text, const ExportComments& header, std::vector<std::string>& warnings);

}  // namespace stiffscope::interchange
