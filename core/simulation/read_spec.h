#pragma once

#include <filesystem>

#include "core/simulation/spec.h"

namespace stiffscope {

/// Reads a specification (XML). Lengths in mm, angles in deg, the rest SI, as the attribute names say;
/// numbers of one attribute are separated by blanks. [x] is optional, with what holds without it. Paths are
/// relative to the specification.
///
///   simulation   format="1" name date seed (64 bit) [measurement=1: another one draws other noise on the
///   same machine]
///     robot      urdf base_link flange_link [double_encoder=unspecified] [read_back_resolution_deg=0]
///     [joints]   [mass_relative_sigma=0: of the URDF's link masses]
///       joint    index=1..6 [stiffness_nm_per_rad: rigid] [bearing_nm_per_rad, across the axis: rigid]
///     [base]     [rotation_nm_per_rad="x y z": rigid] [tilt_deg=0, against gravity] [tilt_azimuth_deg=0, of
///     the axis tilted
///                about] [tilt_declared=false]
///     [link]...  after_joint=1..6, a beam to the next joint's point; [bending_nm2 (EI)] [torsion_nm2 (GJ)]
///     [shear_n (kGA)]
///                [axial_n (EA)], each: rigid
///     [geometry] [position_sigma_mm=0] [direction_sigma_deg=0] [zero_sigma_deg=0] [wrist_position_sigma_mm:
///     as the others]
///       [axis]... index [offset_mm] [tilt_deg, a rotation vector] [zero_deg]: listed instead of drawn
///     [tool]     mass_kg [com_mm=0 0 0]
///     targets
///       target...  id xyz_mm (true, in the flange)
///     tracker    model [range_fixed_um] [range_per_m_um] [angle_fixed_um] [angle_per_m_um] (one sigma, 0)
///                [true_noise_factor=1] xyz_mm rpy_deg: the true base_from_tracker
///     [load_cell]  parent [xyz_mm] [rpy_deg] force_sigma_n moment_sigma_nm [true_misalignment_deg, a
///     rotation vector]
///                [true_bias_n] [true_bias_nm] [true_gain_error=0]
///     [hanging_load]  masses_kg, one a step; hook_mm in the flange [return_to_zero=true] [repeats=3]; or
///     [cable_load]    tensions_n, one a step; hook_mm; anchor_mm in the base, or [direction]
///     [return_to_zero] [repeats] [postures]
///       [posture]...  q_deg [pull: direction of a cable without anchor, base_link]
///       [draw]   count [candidates=1] min_deg max_deg (six each) [min_abs_sin_q5=0] [max_flange_up_deg]
///       [min_height_mm] [max_height_mm]
///                [min_tracker_distance_mm] [max_tracker_distance_mm] [min_hang_clearance_mm]
///     [circle_sweep]...  axis start_deg stop_deg count [others_deg, six: 0]
///     [wrist_sweep]  readings [scheme=one_target | all_targets] [arm_deg, three: 0] min_deg max_deg (three
///     each) [nests]    [interval_s=3600]
///       nest...  id xyz_mm in the base
///     [times]    [reading_s=2] [move_s=10] [load_change_s=60]
///
/// What each part does is said in spec.h. Throws InputError with file, line, attribute, value and what was
/// expected; unknown elements and attributes are refused, naming the nearest known one.
SimulationSpec readSimulationSpec(const std::filesystem::path& file);

}  // namespace stiffscope
