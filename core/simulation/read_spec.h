#pragma once

#include <filesystem>
#include <string_view>

#include "core/simulation/spec.h"

namespace stiffscope {

/// Reads a specification (XML). Lengths in mm, angles in deg, the rest SI, as the attribute names say;
/// numbers of one attribute are separated by blanks. [x] may be absent; `=` says what then holds. Paths are
/// relative to the specification. spec.h says what each part does.
///
///   simulation: format="1" name date seed (64 bit)
///       [measurement=1] (another one draws other noise on the same machine)
///   robot: urdf base_link flange_link [double_encoder=unspecified] [read_back_resolution_deg=0]
///   [joints]: [mass_relative_sigma=0] (of the URDF's link masses)
///     joint: index (1..6) [stiffness_nm_per_rad=rigid] [bearing_nm_per_rad=rigid] (across the axis)
///   [base]: [rotation_nm_per_rad=rigid] (about x, y, z) [tilt_declared=false]
///       [tilt_deg=0] (against gravity) [tilt_azimuth_deg=0] (of the axis it is tilted about)
///   [link]...: after_joint (1..6; a beam from this joint's point to the next one's)
///       [bending_nm2=rigid] (EI) [torsion_nm2=rigid] (GJ) [shear_n=rigid] (kGA) [axial_n=rigid] (EA)
///   [geometry]: [position_sigma_mm=0] [direction_sigma_deg=0] [zero_sigma_deg=0]
///       [wrist_position_sigma_mm=position_sigma_mm]
///     [axis]...: index [offset_mm=0] [tilt_deg=0] (rotation vector) [zero_deg=0] (listed, not drawn)
///   [tool]: mass_kg [com_mm=0]
///   targets
///     target...: id xyz_mm (the true place on the flange)
///   tracker: model xyz_mm rpy_deg (the true base_from_tracker) [true_noise_factor=1]
///       [range_fixed_um=0] [range_per_m_um=0] [angle_fixed_um=0] [angle_per_m_um=0] (one sigma)
///   [load_cell]: parent [xyz_mm=0] [rpy_deg=0] force_sigma_n moment_sigma_nm
///       [true_misalignment_deg=0] (rotation vector) [true_bias_n=0] [true_bias_nm=0] [true_gain_error=0]
///   [hanging_load]: masses_kg (one a step) hook_mm (on the flange) [return_to_zero=true] [repeats=3]
///   [cable_load], instead: tensions_n (one a step) hook_mm [anchor_mm] (in the base) or [direction]
///       [return_to_zero=true] [repeats=3]
///   [postures]
///     [posture]...: q_deg [pull] (direction of a cable without anchor, base_link)
///     [draw]: count [candidates=1] min_deg max_deg (six each) [min_abs_sin_q5=0] [max_flange_up_deg]
///         [min_height_mm] [max_height_mm] [min_tracker_distance_mm] [max_tracker_distance_mm]
///         [min_hang_clearance_mm]
///   [circle_sweep]...: axis start_deg stop_deg count [others_deg=0] (six)
///   [wrist_sweep]: readings (rows in all) [scheme=one_target] (or all_targets) [arm_deg=0] (three)
///       min_deg max_deg (three each, axes 4-6)
///   [nests]: [interval_s=3600]
///     nest...: id xyz_mm (in the base)
///   [times]: [reading_s=2] [move_s=10] [load_change_s=60]
///
/// Throws InputError with file, line, attribute, value and what was expected; unknown elements and attributes
/// are refused, naming the nearest known one.
SimulationSpec readSimulationSpec(const std::filesystem::path& file);

/// The same from the bytes of such a file; `file` is its name, and its folder is where the URDF is looked for.
SimulationSpec parseSimulationSpec(std::string_view bytes, const std::filesystem::path& file);

}  // namespace stiffscope
