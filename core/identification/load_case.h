#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/identification/load_readings.h"
#include "core/identification/loading_geometry.h"
#include "core/statics/wrench.h"

namespace stiffscope {

/// One reflector in one load state: means over the repeats, in R0, m.
struct TargetMove {
  int target = 0;
  Eigen::Vector3d unloaded = Eigen::Vector3d::Zero();
  Eigen::Vector3d loaded = Eigen::Vector3d::Zero();
  int unloaded_readings = 0;  ///< 0 where the campaign gives displacements only
  int loaded_readings = 0;

  Eigen::Vector3d displacement() const { return loaded - unloaded; }
};

/// One load state of one posture against its unloaded state: what every method starts from. In R0.
struct LoadCase {
  int pose = 0;
  int step = 0;
  Vector6d q = Vector6d::Zero();         ///< as the controller reports it unloaded, rad
  Vector6d servo = Vector6d::Zero();     ///< change of the reported angles under load: apart, not subtracted
  Vector6d q_sagged = Vector6d::Zero();  ///< q with the own weight's sag in: the unloaded arm
  ArmAxes axes;                          ///< of the unloaded arm
  /// Where Jacobians of measured points are taken: empty, at the unloaded arm; else at the middle of the
  /// displacement, which makes J c tau the displacement to third order in the deflection.
  std::optional<ArmAxes> middle;
  Wrench wrench;  ///< forces directed as the flange is measured loaded; point where it stands unloaded
  /// Body whose turn under load directs the wrench but is not measured: `wrench` is then directed as at
  /// the unloaded arm, until settleLoads directs it by the model. 0: directed as measured, or by axes that
  /// stand still.
  int wrench_turns_with = 0;
  /// The next two are only meant where that is not 0: the wrench directed as at the unloaded arm, and how the body stands
  /// turned there (ArmPosture::motion).
  Wrench wrench_unturned;
  Eigen::Matrix3d unturned = Eigen::Matrix3d::Identity();
  std::vector<TargetMove> targets;
  bool absolute = false;  ///< unloaded and loaded are measured points, not differences put on the model
  std::optional<Eigen::Isometry3d> flange_unloaded;  ///< base_from_flange by the reflectors (three or more)
  std::optional<Eigen::Isometry3d> flange_loaded;
};

/// The unloaded arm, all its bodies. Not kept in the load case: ten thousand of them would be most of the
/// memory, and few steps need more than the axes.
ArmPosture unloadedPosture(const Robot& arm, const LoadCase& load_case);

/// The axes and the point at which the Jacobian of a reflector is taken.
const ArmAxes& jacobianAxes(const LoadCase& load_case);
Eigen::Vector3d jacobianPoint(const LoadCase& load_case, const Eigen::Vector3d& unloaded,
                              const Eigen::Vector3d& loaded);

/// The load step to identify from where none is asked for: the one with the largest mean force.
/// Empty where no step has a force.
std::optional<int> heaviestStep(const Campaign& campaign);

/// The load cases of one of the readings' steps, a posture each, in the order of the campaign's poses. A
/// posture without that step, without an unloaded state or without a common reflector has none, and is named
/// in `left_out`.
std::vector<LoadCase> loadCases(const Campaign& campaign, const LoadReadings& readings,
                                const LoadingGeometry& geometry, int step,
                                std::vector<std::string>* left_out = nullptr);
std::vector<LoadCase> loadCases(const Campaign& campaign, const LoadingGeometry& geometry, int step,
                                std::vector<std::string>* left_out = nullptr);

}  // namespace stiffscope
