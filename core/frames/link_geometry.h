#pragma once

#include <array>
#include <optional>

#include "core/frames/base_frame.h"

namespace stiffscope::frames {

/// Distance and angle between two consecutive joint axes at zero.
struct LinkGeometry {
  double distance = 0.0;       ///< m
  double angle = 0.0;          ///< rad, 0..pi/2
  bool near_parallel = false;  ///< within a degree: `distance` is that across the first axis at `at_point`
  Eigen::Vector3d at_point_in_r0 = Eigen::Vector3d::Zero();  ///< on the first axis; only meant for near_parallel
  /// Standard uncertainties by FramesCovariance; empty where an axis was not measured.
  std::optional<double> distance_sd, angle_sd;
  double distance_sag_sd = 0.0;  ///< what of distance_sd comes from the stiffnesses by which the sag was taken off, m
  double distance_by_sag = 0.0;  ///< how far taking off the sag moved the distance, m: an error of its model is of this
  double nominal_distance = 0.0;  ///< of the URDF, by the same rule
  double nominal_angle = 0.0;
};

/// Link i between axes i+1 and i+2 of the arm (paper, II.D: link lengths by circle-point). For axes within a degree of
/// parallel the common perpendicular's place is undetermined: their distance is taken in the plane normal to the first,
/// at the foot on it of the common perpendicular with the axis before (Hayati). Of three axes within a degree of
/// parallel that foot is undetermined too, kilometres away: there the point of the axis before is carried over.
std::array<LinkGeometry, 5> linkGeometry(const robot::Robot& nominal, const ArmInR0& arm);

/// Where on axis `first` the distance to a nearly parallel next one is taken, see linkGeometry.
Eigen::Vector3d hayatiPoint(const std::array<metrology::Line, 6>& axes, std::size_t first);

}  // namespace stiffscope::frames
