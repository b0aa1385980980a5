#pragma once

#include <boost/container/small_vector.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/robot/wrench.h"
#include "metrology/remark.h"

namespace stiffscope::identification {

/// The load cell's reading as a wrench in R0 (paper (30)): directed as the flange stands loaded, acting where
/// the cell stands unloaded. Flange poses (base_from_flange) are those measured by the reflectors where there
/// are any, else the model's at `posture`. `reading`: force (N) then moment (Nm) in the load cell's axes.
robot::Wrench cellWrench(const campaign::LoadCell& cell, const frames::LoadingGeometry& geometry,
                         const robot::ArmPosture& posture, const std::optional<Eigen::Isometry3d>& flange_unloaded,
                         const std::optional<Eigen::Isometry3d>& flange_loaded, const Vector6d& reading);

/// The body whose turn directs the load cell's axes: 0 where they stand still, the last where they turn with the
/// flange.
int bodyOfCellAxes(const campaign::LoadCell& cell, const frames::LoadingGeometry& geometry);

/// Readings of one reflector in one state.
struct ReadingSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< in the table's frame, m
  int readings = 0;
  int station = 0;  ///< of `loading`: from which they were read, index into Campaign::stations
  Eigen::Vector3d from = campaign::kStationOfTracker;  ///< where the instrument stood there

  Eigen::Vector3d mean() const { return sum / readings; }
};

/// What the tables say of some load steps, posture by posture: all of a load case that does not depend on the geometry,
/// so that it is gathered once for the many geometries in which an uncertainty asks. Refers to rows of the campaign,
/// which must stay.
class LoadReadings {
 public:
  LoadReadings(const campaign::Campaign& campaign, std::vector<int> steps);

  const std::vector<int>& steps() const { return steps_; }
  std::size_t poses() const { return poses_; }

  /// Of one of the steps, or of 0; null where the posture has none.
  const campaign::State* state(std::size_t pose, int step) const { return states_[at(pose, step)]; }
  /// The posture's largest force in any step, N.
  double largestForce(std::size_t pose) const { return largest_force_[pose]; }
  /// Whether the posture is back at zero in that step while the campaign's other postures are loaded in it: fewer loads
  /// put its return under the number of a load.
  bool backAtZero(std::size_t pose, int step) const;
  /// Of `loading` in that state, by target; empty without the table.
  std::span<const ReadingSum> points(std::size_t pose, int step) const { return of(points_, pose, step); }
  /// Of `displacements` to that step, by target; empty without the table.
  std::span<const ReadingSum> differences(std::size_t pose, int step) const { return of(differences_, pose, step); }

 private:
  /// Place of a step among 0 and the steps; past them where it is none of these.
  std::size_t slot(int step) const;
  std::size_t at(std::size_t pose, int step) const { return slot(step) * poses_ + pose; }
  std::span<const ReadingSum> of(const std::vector<ReadingSum>& table, std::size_t pose, int step) const;

  std::vector<int> steps_;
  std::size_t poses_, targets_;
  std::vector<const campaign::State*> states_;    // by slot, then pose
  std::vector<int> loaded_;                       // those of the steps in which the campaign is loaded
  std::vector<double> largest_force_;             // by pose
  std::vector<ReadingSum> points_, differences_;  // by slot, then pose, then target
};

/// Room for what is gathered a reflector in every load case, without allocation: most flanges carry three.
inline constexpr std::size_t kFewReflectors = 6;

/// One reflector in one load state: means over the repeats, in R0, m.
struct TargetMove {
  int target = 0;
  Eigen::Vector3d unloaded = Eigen::Vector3d::Zero();
  Eigen::Vector3d loaded = Eigen::Vector3d::Zero();
  int unloaded_readings = 0;  ///< 0 where the campaign gives displacements only
  int loaded_readings = 0;
  int station = 0;                                     ///< from which it was read, index into Campaign::stations
  Eigen::Vector3d from = campaign::kStationOfTracker;  ///< where the instrument stood there, R0

  Eigen::Vector3d displacement() const { return loaded - unloaded; }
};

/// One load state of one posture against its unloaded state: what every method starts from. In R0.
struct LoadCase {
  int pose = 0;
  int step = 0;
  JointVector q;         ///< as the controller reports it unloaded, rad
  JointVector servo;     ///< change of the reported angles under load: apart, not subtracted
  JointVector q_sagged;  ///< q with the own weight's sag in: the unloaded arm
  robot::ArmAxes axes;   ///< of the unloaded arm
  /// Where Jacobians of measured points are taken: empty, at the unloaded arm; else at the middle of the
  /// displacement, which makes J c tau the displacement to third order in the deflection.
  std::optional<robot::ArmAxes> middle;
  robot::Wrench wrench;  ///< forces directed as the flange is measured loaded; point where it stands unloaded
  /// Body whose turn under load directs the wrench but is not measured: `wrench` is then directed as at
  /// the unloaded arm, until updateLoadedConfiguration directs it by the model. 0: directed as measured, or by axes
  /// that stand still.
  int wrench_turns_with = 0;
  /// The next two are only meant where that is not 0: the wrench directed as at the unloaded arm, and how the body
  /// stands turned there (ArmPosture::motion).
  robot::Wrench wrench_unturned;
  Eigen::Matrix3d unturned = Eigen::Matrix3d::Identity();
  std::vector<TargetMove> targets;
  bool absolute = false;  ///< unloaded and loaded are measured points, not differences put on the model
  std::optional<Eigen::Isometry3d> flange_unloaded;  ///< base_from_flange by the reflectors (three or more)
  std::optional<Eigen::Isometry3d> flange_loaded;

  /// By hand, so that making many does not set the room in them that nobody fills to zero first.
  LoadCase() {}
};

/// A load state without readings of reflectors, for what asks for torques alone: the wrench is directed as the model's
/// flange stands, or turns with it (wrench_turns_with). `first`: the state whose angles are the unloaded arm's. Step 0
/// has no wrench.
LoadCase caseOfState(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                     const campaign::State& first, const campaign::State& state);

/// The unloaded arm, all its bodies. Not kept in the load case: ten thousand of them would be most of the
/// memory, and few steps need more than the axes.
robot::ArmPosture unloadedPosture(const robot::Robot& arm, const LoadCase& load_case);

/// The axes and the point at which the Jacobian of a reflector is taken.
const robot::ArmAxes& jacobianAxes(const LoadCase& load_case);
Eigen::Vector3d jacobianPoint(const LoadCase& load_case, const Eigen::Vector3d& unloaded,
                              const Eigen::Vector3d& loaded);

/// The load step to identify from where none is asked for: the one with the largest mean force.
/// Empty where no step has a force.
std::optional<int> heaviestStep(const campaign::Campaign& campaign);

/// A posture that is not used.
struct LeftOutPosture {
  std::string pose;  ///< its id
  Remark reason;
};

/// Load cases in one geometry, one after the other. What cases of one posture have in common, the unloaded arm, is
/// computed once for those that ofPose makes. Keeps references.
class LoadCaseMaker {
 public:
  LoadCaseMaker(const campaign::Campaign& campaign, const LoadReadings& readings,
                const frames::LoadingGeometry& geometry);

  /// Fills the case of a posture and step; else says why it has none.
  Remark fill(std::size_t pose, int step, LoadCase& load_case) const;
  /// Those that a posture has, of the readings' steps in their order.
  std::vector<LoadCase> ofPose(std::size_t pose) const;

  /// Whether the campaign has what cases are made from; there are none where not.
  bool any() const { return any_; }

 private:
  struct UnloadedArm;
  Remark fill(std::size_t pose, int step, UnloadedArm& unloaded, LoadCase& load_case) const;

  const campaign::Campaign& campaign_;
  const LoadReadings& readings_;
  const frames::LoadingGeometry& geometry_;
  bool any_ = false, absolute_ = false;
  int turns_with_ = 0;
};

/// The load cases of one of the readings' steps, a posture each, in the order of the campaign's poses. A
/// posture without that step, without an unloaded state or without a common reflector has none, nor has one that is
/// back at zero there (LoadReadings::backAtZero); it is named in `left_out`.
std::vector<LoadCase> loadCases(const campaign::Campaign& campaign, const LoadReadings& readings,
                                const frames::LoadingGeometry& geometry, int step,
                                std::vector<LeftOutPosture>* left_out = nullptr);
std::vector<LoadCase> loadCases(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry, int step,
                                std::vector<LeftOutPosture>* left_out = nullptr);

/// What a campaign lacks to be identified from at all, and what it is needed for; empty where it has joint
/// angles, wrenches and readings under load. A day of sweeps alone lacks these.
Remark whatLoadsLack(const campaign::Campaign& campaign);

/// Mean force of each step that `states` has, 0 among them, N.
std::map<int, double> meanForces(const campaign::Campaign& campaign);

/// The load steps that `states` has, in order; 0, the unloaded one, is none.
std::vector<int> loadSteps(const campaign::Campaign& campaign);

/// The load steps whose mean force is at least 5 % of the largest step's: the others are returns to zero.
std::vector<int> loadedSteps(const campaign::Campaign& campaign);

/// The step to identify from: the one asked for, else the one with the largest mean force.
/// Throws InputError where the campaign has no loads, where it does not have that step (the message lists
/// those it has), or where no step has a force.
int chosenStep(const campaign::Campaign& campaign, const std::optional<int>& asked);

}  // namespace stiffscope::identification
