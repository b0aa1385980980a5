#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/io/units.h"
#include "core/robot/gravity_load.h"
#include "core/robot/robot.h"

// The tables of a campaign, one struct a row, in SI and radians. `target`, `pose` and `nest` are indices into
// the lists of the Campaign; `line` is the row's line in its file, so that a finding can name it.
// A time that the table does not have is NaN.

namespace stiffscope::campaign {

enum class PointFrame { tracker, base_link };

inline constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

/// What a cell holds that an optional column leaves blank, or a row whose table lacks the column.
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Where the instrument stood that took a reading: not a number means at Tracker::station. Whoever joins several
/// stations says it for each reading.
inline const Eigen::Vector3d kStationOfTracker = Eigen::Vector3d::Constant(kNotGiven);

// `station` of a reading is an index into Campaign::stations, 0 where a day has but one. `from` is where the instrument
// stood when the reading was taken, in the frame of its point: its noise is that of the sight from there
// (metrology::TrackerNoise::covarianceAt).

struct CircleReading {
  int axis = 0;  ///< from 0, axis 1
  std::string index;
  int target = 0;
  JointVector q;
  double rail = kNotGiven;  ///< position of the carriage, m; given where the robot has a rail, as below
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double time_s = kNoTime;
  std::size_t line = 0;
  int station = 0;
  Eigen::Vector3d from = kStationOfTracker;
  double carriage = kNotGiven;  ///< as of State
};

struct WristReading {
  std::string index;
  int target = 0;
  JointVector q;
  double rail = kNotGiven;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double time_s = kNoTime;
  std::size_t line = 0;
  int station = 0;
  Eigen::Vector3d from = kStationOfTracker;
  double carriage = kNotGiven;  ///< as of State
};

/// While the carriage of a rail goes along and all joints stand still.
struct RailReading {
  std::string index;
  int target = 0;
  double rail = 0.0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double time_s = kNoTime;
  std::size_t line = 0;
  int station = 0;
  Eigen::Vector3d from = kStationOfTracker;
};

/// A repeat is most often written as a whole number, which then is what a row keeps. Another name is kept as its place
/// in Campaign::repeat_ids, below kNoRepeat: repeatByName makes what is kept of the place, and the place of what is
/// kept.
inline constexpr int kNoRepeat = -1;
inline constexpr int repeatByName(int place) { return kNoRepeat - 1 - place; }

struct LoadingReading {
  int pose = 0;
  int step = 0;
  int repeat = kNoRepeat;
  int target = 0;
  double time_s = kNoTime;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::size_t line = 0;
  int station = 0;
  Eigen::Vector3d from = kStationOfTracker;
};

/// Where a controller states its tool, in a base frame of its own: position (m), and turns about the fixed x, y and z
/// axes in this order (rad). Not a number where it states none.
struct StatedPose {
  Eigen::Vector3d position = Eigen::Vector3d::Constant(kNotGiven);
  Eigen::Vector3d rpy = Eigen::Vector3d::Constant(kNotGiven);

  bool hasPosition() const { return position.allFinite(); }
  bool hasTurn() const { return rpy.allFinite(); }
};

/// What few tables say of a state besides. Not a number where the table does not say.
struct StateExtras {
  JointVector commanded;             ///< joint angles that were commanded, rad
  JointVector motor_side;            ///< motor angles over the gear ratio, rad
  double temperature_c = kNotGiven;  ///< degrees Celsius
  StatedPose tool_pose = {};         ///< by the controller's own kinematics
  /// Of no column: what q was as reported, where it has been referred to the motor's side
  /// (identification/motor_side.h).
  JointVector link_side;

  explicit StateExtras(int joints)
      : commanded(JointVector::Constant(joints, kNotGiven)), motor_side(commanded), link_side(commanded) {}
};

class State {
 public:
  int pose = 0;
  int step = 0;
  double time_s = kNoTime;
  JointVector q;
  double rail = kNotGiven;
  Vector6d wrench_in_cell = Vector6d::Zero();  ///< force (N) then moment (Nm), as the load cell's row says
  /// Of no column: where the carriage stood, m, once readings have been referred to its zero (preparation/rail.h) and
  /// `rail` is 0.
  double carriage = kNotGiven;
  std::size_t line = 0;

  /// Of a machine of so many joints: all at zero, and nothing given that the table need not say.
  explicit State(int joints) : q(JointVector::Zero(joints)) {}
  State(int of_pose, int of_step, double at_s, const JointVector& angles, const Vector6d& wrench)
      : pose(of_pose), step(of_step), time_s(at_s), q(angles), wrench_in_cell(wrench) {}

  bool hasExtras() const { return !extras_.empty(); }
  const StateExtras& extras() const;
  /// To be written: they are made where the state has none.
  StateExtras& extras();

 private:
  std::vector<StateExtras> extras_;  ///< one or none: most days have none, and a day has many states
};

struct Displacement {
  int pose = 0;
  int step = 0;
  int target = 0;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< from step 0, m
  std::size_t line = 0;
  int station = 0;  ///< of no use: a table that names one is refused
};

struct NestReading {
  double time_s = kNoTime;
  int nest = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::size_t line = 0;
  int station = 0;
  Eigen::Vector3d from = kStationOfTracker;
};

/// A table with its frame and its file name (as in campaign.xml).
template <class Row>
struct Table {
  std::string file;
  PointFrame frame = PointFrame::tracker;
  std::vector<Row> rows;
};

using CircleSweeps = Table<CircleReading>;
using WristSweep = Table<WristReading>;
using RailSweep = Table<RailReading>;
using Loading = Table<LoadingReading>;
using States = Table<State>;
using Displacements = Table<Displacement>;
using Nests = Table<NestReading>;

enum class DoubleEncoder { active, inactive, unspecified };

/// One-sigma noise of one tracker reading: along the line of sight range_fixed + range_per_m * distance,
/// across it (each of the two directions) angle_fixed + angle_per_m * distance. m, and m per m.
struct Tracker {
  std::string model;
  double range_fixed = 0.0;
  double range_per_m = 0.0;
  double angle_fixed = 0.0;
  double angle_per_m = 0.0;
  Eigen::Vector3d station = Eigen::Vector3d::Zero();  ///< in the frame of the file's points
  double scale_sigma = 0.0;  ///< standard uncertainty of its scale, common to all readings, a share; 0: not stated
};

/// A place at which the tracker stood during the day. Readings are in its own frame as they are read; joined to the
/// first one's by the nests that stations have in common (core/preparation/join_stations.h), they are in that frame.
struct StationPlace {
  std::string id;  ///< as tables name it; empty: of the rows that name none
  Eigen::Isometry3d first_from_station = Eigen::Isometry3d::Identity();
  /// By the declared noise: of a small rotation (rad) after the pose, and of the displacement at `centre` (m), in the
  /// first station's axes. Zero for the first station.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();

  /// What the pose's uncertainty does to a reading at this point of the first station's frame, m^2: common to all
  /// readings of the station, so that it leaves the difference of two of them as it was but for the turn.
  Eigen::Matrix3d covarianceAt(const Eigen::Vector3d& point_in_first) const;
};

/// A reflector on the tool, rigid with the flange.
struct Target {
  std::string id;
  std::optional<Eigen::Vector3d> position_in_flange;  ///< m; only needed with `displacements`
};

/// Where the wrench in `states` acts and in which axes it is written.
struct LoadCell {
  std::string parent;                                                  ///< link name
  Eigen::Isometry3d parent_from_cell = Eigen::Isometry3d::Identity();  ///< xyz_mm, rpy_deg
  std::optional<std::string> axes_link;  ///< wrench components parallel to this link's axes, rpy ignored
  double force_sigma = 0.0;              ///< N; 0: not stated
  double moment_sigma = 0.0;             ///< Nm; 0: not stated
  double gain_sigma = 0.0;               ///< standard uncertainty of the cell's scale, a share; 0: not stated
  double angle_sigma = 0.0;              ///< of its axes about each of these, rad; 0: not stated
  double point_sigma = 0.0;              ///< of its point along each axis, m; 0: not stated
};

/// A joint's stiffness as it is known from elsewhere: from the maker, from another day.
struct KnownStiffness {
  int joint = 0;           ///< from 0, axis 1
  double stiffness = 0.0;  ///< k, Nm/rad
  double sd = 0.0;         ///< standard uncertainty of k, Nm/rad
  std::string source;
};

/// How a controller's figure of a joint becomes the URDF's angle: q = sign * figure + offset (+ figure of another
/// joint). FANUC's third figure is against the horizontal: plus = 1 there.
struct JointReading {
  int joint = 0;        ///< from 0, axis 1
  double sign = 1.0;    ///< 1 or -1
  double offset = 0.0;  ///< rad
  int plus = -1;        ///< from 0: the joint whose figure is added; -1: none
};

/// What the controller's kinematics are: nominal, or identified by its maker. Such a controller bends its commands
/// under load already, and the arm looks stiffer.
enum class ControllerModel { unspecified, nominal, absolute_accuracy };

/// A file that was read, as the report lists it.
struct InputFile {
  std::string name;    ///< as campaign.xml names it, relative to the folder
  std::string sha256;  ///< of its bytes, hex
};

/// Texts for the report; empty where the campaign does not have them.
struct CampaignTexts {
  std::string laboratory, customer, operator_name, item, conditions;
  std::string robot_serial, controller, tracker_serial, tracker_certificate, load_cell_certificate;
  std::string environment, place, date_of_issue, approved_by, note;

  // In campaign.cpp, for the build's sake as of robot::Robot.
  CampaignTexts();
  CampaignTexts(const CampaignTexts&);
  CampaignTexts(CampaignTexts&&) noexcept;
  CampaignTexts& operator=(const CampaignTexts&);
  CampaignTexts& operator=(CampaignTexts&&) noexcept;
  ~CampaignTexts();
};

/// A text with the name of its element in campaign.xml.
struct NamedCampaignText {
  const char* element;
  std::string CampaignTexts::*text;
};

/// All of them, in the order in which they are written.
inline constexpr std::array kCampaignTexts{
    NamedCampaignText{"laboratory", &CampaignTexts::laboratory},
    NamedCampaignText{"customer", &CampaignTexts::customer},
    NamedCampaignText{"operator", &CampaignTexts::operator_name},
    NamedCampaignText{"item", &CampaignTexts::item},
    NamedCampaignText{"conditions", &CampaignTexts::conditions},
    NamedCampaignText{"robot_serial", &CampaignTexts::robot_serial},
    NamedCampaignText{"controller", &CampaignTexts::controller},
    NamedCampaignText{"tracker_serial", &CampaignTexts::tracker_serial},
    NamedCampaignText{"tracker_certificate", &CampaignTexts::tracker_certificate},
    NamedCampaignText{"load_cell_certificate", &CampaignTexts::load_cell_certificate},
    NamedCampaignText{"environment", &CampaignTexts::environment},
    NamedCampaignText{"place", &CampaignTexts::place},
    NamedCampaignText{"date_of_issue", &CampaignTexts::date_of_issue},
    NamedCampaignText{"approved_by", &CampaignTexts::approved_by},
    NamedCampaignText{"note", &CampaignTexts::note}};

/// One machine in one condition, measured once: what `campaign.xml` and its tables say, in SI and radians.
/// A section that the day did not produce is absent (nullopt).
struct Campaign {
  std::filesystem::path folder;
  std::string name;
  std::string date;
  CampaignTexts texts;

  robot::Robot robot;
  std::string base_link, flange_link;
  DoubleEncoder double_encoder = DoubleEncoder::unspecified;
  std::vector<int> double_encoder_joints;  ///< from 0, rising: which have one, whatever its state; none: not stated
  Eigen::Vector3d gravity_in_base{0.0, 0.0, -9.80665};  ///< m/s^2
  double mass_sigma = 0.0;  ///< standard uncertainty of the URDF's masses, common to all, a share; 0: not stated

  std::optional<Tracker> tracker;
  std::vector<Target> targets;
  std::optional<LoadCell> load_cell;
  std::optional<robot::Tool> tool;
  std::vector<KnownStiffness> known_stiffness;  ///< at most one a joint
  std::vector<JointReading> joint_readings;     ///< at most one a joint; angles in the rows are the URDF's already
  ControllerModel controller_model = ControllerModel::unspecified;

  std::optional<CircleSweeps> circle_sweeps;
  std::optional<WristSweep> wrist_sweep;
  std::optional<RailSweep> rail_sweep;
  std::optional<Loading> loading;
  std::optional<States> states;
  std::optional<Displacements> displacements;
  std::optional<Nests> nests;

  std::vector<std::string> pose_ids;  ///< poses in order of first appearance; tables refer to them by index
  std::vector<std::string> nest_ids;
  std::vector<std::string> repeat_ids;  ///< of `loading`, those that are no whole number (repeatByName)
  std::vector<StationPlace> stations;   ///< none where no table names one: the day has one then
  std::vector<InputFile> inputs;

  /// The state of the double encoder as it matters to this joint: one that is stated to have none is controlled by its
  /// motor alone, as with an inactive one.
  DoubleEncoder doubleEncoderOf(int joint) const {
    const bool has_none =
        !double_encoder_joints.empty() &&
        std::find(double_encoder_joints.begin(), double_encoder_joints.end(), joint) == double_encoder_joints.end();
    return has_none ? DoubleEncoder::inactive : double_encoder;
  }
};

/// By what the pose of a reading's station is uncertain there, m^2; zero for the first station, and of a day of one.
inline Eigen::Matrix3d stationCovariance(const Campaign& campaign, int station, const Eigen::Vector3d& point) {
  if (campaign.stations.empty()) return Eigen::Matrix3d::Zero();
  return campaign.stations[static_cast<std::size_t>(station)].covarianceAt(point);
}

/// A motor's angle over the gear ratio farther than this from its joint's is no wind-up, rad.
inline constexpr double kMotorSideApart = 2.0 * io::kDegree;

/// A later step with a force below this share of its posture's largest is a return to zero (campaign format).
inline constexpr double kReturnShare = 0.05;

}  // namespace stiffscope::campaign
