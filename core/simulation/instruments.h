#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/numerics/random.h"
#include "core/simulation/equilibrium.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The wrench of the load on the machine at the declared place of the load cell, as it stands on the loaded,
/// deformed arm: w = (R' F, R' ((p_load - p_cell) x F)), R and p_cell the cell's axes and point in base_link,
/// carried by its parent link, F what of the load's force the cell sees. `place_error` moves p_cell in its
/// own axes from where it is declared. Force (N) then moment (Nm) about the cell's point, cell axes. Weight
/// of arm and tool plays no part: the reading is tared. `parent` is the nominal link that carries the cell.
Vector6d loadWrenchInCell(const ElasticMachine& machine, const MachineState& state, const robot::LinkFrame& parent,
                          const campaign::LoadCell& cell, const Eigen::Vector3d& place_error = Eigen::Vector3d::Zero());

/// Turns true wrenches into readings: seen in axes turned by `misalignment`, times (1 + gain_error), plus
/// `bias` where there is a load (a row that is not exactly zero: the unloaded reading is tared), plus noise
/// of the declared sigmas in every row (stream "load cell").
void addLoadCellErrors(const LoadCellSpec& cell, std::uint64_t noise_seed, campaign::States& states);

/// Adds offset and noise of the second encoders (JointGear) to the motor-side angles: stream "encoders".
void addEncoderErrors(const PerJoint<JointStiffness>& joints, std::uint64_t noise_seed, campaign::States& states);

/// Where the tracker stands through the day, and what it makes of a true point.
class Station {
 public:
  /// The walk's knots (stream "station walk") depend on the measurement: they are of the day, not the
  /// machine.
  explicit Station(const SimulationSpec& spec);

  /// From now on it stands there.
  void stand(const Eigen::Isometry3d& base_from_tracker) { tracker_from_base_ = base_from_tracker.inverse(); }

  void startLoading() { loading_ = true; }  ///< whatever was pushed before the loading has been pushed

  /// The reading of a point of the robot, or of one of the floor, given in the ground's base_link.
  Eigen::Vector3d readRobot(const Eigen::Vector3d& point_in_base, double time_s) const;
  Eigen::Vector3d readFloor(const Eigen::Vector3d& point_in_base, double time_s) const;

  /// Shift and turn of the station since the first reading, its own axes; ramp and walk, no push.
  Vector6d wandered(double time_s) const;

 private:
  Vector6d walked(double time_s) const;
  bool moved(const std::optional<double>& at_s, double time_s) const;
  Eigen::Vector3d bentUp(const Eigen::Vector3d& point) const;  ///< how much higher air in layers shows it

  StationSpec spec_;
  Eigen::Isometry3d tracker_from_base_;
  Eigen::Vector3d station_;
  std::vector<Vector6d> knots_;  ///< the walk at knot_s * index
  bool still_ = true, loading_ = false;
};

/// How far the reflectors have left their nests, in one posture, through its loads in their order.
class ReflectorSeats {
 public:
  /// `posture`: its number in the day, by which rattling reflectors fall into one seat or the other (stream of the
  /// measurement, one a reflector).
  ReflectorSeats(const SimulationSpec& spec, int posture);

  /// Shifts of the targets (flange axes, m) once this force of the load on the tool (flange axes, N) is on, at a time
  /// of the day.
  const std::vector<Eigen::Vector3d>& under(const Eigen::Vector3d& force_in_flange, double time_s);

 private:
  const std::vector<TrueTarget>& targets_;
  std::vector<bool> slipped_, rattled_;
  std::vector<Eigen::Vector3d> shifts_;
};

/// One draw of a tracker reading's error (m, tracker frame) at a true point of that frame. With d the
/// distance from the station: normal along the line of sight with sigma factor (range_fixed + range_per_m d),
/// and across it in two directions at right angles with sigma factor (angle_fixed + angle_per_m d) each, all
/// independent. `factor` is true sigma over declared sigma. Takes three numbers from the stream: along,
/// across, across.
Eigen::Vector3d trackerError(const campaign::Tracker& tracker, double factor, const Eigen::Vector3d& point,
                             numerics::RandomStream& random);

/// Adds an error of its own to every point of the campaign's tables (tracker frame): streams "tracker
/// sweeps", "tracker wrist", "tracker rail", "tracker loading" and "tracker nests" of `noise_seed`.
void addTrackerNoise(double factor, std::uint64_t noise_seed, campaign::Campaign& campaign);

}  // namespace stiffscope::simulation
