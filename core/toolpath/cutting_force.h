#pragma once

#include <Eigen/Core>

namespace stiffscope::toolpath {

/// Milling with the side of a cutter that turns clockwise as seen from the spindle (right-hand, M3).
struct Cutting {
  double feed = 0.0;            ///< a revolution of the spindle, all teeth together, m
  double depth = 0.0;           ///< along the tool's axis (a_p), m
  double width = 0.0;           ///< across it (a_e), at most the diameter, m
  double diameter = 0.0;        ///< of the cutter, m
  double specific_force = 0.0;  ///< tangential force over the chip's cross-section (k_c, K_tc), Pa
  double radial_ratio = 0.3;    ///< K_rc / K_tc
  double axial_ratio = 0.0;     ///< K_ac / K_tc: what pulls the cutter out of the spindle
  bool up = false;              ///< up milling (conventional); false: down milling (climb)
};

/// What the workpiece does to the tool, mean over a revolution. Axes of the feed: x along it, z along the tool's axis
/// from the tip to the spindle, y = z x x, to the left of the feed.
struct CuttingForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, on the tool's axis half the depth above the tip
  double torque = 0.0;                              ///< about z, Nm: it holds the spindle back
};

/// Mean forces of a cutter whose edges' own rubbing is neglected (Y. Altintas, Manufacturing Automation, 2nd ed. 2012,
/// average milling forces; chip thickness c sin(phi), phi from the left of the feed clockwise):
///   F_x = a f / (8 pi) [K_t cos 2 phi - K_r (2 phi - sin 2 phi)],
///   F_y = a f / (8 pi) [K_t (2 phi - sin 2 phi) + K_r cos 2 phi],
///   F_z = a f / (2 pi) K_a cos phi,      each from phi_start to phi_exit,
///   M   = K_t a w f / (2 pi),
/// a depth, w width, f feed a revolution (number of teeth times feed a tooth), D diameter. Up milling: phi from 0 to
/// acos(1 - 2 w / D); down milling: from pi less that to pi. What varies within a revolution is left out.
CuttingForce meanCuttingForce(const Cutting& cutting);

}  // namespace stiffscope::toolpath
