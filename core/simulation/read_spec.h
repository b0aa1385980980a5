#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// Reads a specification (XML). Lengths in mm, angles in deg, the rest SI, as the attribute names say;
/// numbers of one attribute are separated by blanks. [x] may be absent; `=` says what then holds. Paths are
/// relative to the specification. spec.h says what each part does.
///
///   simulation: format="1" name date seed (64 bit)
///       [measurement=1] (another one draws other noise on the same machine)
///   robot: urdf base_link flange_link [double_encoder=unspecified] [double_encoder_joints] (1 to n)
///       [read_back_resolution_deg=0]
///   [joints]: [mass_relative_sigma=0] (of the URDF's link masses)
///     [joint]...: index (1 to n, the joints of the URDF; one that is not listed is rigid, and `rigidJoints` names it)
///     [stiffness_nm_per_rad=rigid] [bearing_nm_per_rad=rigid] (across the axis)
///         [cubic_nm_per_rad3=0] (times twist cubed, besides)
///       [stages]: torques_nm (rising) stiffness_nm_per_rad (one more; instead of the joint's)
///       [backlash]: width_deg (in all) [rest_share=0.001] (of the stiffness, felt inside)
///       [friction]: torque_nm (held in all) stiffness_nm_per_rad (added while it sticks) [sliders=4]
///       [stiffness_ripple]: share (of the stiffness) [cycles=1] (a turn) [phase_deg=0]
///       [angle_error]: amplitude_deg (true less reported) [cycles=1] [phase_deg=0]
///       [softening]: share (of the stiffness, lost) time_constant_s (as the drive gets warm)
///   [base]: [rotation_nm_per_rad=rigid] (about x, y, z) [translation_n_per_m=rigid] (along them)
///       [tilt_declared=false] [tilt_deg=0] (against gravity)
///       [tilt_azimuth_deg=0] (of the axis it is tilted about)
///     [contact]...: axis (x, y, z) side (positive, negative) stiffness_nm_per_rad (besides, on that side)
///         [gap_deg=0]
///   [link]...: after_joint (1 to n; a beam from this joint's point to the next one's)
///       [bending_nm2=rigid] (EI) [torsion_nm2=rigid] (GJ) [shear_n=rigid] (kGA) [axial_n=rigid] (EA)
///   [geometry]: [position_sigma_mm=0] [direction_sigma_deg=0] [zero_sigma_deg=0]
///       [wrist_position_sigma_mm=position_sigma_mm]
///     [axis]...: index [offset_mm=0] [tilt_deg=0] (rotation vector) [zero_deg=0] (listed, not drawn)
///   [tool]: mass_kg [com_mm=0]
///   [tool_plate]: translation_n_per_m rotation_nm_per_rad
///       (between flange and all that is on it; flange axes)
///   [coupling]...: joints (two) rod_n_per_m crank_mm (two, signed), or shaft_nm_per_rad ratios (two)
///       (a spring that both joints' twists stretch)
///   [spring]...: from_body to_body (0 to n) from_mm to_mm (base_link at all joints zero) [rate_n_per_m=0]
///       [tension_n=0] (at all joints zero): gravity compensator, dress pack
///   [growth]...: after_joint (1 to n-1) growth_mm time_constant_s (of a link, as the day goes on)
///   [creep]: share time_constant_s (of every change under load, late)
///   targets
///     target...: id xyz_mm (the true place on the flange)
///       [motion]: kind (proportional, slip) shift_um (flange axes) at_n, or kind (compliant)
///           compliance_um_per_kn: the reflector leaves its nest under load
///   tracker: model xyz_mm rpy_deg (the true base_from_tracker) [true_noise_factor=1]
///       [range_fixed_um=0] [range_per_m_um=0] [angle_fixed_um=0] [angle_per_m_um=0] (one sigma)
///       [station] (its name, where there are later ones)
///     [later_station]...: station before_posture (number in the day, from 2) xyz_mm rpy_deg (where it is carried to
///     then)
///   [load_cell]: parent [xyz_mm=0] [rpy_deg=0] force_sigma_n moment_sigma_nm
///       [true_misalignment_deg=0] (rotation vector) [true_bias_n=0] [true_bias_nm=0] [true_gain_error=0]
///       [true_place_error_mm=0] (true less declared place, cell axes)
///       [unread_force_n=0] (base_link; on the hook in every loaded state, past the cell)
///   [station] (after the first reading, the tracker's axes)
///     [drift]: [ramp_mm_per_h=0] [ramp_deg_per_h=0] [walk_mm_per_sqrt_h=0] [walk_deg_per_sqrt_h=0]
///         (three each) [knot_s=600] (the walk is drawn this often)
///     [tracker_moved] [robot_moved]: [xyz_mm=0] [rpy_deg=0] (once, between wrist sweep and loading)
///     [refraction]: [scale_ppm=0] [scale_ppm_per_h=0] (distances read too long)
///   [hanging_load]: masses_kg (one a step) hook_mm (on the flange) [return_to_zero=true] [repeats=3]
///     [swing]: angle_deg period_s (of the weight, about base_link x)
///   [cable_load], instead: tensions_n (one a step) hook_mm [anchor_mm] (in the base) or [direction]
///       [return_to_zero=true] [repeats=3]
///   [postures]
///     [posture]...: q_deg [pull] (direction of a cable without anchor, base_link)
///     [draw]: count [candidates=1] min_deg max_deg (n each)
///         [min_abs_sin_q5=0] (of the bend of a wrist of three axes) [max_flange_up_deg]
///         [min_height_mm] [max_height_mm] [min_tracker_distance_mm] [max_tracker_distance_mm]
///         [min_hang_clearance_mm]
///   [circle_sweep]...: axis start_deg stop_deg count [others_deg=0] (n)
///   [wrist_sweep]: readings (rows in all) [scheme=one_target] (or all_targets) [arm_deg=0] (one a joint
///       before the wrist) min_deg max_deg (one a joint of the wrist)
///   [rail] (of a URDF with a prismatic joint before all others): [sweeps_at_mm=0] [min_mm=0] [max_mm=min_mm] (of the
///       loaded postures) [stops=0] (of a rail sweep between those) [tilt_deg=0] (rotation vector, nominal to true)
///       [scale_error=0] (true travel over the reported, less 1) [straightness_um=0] [wave_mm=4000] (across the rail)
///       [stop_sigma_um=0] (along it)
///     [beam]: from_mm to_mm (positions of the supports) bending_up_nm2 bending_level_nm2 [torsion_nm2]
///   [nests]: [interval_s=3600] [after_sweeps=false] (read once more between wrist sweep and loading)
///     nest...: id xyz_mm (in the base)
///   [times]: [reading_s=2] [move_s=10] [load_change_s=60]
///
/// Throws InputError with file, line, attribute, value and what was expected; unknown elements and attributes
/// are refused, naming the nearest known one.
SimulationSpec readSimulationSpec(const std::filesystem::path& file);

/// The same from the bytes of such a file; `file` is its name, and its folder is where the URDF is looked for.
SimulationSpec parseSimulationSpec(std::string_view bytes, const std::filesystem::path& file);

/// The joints (from 1) to which a specification gives no stiffness about their axes: what is taken for them is rigid,
/// which a user may not have meant.
std::vector<int> rigidJoints(const SimulationSpec& spec);

}  // namespace stiffscope::simulation
