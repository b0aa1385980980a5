#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/robot/robot.h"
#include "metrology/remark.h"

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

/// One pose of the tool, in the workpiece's frame. The tool's origin is its tip; its z axis leads out of the tool, from
/// the spindle through the tip.
struct PathPose {
  std::string id;
  Eigen::Isometry3d workpiece_from_tool = Eigen::Isometry3d::Identity();
  std::optional<Vector6d> wrench;  ///< on the tool: force, moment about the tip, in the axes of ProcessLoad; N, Nm
  double share = 1.0;              ///< of the process load; 0: the tool does not cut here
};

struct ToolPath {
  std::string file;  ///< for messages
  std::vector<PathPose> poses;
  /// The file gives the tool's axis alone, so that the tool may turn about it. The x axes are then carried along the
  /// path without a turn about z, from an arbitrary first one.
  bool turn_free = false;
  bool has_wrenches = false;  ///< of every pose
};

/// Reads a path from a CSV file: `pose` (any name, not repeated), `x_mm y_mm z_mm` of the tip; the tool's direction as
/// `i j k`, its axis from the tip to the spindle, as in CL data of CAM, or as a quaternion `qw qx qy qz` (workpiece
/// from tool), or neither: then the axis is the workpiece's z; perhaps `fx_n fy_n fz_n mx_nm my_nm mz_nm`, and
/// `load_share`, 0 to 1. Columns in any order. Throws InputError as the campaign's tables do, and where an axis or
/// quaternion is not of length one within 1 %, or both kinds are given; unknown columns go to `warnings`.
ToolPath readToolPath(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The axes in which a process wrench is stated. `feed`: x along the path across the tool's axis, z from the tip to the
/// spindle, y = z x x.
enum class WrenchAxes { workpiece, tool, feed, base_link };

inline constexpr std::array<const char*, 4> kWrenchAxesNames{"workpiece", "tool", "feed", "base_link"};

/// What acts on the tool along a path: in the path's own wrenches, the same everywhere, or by cutting.
struct ProcessLoad {
  WrenchAxes axes = WrenchAxes::workpiece;
  Vector6d constant = Vector6d::Zero();  ///< where the path has no wrenches: force, moment about the tip; N, Nm
  std::optional<Cutting> cutting;        ///< instead
};

/// A load on the tool: force and moment in the workpiece's axes, about a point on the tool.
struct ToolWrench {
  Eigen::Vector3d point_in_tool = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();          ///< N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();         ///< about the point, Nm
  Remark reason;                                            ///< why there is none
};

/// The load at each pose. Feed directions are central differences of the tips; a tip that stands still, or moves along
/// the tool's axis, has that of the pose before, and none before the first that moves.
std::vector<ToolWrench> toolWrenches(const ToolPath& path, const Eigen::Isometry3d& base_from_workpiece,
                                     const ProcessLoad& load);

/// Length along the tips from the first pose to each, m.
std::vector<double> lengthsAlong(const ToolPath& path);

}  // namespace stiffscope::toolpath
