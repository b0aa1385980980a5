#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/frames/arm_parameters.h"

namespace stiffscope::calibration {

/// Which angles of the log the arm is taken to have stood at.
enum class JointAngles {
  reported,
  commanded,  ///< of joints that have them in every unloaded posture; of the others the reported
};

/// One reflector in one unloaded posture: the mean of its readings.
struct Reading {
  int target = 0;
  std::size_t line = 0;                             ///< of its first reading in the table
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, in the frame of the table
  /// By the declared tracker, m^2; zero: not declared. What its station's pose is uncertain by is not in it: it is
  /// common to all that was read from there (UnloadedDay::stations).
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Where the instrument stood, in the frame of the table; not a number: at UnloadedDay::station.
  Eigen::Vector3d from = campaign::kStationOfTracker;
  int place = 0;  ///< of UnloadedDay::stations
};

struct Posture {
  int pose = 0;
  JointVector q;        ///< as reported, rad
  JointVector move;     ///< q less that of the state before in `states`; zero for the first
  JointVector side;     ///< -1 or +1: sign of the joint's last move; 0 where it has not moved yet
  JointVector torque;   ///< of the own weight on the joints of the nominal arm, Nm; zero: no masses; see letSag
  double warmth = 0.0;  ///< temperature less the day's mean, K; 0 where it is not given
  double time = 0.0;    ///< 0 at the first posture, 1 at the last: by time_s, else by the order
  /// What bearings, links and base do by the own weight, by a unit of each of the day's elastic terms, in base_link.
  std::vector<frames::SmallMotion> bends;
  /// Where masses are not known: the torque of a unit of each of the day's free moments on its joint, m/s^2.
  std::vector<double> pulls;
  std::vector<Reading> readings;

  /// Of an arm of so many joints, all at zero.
  explicit Posture(int joints) : q(JointVector::Zero(joints)), move(q), side(q), torque(q) {}
};

/// One compliance of the arm's structure that its own weight bends.
struct BendingTerm {
  std::size_t effect = 0;  ///< index in effects::kEffectIds
  std::string detail, name, unit;
  double most = 0.0;      ///< physical bound of its magnitude
  bool coupling = false;  ///< of two compliances of `detail`, of either sign; else never negative
};

/// Where masses are not known: the moment (mass times centre, kg m) along one axis of base_link, with all joints at
/// zero, of a body that one joint carries. Only its product with that joint's compliance is seen.
struct FreeMoment {
  int joint = 0, body = 0;  ///< from 0: the joint, and the one that moves the body
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
};

/// A day's unloaded postures (step 0) in the order of time_s (where one has none, of the campaign's rows), with what
/// effects of them are made of. Lengths m, angles rad. `arm` is the URDF's in base_link.
struct UnloadedDay {
  robot::Robot arm;
  JointAngles angles = JointAngles::reported;
  robot::GravityLoad weight;
  bool masses_known = false;       ///< of every body that carries others on joints, see robot::gravityLoad
  bool times_known = false;        ///< every posture has one; else their order stands for time
  bool temperature_known = false;  ///< of every posture, and it changes
  double first_time_s = 0.0, time_span_s = 0.0;
  std::vector<std::string> targets;
  std::vector<std::string> pose_ids;
  std::vector<BendingTerm> bending;
  std::vector<FreeMoment> free_moments;
  Eigen::Vector3d station = Eigen::Vector3d::Zero();  ///< of the tracker, in the frame of the table
  std::vector<campaign::StationPlace> stations;       ///< of a day of several: as they were joined
  std::vector<Posture> postures;

  std::size_t readings() const;
  const Eigen::Vector3d& stationOf(const Reading& reading) const {
    return reading.from.allFinite() ? reading.from : station;
  }
};

/// Postures of `loading` at step 0 that `states` has joint angles for. Empty `postures` without either table.
UnloadedDay unloadedDay(const campaign::Campaign& campaign, JointAngles angles = JointAngles::reported);

/// What gives under the own weight.
struct OwnCompliances {
  JointVector joints;       ///< rad/Nm
  Eigen::VectorXd bending;  ///< of each of UnloadedDay::bending; empty: rigid
};

/// Takes the own weight's torques, and what links, bearings and base do by it, where these compliances let the arm sag
/// to (effects::gravityEquilibrium), in place of where its angles say. Else a weight that pulls the harder the farther
/// it has sunk would pass for a softer joint or bearing: joint 2 of a heavy arm by a fifth of a per cent, the bearing
/// below a tall arm by three. Where masses are not known nothing changes.
void letSag(const OwnCompliances& own, UnloadedDay& day);

/// Joints with a commanded angle in every unloaded row of `states`.
PerJoint<bool> commandedJoints(const campaign::Campaign& campaign);

}  // namespace stiffscope::calibration
