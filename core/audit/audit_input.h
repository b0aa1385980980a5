#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/state_points.h"
#include "core/frames/arm_geometry.h"
#include "core/frames/frames.h"
#include "core/identification/loaded_arm.h"
#include "core/mistakes/cell_zero.h"
#include "core/mistakes/controller_agreement.h"
#include "core/mistakes/find_mistakes.h"
#include "core/preparation/prepare.h"
#include "metrology/remark.h"

namespace stiffscope::audit {

/// What one posture's unloaded reflectors say about its reported joint angles, after the common fit.
struct PostureReadBack {
  int pose = 0;
  JointVector correction;         ///< angles that would put the reflectors where they are, rad
  JointVector significance;       ///< each in parts of its uncertainty by the reading noise
  int joint = 0;                  ///< that explains most on its own
  double joint_correction = 0.0;  ///< of that joint alone, rad
  double sag_doubt = 0.0;  ///< of that joint: what a wrong sag, or a spring that is not straight, puts there, rad
  double explained = 0.0;  ///< share of the posture's misfit that joint angles explain
  double score = 0.0;      ///< largest significance in parts of the campaign's own scatter
  bool outlier = false;    ///< score beyond its limit, and more than the sag leaves in doubt

  /// Of an arm of so many joints, whose angles are right as far as is known.
  PostureReadBack(int of_pose, int joints)
      : pose(of_pose), correction(JointVector::Zero(joints)), significance(correction) {}
};

/// What moved while loading went on, as one rigid body: it stands elsewhere from one posture on, or goes steadily from
/// the first posture to the last.
struct MovedMeanwhile {
  enum class Body {
    station,  ///< tracker or robot: one motion in R0
    tool      ///< with all its reflectors on the flange: one motion in the flange
  };

  Body body = Body::station;
  bool steady = false;
  int pose = 0;          ///< the first that was read afterwards, or the last of all
  std::size_t line = 0;  ///< of its first unloaded reading, in the loading's file
  /// Of what was read: rotation vector (rad), then displacement (m) at AbsoluteFit::centre; of the tool at the middle
  /// of its reflectors, both as the flange stands at joints zero.
  Vector6d motion = Vector6d::Zero();
  double by_chance = 0.0;  ///< largest displacement that chance makes, m
  double explained = 0.0;  ///< share of the positions' misfit that goes with it
};

/// A joint that stands, in all of loading, by the same angle from where its reported angle and the sweeps put it.
struct ZeroSinceSweeps {
  int joint = 0;
  double correction = 0.0;    ///< to be added to what is reported, rad
  double displacement = 0.0;  ///< of the reflectors by it, rms, m
  double explained = 0.0;     ///< share of the positions' misfit that goes with it
};

/// Unloaded absolute positions against forward kinematics in the swept geometry, with the arm's own sag. In
/// R0.
///
/// One weighted linear least squares in: a rigid shift of the loading against the sweeps (free), the
/// reflectors' places (free), the axes (4 parameters each, held by the covariance of their sweeps) and
/// the compliances by which the own weight sags (held to a stated share). Where something moved while loading went
/// on, what it moved is taken off first. Postures whose joint angles stand apart are left out.
struct AbsoluteFit {
  bool done = false;
  Remark reason;                                     ///< why not
  bool sag_known = false;                            ///< masses and stiffnesses determine the gravity sag
  int positions = 0;                                 ///< that took part
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mean of the positions
  Vector6d shift = Vector6d::Zero();                 ///< rotation vector (rad) then displacement at `centre` (m)
  Matrix6d shift_covariance = Matrix6d::Zero();
  double shift_chi2 = 0.0;  ///< by which the shift lowers chi2; six degrees of freedom
  double chi2 = 0.0;        ///< with the shift
  int dof = 0;
  double rms_before = 0.0;   ///< plain, per coordinate, m: as the sweeps have it
  double rms_after = 0.0;    ///< with everything fitted
  double score_limit = 0.0;  ///< of PostureReadBack::score
  std::vector<MovedMeanwhile> moves;
  std::optional<ZeroSinceSweeps> zero;
  std::vector<PostureReadBack> postures;
};

/// Not done, with the reason: no declared noise, an axis that was not swept, no loading in the sweeps' frame,
/// or too few positions.
AbsoluteFit fitAbsolutePositions(const campaign::Campaign& campaign, const frames::Frames& frames,
                                 const frames::LoadingGeometry& geometry,
                                 const std::vector<campaign::StatePoints>& states,
                                 const std::optional<metrology::TrackerNoise>& noise);

/// What the checks look at: the campaign as identification sees it.
struct AuditInput {
  const campaign::Campaign& campaign;                        ///< as prepared
  preparation::DriftCorrection drift = {};                   ///< how far it was
  preparation::StationMotion station = {};                   ///< by the nests
  std::optional<preparation::JoinedStations> stations = {};  ///< of a day of several
  std::optional<preparation::RailCourse> rail = {};          ///< by the rail sweep
  preparation::RepeatScatter scatter = {};                   ///< of the repeats, against the declared noise
  /// That of `campaign.tracker`; empty where none is declared.
  std::optional<metrology::TrackerNoise> noise = {};
  std::vector<campaign::StatePoints> states = {};  ///< reflectors in every state of sweeps and loading
  std::optional<int> step = {};                    ///< heaviest load step
  frames::Frames frames = {};                      ///< corrected for the sag where possible
  frames::RigidPoints rigid = {};                  ///< the sweeps' readings, corrected for the sag where possible
  /// In the swept geometry, under `step`; where no sweep places the loading in Partial Pose's, which the unloaded
  /// postures give; no cases where there are none.
  identification::LoadedArm arm = {};
  Remark not_calibrated = {};                     ///< why those do not either; empty where they were not asked
  AbsoluteFit absolute = {};                      ///< unloaded positions against forward kinematics
  mistakes::ModelAgreement model = {};            ///< of the day as a whole, and what would mend it
  mistakes::CellZero zero = {};                   ///< of the load cell, where there is one with states
  mistakes::ControllerAgreement controller = {};  ///< the controller's own poses against the URDF
};

/// `prepared` must outlive the result.
AuditInput auditInput(const preparation::PreparedCampaign& prepared);

}  // namespace stiffscope::audit
