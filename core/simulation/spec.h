#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/robot/robot.h"

// How one joint deflects and turns. SI and radians.
// The described machine: how it deflects, how its geometry and masses differ from nominal. SI and radians.
// A described machine and the day it is measured, in SI and radians: what read_spec.h reads from XML.
// Everything that is drawn at random is a sigma here; machine.h and measure.h draw it from `seed`.

namespace stiffscope::simulation {

/// The temperature through a day: stated at times, straight lines between them, constant before the first and after the
/// last.
struct TemperatureCourse {
  std::vector<double> times_s;  ///< rising; at least one
  std::vector<double> celsius;  ///< as many

  double at(double time_s) const;

  /// What follows it with a lag of first order, in balance at time 0: L' = (T - L) / lag, L(0) = T(0). Exact for
  /// straight lines; without a lag T itself.
  double lagged(double time_s, double lag_s) const;
};

/// Friction inside a joint: `sliders` Jenkins elements in parallel, of equal rate, whose limits rise evenly
/// (1 : 2 : ... : n); `torque` is what all of them hold, `rate` what they add while all stick. The motor's
/// motion on the way to a posture works it off: at arrival they carry nothing.
struct JointFriction {
  double torque = 0.0;  ///< Nm
  double rate = 0.0;    ///< Nm/rad
  int sliders = 4;
};

/// Lost motion of the drive: `width` (rad) in all through which only `rest` of the rate is felt. The joint's
/// whole torque crosses it, weight included.
struct JointBacklash {
  double width = 0.0;
  double rest = 0.001;  ///< grease and seals; above 0
};

/// A drive whose rate changes at these torques (a catalogue's T1, T2 and K1, K2, K3).
struct JointStages {
  std::vector<double> torques;  ///< Nm, rising, above 0
  std::vector<double> rates;    ///< Nm/rad, one more; the joint's `torsion` is left aside
};

/// A sum that follows the joint's angle: amplitude sin(cycles q + phase).
struct JointWave {
  double amplitude = 0.0, cycles = 1.0, phase = 0.0;
};

/// A stiffness that falls as the drive gets warm: by `share` of itself, approached as 1 - exp(-t /
/// time_constant) from the first reading of the day.
struct JointSoftening {
  double share = 0.0, time_constant = 0.0;
};

/// A gear apart from the rest of its joint, between the motor and a second encoder on the link side. Under the torque T
/// that it carries, weight included, the link runs ahead of the motor by
///   T / stiffness + lost_motion / 2, the latter in the sense of T,
/// and the other half of the lost motion on the way through 10 Nm either side of T = 0. What the controller holds still
/// is by SimulationSpec::double_encoder: the link side where it is active, else the motor.
struct JointGear {
  double stiffness = 0.0;    ///< Nm/rad
  double lost_motion = 0.0;  ///< rad in all
  // The reading of the motor's side against that of the link's:
  double encoder_sigma = 0.0;   ///< rad, in every state
  double encoder_offset = 0.0;  ///< rad, always
};

/// A gear of another ratio than the controller believes, or one that another joint's motor turns as well (wrist,
/// parallelogram): true motor angle less reported = share times the reported angle of joint `of`.
struct JointRatio {
  double share = 0.0;
  int of = 0;  ///< from 0
};

/// Play between motor and link, `width` (rad) in all. What friction holds, `friction` (Nm, absent: whatever pulls),
/// stays at the side from which the motor came: the link lags behind it by half the width. A larger torque pulls it to
/// the side that the torque says.
struct LostMotion {
  double width = 0.0;
  std::optional<double> friction;
};

/// A belt that slips: from a time of the day on the motor stands elsewhere than reported.
struct ZeroJump {
  double angle = 0.0, from_s = 0.0;  ///< rad, s
};

/// A joint's zero that follows the temperature of the day, less that of its beginning, late by `lag` (s, of first
/// order): warming and cooling have different zeros at one temperature.
struct ZeroWarming {
  double per_kelvin = 0.0, lag = 0.0;  ///< rad/K, s
};

/// How one joint deflects and turns. Absent: it does not. What follows `bearing` needs `torsion`, but for the gear and
/// what follows that.
struct JointStiffness {
  std::optional<double> torsion;  ///< about its axis, Nm/rad; with a gear, of what lies beyond the second encoder
  std::optional<double> bearing;  ///< about each direction across its axis, at the axis's point, Nm/rad
  double cubic = 0.0;             ///< Nm/rad^3, times twist cubed, besides the rest; >= 0
  std::optional<JointStages> stages = std::nullopt;
  std::optional<JointBacklash> backlash = std::nullopt;
  std::optional<JointFriction> friction = std::nullopt;
  std::optional<JointWave> rate_wave = std::nullopt;   ///< of the rate, as a share of it; |amplitude| < 1
  std::optional<JointWave> angle_wave = std::nullopt;  ///< true motor angle less reported, rad
  std::optional<JointSoftening> softening = std::nullopt;
  std::optional<JointGear> gear = std::nullopt;
  std::optional<JointRatio> ratio = std::nullopt;
  std::optional<LostMotion> lost_motion = std::nullopt;
  std::optional<ZeroJump> zero_jump = std::nullopt;
  std::optional<ZeroWarming> zero_warming = std::nullopt;  ///< needs SimulationSpec::temperature
};

/// Gas in a cylinder between two bodies: `pressure` (Pa above the air's) and `volume` with all joints at zero, the
/// absolute pressure times volume^exponent the same at every length.
struct CylinderGas {
  double pressure = 0.0, area = 0.0, volume = 0.0;  ///< Pa, m^2, m^3
  double exponent = 1.0;
  bool pushes = false;  ///< the volume grows as the ends go apart; else it shrinks
};

/// A straight spring between two bodies of the arm (0: the base, i: the body beyond joint i): from carousel
/// to upper arm a gravity compensator, along the forearm a dress pack. With l the distance of its ends and
/// l0 the same at all joints zero of the nominal arm, it pulls them together with
///   T(l) = tension + rate (l - l0),
/// negative where it pushes; gas adds its own pull. Its torque on a joint follows from where its ends stand, hence from
/// the posture.
struct LinkSpring {
  int from_body = 1, to_body = 2;
  Eigen::Vector3d from_in_base_at_zero = Eigen::Vector3d::Zero();  ///< m; must differ from `to`
  Eigen::Vector3d to_in_base_at_zero = Eigen::Vector3d::UnitZ();
  double rate = 0.0;     ///< N/m
  double tension = 0.0;  ///< N, at all joints zero
  std::optional<CylinderGas> gas = std::nullopt;
  bool declared = false;  ///< campaign.xml states it as a balancer: either gas or rate and tension
};

/// The spring with its bodies moved from their nominal places at zero.
struct SpringNow {
  Eigen::Vector3d from, to;  ///< its ends, base_link
  Eigen::Vector3d pull;      ///< N, on `from_body`; minus that on `to_body`
  double energy = 0.0;       ///< J, integral of T from l0 to l
};

SpringNow springNow(const LinkSpring& spring, const PerBody<Eigen::Isometry3d>& body_motions);

/// A link as a uniform straight beam from the point of joint `joint` to that of the next one (after the last:
/// to the flange). Absent: rigid in that respect.
struct LinkBeam {
  int joint = 0;                  ///< from 0
  std::optional<double> bending;  ///< E I, the same in both planes, Nm^2
  std::optional<double> torsion;  ///< G J, Nm^2
  std::optional<double> shear;    ///< kappa G A, N; absent: Euler-Bernoulli, present: Timoshenko
  std::optional<double> axial;    ///< E A, N
};

/// How joint frame i, and all that it carries, differs from nominal: moved by `offset`, turned by the
/// rotation vector `tilt`, base_link axes at all joints zero; and the motor stands at `zero` + the reported
/// angle. The tilt pivots on the axis's point; for the wrist's axes (axes 4-6 of six), where the nominal ones meet, on
/// that meeting point.
struct AxisError {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();    ///< rad
  double zero = 0.0;                                 ///< rad
};

/// Listed errors stand as they are; the other axes' are drawn: offset and tilt in the two directions across
/// the axis, each with its sigma.
struct GeometryErrors {
  double position_sigma = 0.0;   ///< m
  double direction_sigma = 0.0;  ///< rad
  double zero_sigma = 0.0;       ///< rad
  /// m; for the wrist's axes but its first (axes 5 and 6 of six): how far they miss the one before.
  std::optional<double> wrist_position_sigma;
  std::array<std::optional<AxisError>, kMostJoints> listed;  ///< by joint; beyond the last they play no part
};

/// A crack or a shim under the pedestal: beyond `gap` (rad) of turn to one side about base_link x, y or z it
/// rests on something more.
struct OneSidedContact {
  int axis = 0;            ///< 0..2
  bool positive = true;    ///< the side of the turn where it touches
  double stiffness = 0.0;  ///< Nm/rad, besides base_rotation
  double gap = 0.0;        ///< rad
};

/// The plate between flange and everything on it (reflectors, hook, tool), about the flange's origin.
struct ToolPlate {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< along flange x, y, z; N/m
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< about them; Nm/rad
};

/// A plate between flange and reflectors whose screws are loose: it lies in one of two seats, by whether its weight
/// pulls along `direction` or against it. In the second seat it stands `shift` and `turn` away from the first.
struct LoosePlate {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< flange axes, unit; gravity along it: the second seat
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();       ///< flange axes, m
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();        ///< rotation vector about the flange's origin, rad
};

/// Two transmissions that share a spring: it stretches by arms[0] t_a + arms[1] t_b, t the elastic twists of
/// the joints (the motors set its zero), and pulls back with `rate`. A rod of a parallelogram: N/m and crank
/// radii in m. A shaft of a differential wrist: Nm/rad and ratios. Its energy is 1/2 rate stretch^2, so what
/// joint a does to b, b does to a.
struct SharedSpring {
  std::array<int, 2> joints{};  ///< from 0
  std::array<double, 2> arms{};
  double rate = 0.0;
};

/// A link that grows along itself, from the point of joint `joint` to that of the next one: as the day goes on by
/// growth (1 - exp(-t / time_constant)) from the first reading, and by `per_kelvin` times what the temperature of the
/// day has risen since then.
struct ThermalGrowth {
  int joint = 0;                             ///< from 0, not the last
  double growth = 0.0, time_constant = 1.0;  ///< m, s
  double per_kelvin = 0.0;                   ///< m/K; needs SimulationSpec::temperature
};

/// Material that deflects at once only in part: of every change of the elastic coordinates the share `share`
/// comes late, as exp(-t / time_constant) from the change of load.
struct Creep {
  double share = 0.0, time_constant = 0.0;
};

struct MachineSpec {
  PerJoint<JointStiffness> joints;                  ///< of the robot's joints; those that it does not name are rigid
  std::optional<Eigen::Vector3d> base_rotation;     ///< of pedestal and floor about base_link x, y, z; Nm/rad
  std::optional<Eigen::Vector3d> base_translation;  ///< the same along x, y, z; N/m
  std::vector<OneSidedContact> base_contacts;       ///< about axes that base_rotation lets turn
  std::vector<LinkBeam> links;                      ///< in order of joint
  std::optional<ToolPlate> tool_plate;
  std::optional<LoosePlate> loose_plate;
  std::vector<SharedSpring> shared_springs;  ///< between joints with torsion
  std::vector<LinkSpring> link_springs;
  std::vector<ThermalGrowth> growths;
  std::optional<Creep> creep;
  GeometryErrors geometry;
  double mass_relative_sigma = 0.0;  ///< true link mass / the URDF's - 1
  robot::Tool tool;
  double base_tilt = 0.0;          ///< rad, of base_link against gravity
  double base_tilt_azimuth = 0.0;  ///< rad, of the horizontal axis it is tilted about, from base_link +x
  bool base_tilt_declared = false;
};

/// A reflector that does not stay in its nest: when the load (N, its size F) comes on, or by itself.
struct TargetMotion {
  enum class Kind {
    proportional,  ///< moves by shift F / at_force
    slip,          ///< sits until F reaches at_force, then has moved by shift until the next posture
    compliant,     ///< moves along the force, by compliance F
    reseated,      ///< sits elsewhere, by shift, from a time of the day on
    rattling,      ///< in every posture sits in one of two places, shift apart, by chance
  };
  Kind kind = Kind::proportional;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< flange axes, m
  double at_force = 1.0;                            ///< N
  double compliance = 0.0;                          ///< m/N
  double from_s = 0.0;                              ///< of the day
};

struct TrueTarget {
  std::string id;
  Eigen::Vector3d position_in_flange = Eigen::Vector3d::Zero();
  std::optional<TargetMotion> motion = std::nullopt;
};

/// The station after the first reading of the day, in the tracker's axes at its origin. What it does not
/// share with the floor is in every reading, the nests' included; the frame at the first reading is the
/// file's.
struct StationSpec {
  Vector6d ramp = Vector6d::Zero();   ///< shift (m/s) and turn (rad/s), steady
  Vector6d limit = Vector6d::Zero();  ///< the same towards a limit (m, rad): limit (1 - exp(-t / limit_time))
  double limit_time = 3600.0;         ///< s
  Vector6d walk = Vector6d::Zero();   ///< the same as a random walk: sigma after one second (m, rad)
  double knot_s = 600.0;              ///< the walk is drawn this often and joined by straight lines
  bool smooth = false;                ///< joined by a curve without corners instead (Catmull and Rom)
  /// Somebody pushed it, or the robot, at a time of the day; without one after the wrist sweep and before the postures.
  std::optional<Eigen::Isometry3d> tracker_moved;  ///< place before -> place after, tracker axes
  std::optional<Eigen::Isometry3d> robot_moved;    ///< the same, base_link axes; the direction of gravity in
                                                   ///< the robot is kept, nests do not see it
  std::optional<double> tracker_moved_s, robot_moved_s;
  double scale = 0.0;                           ///< distances read / true - 1, from a wrong index of the air
  double scale_per_second = 0.0;                ///< as the hall gets warm
  double scale_step = 0.0, scale_step_s = 0.0;  ///< besides, from a time of the day on: wrong weather
  /// Air in layers bends the beam: a point at a level distance d and a height h above the station is seen higher by
  /// d^2 / 2 (bending + bending_per_m h). 1/m and 1/m^2; a kelvin a metre bends by 1e-6 / m.
  double bending = 0.0, bending_per_m = 0.0;
};

/// Where the tracker is carried to during the loading. Its nests are read before it is taken away and once it stands.
struct LaterStation {
  std::string id;          ///< as tables name it
  int before_posture = 0;  ///< number in the day, from 1: read from here on
  Eigen::Isometry3d base_from_tracker = Eigen::Isometry3d::Identity();
};

struct TrackerSpec {
  campaign::Tracker declared;
  Eigen::Isometry3d base_from_tracker = Eigen::Isometry3d::Identity();
  std::string station;              ///< name of the first one where there are later ones
  std::vector<LaterStation> later;  ///< in the order of the day
  double true_noise_factor = 1.0;   ///< true sigma / declared sigma
};

struct LoadCellSpec {
  campaign::LoadCell declared;
  Eigen::Vector3d misalignment = Eigen::Vector3d::Zero();  ///< rotation vector, declared axes to true axes, rad
  Vector6d bias = Vector6d::Zero();                        ///< added to readings under load (N, Nm; cell axes)
  double gain_error = 0.0;                                 ///< reading / truth - 1, all six components
  Eigen::Vector3d place_error = Eigen::Vector3d::Zero();   ///< true place less declared place, in the declared axes, m
  Eigen::Vector3d unread_force =
      Eigen::Vector3d::Zero();  ///< on the hook in every loaded state but never read (base_link, N)
};

/// Weights hung from a shackle that swings freely: the force is vertical at the hook.
struct HangingWeights {
  std::vector<double> masses_kg;  ///< one a step
};

/// A cable at constant tension, towards a fixed anchor or, without one, in a fixed direction of base_link:
/// the posture's own, else `direction`.
struct CablePull {
  std::vector<double> tensions;              ///< N, one a step
  std::optional<Eigen::Vector3d> anchor;     ///< in base_link, m
  std::optional<Eigen::Vector3d> direction;  ///< unit, in base_link
};

struct LoadingSpec {
  std::variant<HangingWeights, CablePull> load;
  Eigen::Vector3d hook_in_flange = Eigen::Vector3d::Zero();
  bool return_to_zero = true;  ///< a last step without load
  int repeats = 3;             ///< readings of every target in every state
  /// A weight that swings: its force is turned by swing sin(2 pi t / swing_period) about base_link x while
  /// targets are read; the load cell's row is its mean.
  double swing = 0.0;         ///< rad
  double swing_period = 1.0;  ///< s
};

struct ListedPosture {
  JointVector q;
  std::optional<Eigen::Vector3d> pull_direction;  ///< unit, in base_link
};

/// Random postures in a box, by the rules a person at the robot would keep. All judged on the nominal rigid
/// arm.
struct PostureDraw {
  int count = 0;
  int candidates = 1;  ///< of this many that keep the rules, the one farthest from the postures chosen before
  JointVector low, high;
  /// Of the bend of a wrist of three axes, the second of them (joint 5 of six); left aside where the wrist has two.
  double min_abs_sin_bend = 0.0;
  std::optional<double> max_flange_up;           ///< rad, of the flange's z axis above the horizontal of base_link
  std::optional<double> min_height, max_height;  ///< of the flange in base_link, m
  std::optional<double> min_tracker_distance, max_tracker_distance;  ///< of the flange, m
  /// The line below the hook stays this far (m, horizontally) from every part of the arm's skeleton below it.
  std::optional<double> min_hang_clearance;

  /// Of a robot of so many joints, the box without width at zero.
  explicit PostureDraw(int joints) : low(JointVector::Zero(joints)), high(low) {}
};

struct CircleSweepSpec {
  int axis = 0;  ///< from 0
  double start = 0.0, stop = 0.0;
  int count = 0;
  JointVector others;  ///< where the other axes stand (its own entry plays no part); empty: at zero
};

enum class WristScheme {
  one_target,   ///< the targets one after another, each at postures of its own
  all_targets,  ///< every target at every posture
};

struct WristSweepSpec {
  int readings = 0;  ///< rows in all
  WristScheme scheme = WristScheme::one_target;
  JointVector arm;        ///< of the joints before the wrist (robot::armJointsOf); empty: at zero
  JointVector low, high;  ///< of the wrist's joints
};

/// A rail between two supports, on which the carriage bends it: a uniform beam, simply supported and held against
/// twist at both. Positions of the carriage, m.
struct RailBeam {
  double from = 0.0, to = 0.0;                   ///< the supports
  double bending_up = 0.0, bending_level = 0.0;  ///< EI against deflection upwards and level, across the rail; Nm^2
  std::optional<double> torsion;                 ///< GJ, Nm^2; without it the rail does not twist
};

/// The day on a rail (robot::Rail of `nominal`), and how the true carriage differs from what the controller reports.
struct RailSpec {
  double sweeps_at = 0.0;                          ///< where it stands in circle and wrist sweeps, m
  double low = 0.0, high = 0.0;                    ///< of the loaded postures, m
  int stops = 0;                                   ///< of the rail sweep, evenly from low to high; 0: none
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  ///< rotation vector, nominal direction to true, base_link, rad
  double scale = 1.0;                              ///< true travel over what is reported
  double straightness = 0.0;                       ///< amplitude of its wave across the rail, level and upwards, m
  double wave = 4.0;                               ///< length of that wave, m
  std::optional<RailBeam> beam;                    ///< without it the rail does not bend
  double stop_sigma = 0.0;                         ///< by which a stop misses what is reported, along the rail, m
};

struct NestSpec {
  std::string id;
  Eigen::Vector3d position_in_base = Eigen::Vector3d::Zero();
};

struct Timing {
  double reading_s = 2.0, move_s = 10.0, load_change_s = 60.0;
  double nest_interval_s = 3600.0;
};

/// A controller that logs the joint angles before the arm stands still: `after` (s) from when it should have arrived,
/// joint i still lacks exp(-after / time_constants[i]) of the move from the posture before. Reflectors are read later,
/// at rest.
struct EarlyLog {
  double after = 0.0;
  JointVector time_constants;  ///< s

  EarlyLog(double after_s, const JointVector& constants) : after(after_s), time_constants(constants) {}
};

/// A machine and its measurement. Empty tables: that part of the day did not happen.
struct SimulationSpec {
  std::filesystem::path file;  ///< as read; empty when made in memory
  std::string name, date;
  std::uint64_t seed = 0;  ///< the machine and every posture
  /// Which measurement of that machine: noise is drawn from seed and this, so that two measurements of one
  /// machine (encoders active, inactive) do not share their noise.
  std::uint64_t measurement = 1;

  std::filesystem::path urdf_file;
  robot::Robot nominal;  ///< what urdf_file says
  std::string base_link, flange_link;
  campaign::DoubleEncoder double_encoder = campaign::DoubleEncoder::unspecified;
  std::vector<int> double_encoder_joints;  ///< from 0; all with a gear are among them; none: not stated
  double read_back_resolution = 0.0;       ///< of reported joint angles, rad; 0: as exact as a double

  std::optional<EarlyLog> early_log;
  std::optional<TemperatureCourse> temperature;  ///< of the hall; `states` then has it

  MachineSpec machine;
  std::vector<TrueTarget> targets;
  TrackerSpec tracker;
  StationSpec station;
  std::optional<LoadCellSpec> load_cell;
  std::optional<LoadingSpec> loading;
  int unloaded_repeats = 3;             ///< readings of every target in a posture, on a day without a load
  std::vector<ListedPosture> postures;  ///< before the drawn ones
  std::optional<PostureDraw> posture_draw;
  std::vector<CircleSweepSpec> circle_sweeps;
  std::optional<WristSweepSpec> wrist_sweep;
  RailSpec rail;  ///< of a `nominal` with a rail
  std::vector<NestSpec> nests;
  bool nests_after_sweeps = false;  ///< read once more between wrist sweep and loading
  Timing timing;
};

/// What everything is drawn from that belongs to the measurement and not to the machine.
inline std::uint64_t noiseSeed(const SimulationSpec& spec) {
  // Golden-ratio steps keep the seeds of two measurements apart; the streams mix them further.
  return spec.seed + 0x9e3779b97f4a7c15ULL * spec.measurement;
}

}  // namespace stiffscope::simulation
