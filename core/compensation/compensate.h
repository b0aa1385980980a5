#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/compensation/remarks.h"
#include "core/effects/elastic_arm.h"
#include "core/extended_model/extended_model.h"
#include "core/frames/arm_geometry.h"
#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/robot/wrench.h"
#include "metrology/remark.h"

namespace stiffscope::compensation {

/// Displacement of points of the flange body (R0, unloaded places) under a load by a unit of each parameter, to first
/// order: three rows a point, one column a parameter, m per unit.
using DisplacementByParameters = std::function<Eigen::MatrixXd(
    const JointVector& commands, const effects::FlangeLoad& load, const std::vector<Eigen::Vector3d>& points)>;

/// Of each joint a row, of each draw a column.
using JointDraws = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints, Eigen::Dynamic>;

/// What may be true of the arm instead of its model, a draw each column (Monte Carlo, JCGM 101). All draws are equally
/// likely, and one draw is the same arm in all postures and under all loads: an effect that the day's loads could not
/// see is small in no draw for that reason, and widens the prediction for the loads that rouse it.
struct DeflectionDraws {
  /// c less the model's, rad/Nm; of a draw of springs alone c itself. A joint that the day cannot see is anywhere
  /// between rigid and as weak as the weaker of its neighbours.
  JointDraws compliance;
  /// Of what gives besides joint springs, less the model's. Draw d has those of column d modulo their number, since
  /// some draws differ by their springs alone; one of springs alone has none.
  Eigen::MatrixXd parameters;
  DisplacementByParameters by;  ///< null: the parameters are moves along EffectDeflection::varied
  Eigen::VectorXd load;         ///< error of the wrench's size, a share
  /// How many draws, the last ones, are an arm that gives at joint springs alone: where no model explains the day, half
  /// of them are.
  Eigen::Index springs_alone = 0;
  Eigen::Matrix3Xd model_error;  ///< standard normal numbers, for what the model leaves of a point

  Eigen::Index size() const { return compliance.cols(); }

  /// Adds to `errors`, a draw each row, what its parameters make of coordinates (columns) that a unit of each moves by
  /// `by`, a coordinate each row.
  void addByParameters(const Eigen::MatrixXd& by, Eigen::Ref<Eigen::MatrixXd> errors) const;
};

/// Joint springs alone. `covariance`: of their compliances, scaled to normal numbers (coveringCovariance). `load_sd`:
/// of the load cell's scale. `varied`: further parameters, standard normal and independent.
DeflectionDraws springDraws(const identification::StiffnessEstimate& estimate, const JointMatrix& covariance,
                            double load_sd = 0.0, Eigen::Index varied = 0);

/// The posterior predictive: each draw one of springs and effects together (extended_model/hidden_effects.h) with one
/// of everything else. Where the effects were named by hand, nothing hides, and the draws are those of the fit. `model`
/// must outlive the result.
DeflectionDraws modelDraws(const extended_model::ExtendedModel& model, identification::Method method, double load_sd);

/// What a prediction of three coordinates is uncertain by.
struct PredictionSpread {
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();
  std::array<identification::CoverageInterval, 3>
      interval{};         ///< of the error of each coordinate, at the stated coverage
  double expanded = 0.0;  ///< U: the error is shorter than this at the stated coverage
};

/// Quantiles of one coordinate's errors at the stated coverage, widened to hold zero; NaN where one is.
identification::CoverageInterval intervalOf(const Eigen::Ref<const Eigen::VectorXd>& errors);

/// Of the errors of a prediction, a draw each row: moments about zero, and quantiles widened to hold zero. Not a
/// number where some error is not.
PredictionSpread spreadOf(const Eigen::Ref<const Eigen::MatrixX3d>& errors);

/// The loads and postures that a day's stiffnesses come from, and what the model left of the day's own deflections.
struct IdentifiedRange {
  explicit IdentifiedRange(int joints) : torque(JointVector::Zero(joints)), low(torque), high(torque) {}

  double force = 0.0;        ///< largest, N
  double moment = 0.0;       ///< largest about the wrist, Nm
  JointVector torque;        ///< largest of each joint by the load, Nm
  JointVector low, high;     ///< joint angles, rad
  double model_error = 0.0;  ///< rms per coordinate of a reflector, beyond noise, under the largest load, m
  double tool_size = 0.0;    ///< rms distance of the reflectors from their middle, m
};

/// Of one method's load cases.
///
/// Model error: every posture is left out once (of more than 50, a fiftieth of them at a time), the springs are solved
/// from the others, effects as they are, and s^2 = (sum r^2 - n noise^2) / sum of load^2 over the reflectors' residuals
/// r of postures left out; never below zero. Load: as loadRatio.
IdentifiedRange identifiedRange(const identification::Identification& result, identification::Method method);

/// Where the last two axes come nearest to each other, where they are parallel between them at the last joint: what
/// moments of a load are taken about.
Eigen::Vector3d wristOf(const robot::ArmAxes& axes);

/// How large a load is beside the largest of the day: the larger of the ratios of force and of moment about the wrist.
double loadRatio(const IdentifiedRange& range, const robot::Wrench& wrench, const robot::ArmAxes& axes);

/// A posture and the load-cell reading expected there (as in the `states` table).
struct PostureToCompensate {
  std::string id;
  JointVector q;                               ///< rad
  Vector6d wrench_in_cell = Vector6d::Zero();  ///< N, Nm, in the load cell's axes
  /// Where the load is known by its direction in R0 instead: then the reading plays no part.
  std::optional<effects::FlangeLoad> load = std::nullopt;
};

/// Predicted move of one point of the flange body by the load, loaded less unloaded: R0 axes, m.
struct PointDeflection {
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();                ///< standard uncertainty of each coordinate
  std::array<identification::CoverageInterval, 3> interval{};  ///< of each coordinate, at the stated coverage
  double expanded = 0.0;  ///< U: the point is nearer than this to where it is predicted, at the stated coverage
};

/// Predicted deflection by the load, and the joint commands that cancel it.
struct CompensatedPosture {
  PostureToCompensate posture;
  bool predicted = false;  ///< false: the arm does not come to rest under this load, and nothing below is given
  PointDeflection tcp;     ///< of P_TCP
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< of the flange, rotation vector in R0, rad
  Eigen::Vector3d rotation_sd = Eigen::Vector3d::Zero();  ///< its standard uncertainty, rad
  std::vector<PointDeflection> targets;  ///< of the reflectors, in the order of the campaign's; empty: places not known
  double load_ratio = 0.0;               ///< to the largest load that identified (loadRatio); 0: nothing known of that
  std::vector<Remark> cautions;          ///< what to know of the prediction, refused or not
  bool solved = false;
  Remark reason;                    ///< why there are no commands
  JointVector commands;             ///< joint angles to command, rad
  double mirrored_remaining = 0.0;  ///< |move of P_TCP| left where the predicted turn is subtracted once, m
  double remaining = 0.0;           ///< the same by the commands: |P_TCP(loaded, commands) - P_TCP(unloaded, q)|, m
  /// How the loaded flange stays turned by the commands against the unloaded one, rotation vector in R0, rad. Of six
  /// joints or more it does not.
  Eigen::Vector3d remaining_turn = Eigen::Vector3d::Zero();
  double conditioning = 0.0;  ///< stepConditioning at P_TCP
};

struct CompensateOptions {
  double least_conditioning = 0.01;  ///< below it a posture is too near a singularity
  double share_unknown = 0.02;       ///< of the largest joint torque: what may turn a joint of unusable stiffness

  /// Loads over the largest that identified. Drives are linear within their usual range of torque, and half as much
  /// again changes little; beyond five times gears are in another stage of their curve, and nothing the day showed says
  /// which.
  double load_caution = 1.5, load_most = 5.0;
  /// Joint angles beyond those that identified, rad. A quarter turn puts every part of the arm across the direction
  /// that the load had along it. Of an upright axis 1 there is no limit: turning about it leaves the load on the arm as
  /// it was.
  double posture_caution = 0.26, posture_most = 1.57;
  /// U over the size of the deflection of P_TCP: from one on, commands may do more harm than good.
  double uncertain_caution = 0.5, uncertain_most = 1.0;
  double negligible = 1e-6;       ///< U, m, below which no share matters
  double negligible_turn = 1e-5;  ///< that commands may leave of the flange's turn without a caution, rad
};

/// How far predictions can be trusted: what may be true instead of the model, and what it stands on.
struct Certainty {
  DeflectionDraws draws;
  IdentifiedRange range;
};

/// Of joint springs alone, and of a model with effects (which must outlive the result). `load_sd`: of the load cell's
/// scale, a share.
Certainty certaintyOf(const identification::Identification& result, identification::Method method, double load_sd);
Certainty certaintyOf(const extended_model::ExtendedModel& model, identification::Method method, double load_sd);

/// An identified arm as predictions are made of it. Refers to all of these.
struct DeflectingArm {
  const campaign::Campaign& campaign;
  const frames::LoadingGeometry& geometry;
  const identification::StiffnessEstimate& estimate;  ///< with what is known from elsewhere (known_stiffness.h)
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();
  const effects::EffectDeflection* with = nullptr;  ///< effects of the machine in the model; null: joint springs alone
  const Certainty* certainty = nullptr;             ///< null: what is predicted has no uncertainty but the stiffnesses'
};

/// For each posture: the nonlinear model (finite rotations, own weight and load on the moved arm) gives the
/// loaded pose; Newton steps on the commands bring the loaded flange back onto the pose that the unloaded arm
/// has at q. A load cell's reading acts where the cell stands unloaded and is directed as the flange stands loaded by
/// it, as identification has it; the load keeps that direction. No commands, with
/// the reason, where the posture is outside the joint limits or a command would be, near a singularity, where
/// the steps do not converge, and where more than `share_unknown` of the largest joint torque turns a joint
/// whose stiffness is not known or came out negative. Nor, with `certainty`, far beyond the loads and postures that
/// identified, or where the prediction is as uncertain as it is large; before that there are cautions.
///
/// Six joints bring the flange back in position and orientation. Of more there are many corrections that do, of which
/// the one with the least sum of squares is given. Of fewer the commands bring P_TCP back, and the orientation as far
/// as the remaining freedom allows: `remaining_turn` says what is left, with a caution (jointStep).
///
/// Uncertainty: each draw of the certainty moves a point, to first order, by J diag(tau) (c_draw - c) and the columns
/// of its effects times their parameters; to that comes the error of the wrench's size, and the model error that the
/// day left, times the load's ratio to the day's. Not a number where the stiffnesses' uncertainty is not. Without
/// `certainty` the stiffnesses' covariance is all, and `with`'s.
///
/// `with`: an arm that gives at more than its joint springs takes the place of these.
std::vector<CompensatedPosture> compensate(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                           const identification::StiffnessEstimate& estimate,
                                           const Eigen::Vector3d& tcp_in_flange,
                                           const std::vector<PostureToCompensate>& postures,
                                           const CompensateOptions& options = {},
                                           const effects::EffectDeflection* with = nullptr,
                                           const Certainty* certainty = nullptr);

/// Whether a joint's axis is upright, so that its angle does not change how weights load the arm.
bool turnsFreely(const frames::LoadingGeometry& geometry, int joint);

/// base_from_flange (R0) of the unloaded arm at rest with these commands, bent by its own weight, by the model that
/// `compensate` predicts by. Empty where it does not come to rest.
std::optional<Eigen::Isometry3d> restingFlange(const frames::LoadingGeometry& geometry,
                                               const identification::StiffnessEstimate& estimate,
                                               const effects::EffectDeflection* with, const JointVector& commands);

/// How many postures have commands, and why others have none.
struct CompensationSummary {
  std::size_t asked = 0, compensated = 0;
  std::size_t cautioned = 0;  ///< of those with commands
  /// The first reason of its kind, and how many postures have one of that kind; most frequent first.
  std::vector<std::pair<Remark, std::size_t>> refused;

  /// Whether most postures have no commands.
  bool mostRefused() const { return 2 * compensated < asked || compensated == 0; }
};

CompensationSummary summaryOf(const std::vector<CompensatedPosture>& postures);

/// A remark on each posture whose commands turn a joint by more than 2 deg against its angle: ten times
/// what a heavy load does to a weak joint, so that forces, moments or angles are rather in another unit.
std::vector<Remark> implausibleCommands(const std::vector<CompensatedPosture>& postures);

/// What there is to know of all commands where a machine has not six joints, and some posture has commands; else none.
std::vector<Remark> jointCountRemarks(const std::vector<CompensatedPosture>& postures);

/// Postures as they are given, with joint angles as the campaign's tables have them (the controller's figures, where it
/// declares joint readings): with the URDF's angles in their place.
std::vector<PostureToCompensate> withAnglesOfFigures(std::vector<PostureToCompensate> postures,
                                                     const campaign::Campaign& campaign);

/// Reads postures and wrenches of the campaign's machine from a CSV file: `pose` (any name, not repeated), `q1_deg`,
/// `q2_deg` and so on of each joint, as withAnglesOfFigures takes them, and the load-cell reading expected there, `fx_n
/// fy_n fz_n mx_nm my_nm mz_nm`; columns in any order. Throws InputError as the campaign's tables do; unknown columns
/// go to `warnings`.
std::vector<PostureToCompensate> readPostures(const std::filesystem::path& file, const campaign::Campaign& campaign,
                                              std::vector<std::string>& warnings);

/// Load-cell readings by the name of the posture that they act at.
struct NamedReading {
  std::string id;
  Vector6d wrench_in_cell = Vector6d::Zero();  ///< N, Nm
  std::size_t line = 0;
};

/// Reads them from a CSV file: `pose`, `fx_n fy_n fz_n mx_nm my_nm mz_nm`, as above.
std::vector<NamedReading> readWrenches(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The campaign's own postures in load step `step`.
std::vector<PostureToCompensate> campaignPostures(const campaign::Campaign& campaign, int step);

}  // namespace stiffscope::compensation
