#pragma once

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
#include "core/simulation/machine_spec.h"

// A described machine and the day it is measured, in SI and radians: what read_spec.h reads from XML.
// Everything that is drawn at random is a sigma here; machine.h and simulate.h draw it from `seed`.

namespace stiffscope {

namespace simulation {

/// A reflector that does not stay in its nest when the load (N, its size F) comes on.
struct TargetMotion {
  enum class Kind {
    proportional,  ///< moves by shift F / at_force
    slip,          ///< sits until F reaches at_force, then has moved by shift until the next posture
    compliant,     ///< moves along the force, by compliance F
  };
  Kind kind = Kind::proportional;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< flange axes, m
  double at_force = 1.0;                            ///< N
  double compliance = 0.0;                          ///< m/N
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
  Vector6d ramp = Vector6d::Zero();  ///< shift (m/s) and turn (rad/s), steady
  Vector6d walk = Vector6d::Zero();  ///< the same as a random walk: sigma after one second (m, rad)
  double knot_s = 600.0;             ///< the walk is drawn this often and joined by straight lines
  /// Somebody pushed it, or the robot, after the wrist sweep and before the loading.
  std::optional<Eigen::Isometry3d> tracker_moved;  ///< place before -> place after, tracker axes
  std::optional<Eigen::Isometry3d> robot_moved;    ///< the same, base_link axes; the direction of gravity in
                                                 ///< the robot is kept, nests do not see it
  double scale = 0.0;             ///< distances read / true - 1, from a wrong index of the air
  double scale_per_second = 0.0;  ///< as the hall gets warm
};

struct TrackerSpec {
  Tracker declared;
  Eigen::Isometry3d base_from_tracker = Eigen::Isometry3d::Identity();
  double true_noise_factor = 1.0;  ///< true sigma / declared sigma
};

struct LoadCellSpec {
  LoadCell declared;
  Eigen::Vector3d misalignment =
      Eigen::Vector3d::Zero();       ///< rotation vector, declared axes to true axes, rad
  Vector6d bias = Vector6d::Zero();  ///< added to readings under load (N, Nm; cell axes)
  double gain_error = 0.0;           ///< reading / truth - 1, all six components
  Eigen::Vector3d place_error =
      Eigen::Vector3d::Zero();  ///< true place less declared place, in the declared axes, m
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
  Vector6d q = Vector6d::Zero();
  std::optional<Eigen::Vector3d> pull_direction;  ///< unit, in base_link
};

/// Random postures in a box, by the rules a person at the robot would keep. All judged on the nominal rigid
/// arm.
struct PostureDraw {
  int count = 0;
  int candidates = 1;  ///< of this many that keep the rules, the one farthest from the postures chosen before
  Vector6d low = Vector6d::Zero(), high = Vector6d::Zero();
  double min_abs_sin_q5 = 0.0;
  std::optional<double> max_flange_up;  ///< rad, of the flange's z axis above the horizontal of base_link
  std::optional<double> min_height, max_height;                      ///< of the flange in base_link, m
  std::optional<double> min_tracker_distance, max_tracker_distance;  ///< of the flange, m
  /// The line below the hook stays this far (m, horizontally) from every part of the arm's skeleton below it.
  std::optional<double> min_hang_clearance;
};

struct CircleSweepSpec {
  int axis = 0;  ///< 0..5
  double start = 0.0, stop = 0.0;
  int count = 0;
  Vector6d others = Vector6d::Zero();  ///< where the other axes stand (its own entry plays no part)
};

enum class WristScheme {
  one_target,   ///< the targets one after another, each at postures of its own
  all_targets,  ///< every target at every posture
};

struct WristSweepSpec {
  int readings = 0;  ///< rows in all
  WristScheme scheme = WristScheme::one_target;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();                                  ///< q1..q3
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< q4..q6
};

struct NestSpec {
  std::string id;
  Eigen::Vector3d position_in_base = Eigen::Vector3d::Zero();
};

struct Timing {
  double reading_s = 2.0, move_s = 10.0, load_change_s = 60.0;
  double nest_interval_s = 3600.0;
};

}  // namespace simulation

/// A machine and its measurement. Empty tables: that part of the day did not happen.
struct SimulationSpec {
  std::filesystem::path file;  ///< as read; empty when made in memory
  std::string name, date;
  std::uint64_t seed = 0;  ///< the machine and every posture
  /// Which measurement of that machine: noise is drawn from seed and this, so that two measurements of one
  /// machine (encoders active, inactive) do not share their noise.
  std::uint64_t measurement = 1;

  std::filesystem::path urdf_file;
  Robot nominal;  ///< what urdf_file says
  std::string base_link, flange_link;
  DoubleEncoder double_encoder = DoubleEncoder::unspecified;
  double read_back_resolution = 0.0;  ///< of reported joint angles, rad; 0: as exact as a double

  simulation::MachineSpec machine;
  std::vector<simulation::TrueTarget> targets;
  simulation::TrackerSpec tracker;
  simulation::StationSpec station;
  std::optional<simulation::LoadCellSpec> load_cell;
  std::optional<simulation::LoadingSpec> loading;
  std::vector<simulation::ListedPosture> postures;  ///< before the drawn ones
  std::optional<simulation::PostureDraw> posture_draw;
  std::vector<simulation::CircleSweepSpec> circle_sweeps;
  std::optional<simulation::WristSweepSpec> wrist_sweep;
  std::vector<simulation::NestSpec> nests;
  bool nests_after_sweeps = false;  ///< read once more between wrist sweep and loading
  simulation::Timing timing;
};

namespace simulation {

/// What everything is drawn from that belongs to the measurement and not to the machine.
inline std::uint64_t noiseSeed(const SimulationSpec& spec) {
  // Golden-ratio steps keep the seeds of two measurements apart; the streams mix them further.
  return spec.seed + 0x9e3779b97f4a7c15ULL * spec.measurement;
}

}  // namespace simulation

}  // namespace stiffscope
