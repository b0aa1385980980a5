#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/mistakes/nominal_fit.h"
#include "core/mistakes/readings_of_day.h"

namespace stiffscope::mistakes {

/// Which wrench a loaded state is taken to have had.
enum class WrenchRow { own, previous_posture, next_posture, previous_step, next_step };

/// How the load cell's rows are to be read: each member as the files have it, or as a mistake would have them meant.
struct CellReading {
  Eigen::Matrix3d on_force = Eigen::Matrix3d::Identity(), on_moment = Eigen::Matrix3d::Identity();
  Eigen::Isometry3d parent_from_cell = Eigen::Isometry3d::Identity();
  std::optional<std::string> axes_link;
  std::string parent;
  WrenchRow row = WrenchRow::own;
  bool moments_first = false;  ///< moments stand in the columns of the forces, and forces in those of the moments
};

CellReading asDeclared(const campaign::LoadCell& cell);

/// The loads against joint springs that only give way, the URDF's arm where the readings have it:
///   d = J_m(q, x) diag(J_w^T W) c,  c >= 0.
struct SpringFit {
  double left = 1.0;         ///< share of the displacements that is left, root mean square
  JointVector compliance;    ///< rad/Nm; empty where nothing was fitted
  double off_gravity = 0.0;  ///< between force and gravity, rms, rad
  double along_lever = 0.0;  ///< share of the moments that no one lever on the tool gives, root mean square
  double lever = 0.0;        ///< its length, m
  // By posture of `poses`: its own share left, angle off gravity, share of the moments.
  std::vector<double> pose_left, pose_off_gravity, pose_along_lever;
  std::map<int, double> step_moves;  ///< by step: its displacements in parts of those of all steps' springs
};

/// All of the loads that does not depend on how the cell is read.
class LoadsOfDay {
 public:
  LoadsOfDay(const ReadingsOfDay& day, const NominalFit& arm);

  bool enough() const { return states_.size() >= 6; }
  const std::vector<int>& poses() const { return poses_; }
  /// Whether forces pull down, where `cell` is what reads them, by the turn about the flange that brings them there
  /// best; in the cell's axes as declared. Empty where no turn does.
  std::optional<Eigen::Matrix3d> turnToGravity(const CellReading& cell) const;
  /// The point of the cell in its parent by which springs explain the loads best, m.
  Eigen::Vector3d bestPoint(const CellReading& cell) const;
  /// The turn about the cell's own axes by which springs explain the loads best, from the one that `cell` has.
  Eigen::Matrix3d bestTurn(const CellReading& cell) const;
  SpringFit fit(const CellReading& cell) const;

  /// The same with the wrenches of two postures exchanged, step by step.
  SpringFit fitExchanged(const CellReading& cell, int pose, int other) const;
  /// The same with the wrenches of one step times a factor.
  SpringFit fitScaled(const CellReading& cell, int step, double factor) const;
  /// The same with one posture read otherwise than the others.
  SpringFit fitAtPose(const CellReading& cell, int pose, const CellReading& there) const;

 private:
  struct Move {
    PointJacobian jacobian;
    Eigen::Vector3d displacement;
  };
  struct State {
    int pose = 0, step = 0;
    std::size_t at = 0;  ///< of its posture in poses_
    robot::ArmPosture posture;
    robot::ArmAxes axes;
    Eigen::Isometry3d flange;
    Vector6d wrench;
    std::vector<Move> moves;
  };
  struct Applied {
    Eigen::Vector3d force, moment, point;
  };

  const State* find(int pose, int step) const;
  /// base_from_link; the flange's where the robot has no such link.
  Eigen::Isometry3d linkOf(const State& state, const std::string& name) const;
  Eigen::Isometry3d parentOf(const State& state, const CellReading& cell) const;
  Eigen::Matrix3d axesOf(const State& state, const CellReading& cell) const;
  template <class ByParameters, class Take>
  void fitCell(CellReading& cell, const ByParameters& by_parameters, const Take& take) const;
  static JointVector torqueOf(const State& state, const Applied& load);
  Applied applied(const State& state, const CellReading& cell, const Vector6d& wrench) const;
  template <class WrenchOf>
  SpringFit fitBy(const WrenchOf& wrench_of) const;

  robot::Robot robot_;
  Eigen::Vector3d down_;
  std::vector<State> states_;
  std::vector<int> poses_;
};

}  // namespace stiffscope::mistakes
