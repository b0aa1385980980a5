#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/effects/arm_state.h"
#include "core/effects/effect.h"
#include "core/effects/remarks.h"
#include "metrology/remark.h"

namespace stiffscope::effects {

struct EffectModel;

/// An effect in the model, with its size. The model must outlive it.
struct PresentEffect {
  const EffectModel* model = nullptr;
  Eigen::VectorXd parameters;
};

/// The day on a rail as the models of effects need it.
struct RailTravel {
  double mean = 0.0;         ///< of the carriage's positions r over the postures, m
  double scale = 1.0;        ///< half of what lies between the outermost, m
  double mean_square = 0.0;  ///< of x = (r - mean) / scale over the postures
  /// Readings are referred to the carriage at zero by the straight line through a sweep of the rail. What moves the
  /// reflectors there by x and by x^2 - mean_square alike in all postures is in that line, by so much a metre.
  double line_by_x = 0.0, line_by_square = 0.0;
  robot::Wrench weight_at_sweep;                                  ///< own weight on the carriage in that sweep, R0
  Eigen::Vector3d reflectors_at_sweep = Eigen::Vector3d::Zero();  ///< their mean with the carriage at zero, R0
};

/// What the models of the effects are linearised at. Effects that multiply another unknown (a wrong load
/// point times a compliance) or bend with their own size (friction) take that other one from here and are
/// fitted again and again.
struct LinearizationPoint {
  JointVector compliance;              ///< of the joints, rad/Nm, none negative
  JointVector friction;                ///< Nm; 0: not known yet, the joint lags from the first newton metre
  double sticking = 1.0;               ///< stiffness with which friction holds before it slips, over the joint's own
  int targets = 0;                     ///< of the campaign
  Eigen::VectorXd compensator;         ///< torque on joint 2: sin, cos of q_2, of 2 q_2 and so on, Nm; empty: none
  JointVector play;                    ///< backlash of the joints, rad; zero: not known yet
  JointVector harder_by_square;        ///< stiffness k (1 + a tau^2) of the joints: a, 1/Nm^2
  JointVector harder_by_size;          ///< stiffness k (1 + a |tau|): a, 1/Nm
  JointVector largest_torque;          ///< own weight and load, largest of all states, Nm
  double passage = 0.05;               ///< part of the largest torque over which the backlash passes from side to side
  std::vector<PresentEffect> present;  ///< effects in the model that move the unloaded arm
  double largest_force = 1.0;          ///< N, of the campaign: scales what is proportional to the load
  /// From the declared point of the wrench to where the load itself pulls, flange axes, m.
  Eigen::Vector3d load_offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d epoch_centre = Eigen::Vector3d::Zero();  ///< about which frames turn
  double first_time = 0.0, time_span = 1.0;                ///< s, of the loading
  double sweep_time = 0.0;                                 ///< s; the sweeps' epoch as far as it is known
  Eigen::Isometry3d r0_from_base_link = Eigen::Isometry3d::Identity();
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();        ///< direction of gravity, in R0
  Eigen::Vector3d rail_in_base = Eigen::Vector3d::Zero();  ///< direction of an arm's rail; zero: it stands on none
  RailTravel rail;                                         ///< of an arm on one

  /// From the carriage at zero, to which points are referred, to where it stood when they were read, in R0, m. Zero for
  /// an arm on no rail, and where nothing says where the carriage stood.
  Eigen::Vector3d travelOf(double carriage) const;
  /// The same from the mean of the day's positions.
  Eigen::Vector3d travelFromMean(double carriage) const;
  /// Columns for a small rigid motion of all readings, rotations about x, y, z of R0 (rad) and then shifts (m): that of
  /// the instrument, or of robot and rail. It turns the points where they were read, about the middle of the day's.
  Eigen::MatrixXd byMovedInstrument(const ArmState& state) const;
  /// Takes such a motion off: what becomes of points of R0 that are referred to the carriage at zero.
  Eigen::Isometry3d withoutMovedInstrument(const Vector6d& motion, double carriage = campaign::kNotGiven) const;

  LinearizationPoint() = default;  ///< of no machine yet
  /// Of a machine of so many joints, rigid and without effects.
  explicit LinearizationPoint(int joints)
      : compliance(JointVector::Zero(joints)),
        friction(compliance),
        play(compliance),
        harder_by_square(compliance),
        harder_by_size(compliance),
        largest_torque(compliance) {}

  bool jointsTurn() const;  ///< by an effect in the model
  bool bodiesMove() const;
};

/// What is corrected before the effects' equations are made: estimates of the effects in the model, so that
/// the next linear step starts where the last one ended.
struct Corrections {
  Eigen::Vector3d load_point = Eigen::Vector3d::Zero();  ///< m, flange axes
  Eigen::Vector3d cell_turn = Eigen::Vector3d::Zero();   ///< rad, about the cell's axes
  Eigen::Vector3d cell_force = Eigen::Vector3d::Zero();  ///< N, in the cell's axes, in loaded states
  double missing_weight = 0.0;                           ///< N, along gravity, in loaded states
  Vector6d frame = Vector6d::Zero();                     ///< motion of the loading's readings, as frame_error has it
};

/// Parameters of an effect that come or stay away together: one joint's, one pair's, one reflector's.
struct EffectPart {
  std::string detail;                   ///< "joint 3", "joints 2 and 3", "P12"; empty where nothing is to be named
  std::vector<double> most;             ///< physical bound of each parameter's magnitude
  bool positive = false;                ///< a compliance, a width: never negative
  std::string unit;                     ///< of the parameters
  std::vector<std::string> names = {};  ///< of each parameter; empty: a single one, called as the part
  std::vector<std::string> units = {};  ///< of each parameter; empty: `unit` is that of all
  /// Parameters of one model with the same number are large or small together, as shares of their bounds, by the
  /// physics of what they belong to; those with 0 are not.
  int alike = 0;
  /// How the effect's equation bends and not how large it is (the width of a passage). Its one parameter is a step of
  /// the logarithm of what the working point has (EffectModel::shapeAt): a fit of sizes without it is a fit at whatever
  /// shape it began with. `unit` is that of the shape itself.
  bool is_shape = false;
};

/// Beyond the arm's bodies, one an axis: what the plate between flange and reflectors carries.
constexpr int toolBody(int bodies) { return bodies + 1; }

/// A small rigid motion of the arm from one body outwards, in R0, per unit of a parameter.
struct BodyTwist {
  int first_body = 1;  ///< it and all bodies beyond it move as one
  /// Whether the axis about which that body turns moves as well: it does where something further in deflects (a
  /// base, a link's tip), not where its bearing does.
  bool with_axis = false;
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< rad
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     ///< of the pivot, m
};

/// One effect as a model of the offset u of every reflector in a state: u = columns * parameters. It has one
/// of `angles`, `twists` and `offset`.
struct EffectModel {
  Effect effect = {};      ///< filled by modelsOf()
  std::string shape = {};  ///< which of the effect's equations, where it has several
  std::vector<EffectPart> parts = {};
  std::size_t most_parts = 1;  ///< that may be present together
  /// Where the effect only turns joints.
  JointAngles (*angles)(const LinearizationPoint& at, const PostureStates& posture, std::size_t state) = nullptr;
  /// Where it moves bodies rigidly: one a parameter; those of a part have one body and one pivot.
  std::vector<BodyTwist> (*twists)(const LinearizationPoint& at, const PostureStates& posture,
                                   std::size_t state) = nullptr;
  /// Else: 3 rows a reflector, one column a parameter, parts in their order, m per unit.
  Eigen::MatrixXd (*offset)(const LinearizationPoint& at, const PostureStates& posture, std::size_t state) = nullptr;
  /// Its twists are those of the tool beyond the flange: the arm itself stays where it is.
  bool beyond_flange = false;
  /// Where its equations bend with their own parameters: moves the working point to these, and leaves in
  /// `own` those that are sizes of the effect (not shapes); to none of the effect where all are zero. Models with the
  /// same function bend by the same numbers of the working point. Null: they do not bend.
  void (*settle)(LinearizationPoint& at, Eigen::VectorXd& own) = nullptr;
  /// What the working point has of the part that is a shape. Null: no part is.
  double (*shapeAt)(const LinearizationPoint& at) = nullptr;
  /// Where its parameters multiply other unknowns: once estimated, it is put into what the equations are made
  /// with, and `own` becomes what they then contain. `compliance` is that of the equations it was found in.
  void (*correct)(const JointVector& compliance, LinearizationPoint& at, Corrections& corrections,
                  Eigen::VectorXd& own) = nullptr;

  Eigen::MatrixXd columns(const LinearizationPoint& at, const PostureStates& posture, std::size_t state) const;

  std::size_t parameters() const;

  /// Whether it moves the unloaded arm, so that everything else is computed where it has left the arm.
  bool movesArm() const { return angles != nullptr || (twists != nullptr && !beyond_flange); }
};

/// What an effect's models are made for: they have a part a joint, a pair of joints, a reflector.
struct ModelScope {
  int joints = 6;
  std::vector<std::string> targets = {};  ///< names of the reflectors
  bool on_rail = false;                   ///< the arm stands on the carriage of one
  double compliance = 0.0;                ///< armCompliance, rad/Nm; 0: not known
};

/// Parts of one parameter each for the joints.
std::vector<EffectPart> jointParts(const ModelScope& scope, double most, bool positive, const std::string& unit);

/// One part of a rotation about x, y, z (rad) and a shift along them (m).
EffectPart rigidMotionPart(double most);

/// The wrench's own displacement field: joint springs turned by the torque of a changed wrench on the tool.
Eigen::VectorXd bySprings(const LinearizationPoint& at, const ArmState& state, const robot::Wrench& change);

/// Axes in base_link along which the foot of an arm gives (base_compliance): those of base_link, or of an arm on a rail
/// with x along the rail and z as near to base_link's as that leaves it.
Eigen::Matrix3d footAxes(const Eigen::Vector3d& rail_in_base);

/// What parameter `k` of a part is called, and its unit: "joint 3", "P12 x", "1/EI of link 2", "turn about
/// x".
std::string parameterName(const EffectPart& part, std::size_t k);
std::string parameterUnit(const EffectPart& part, std::size_t k);

/// What an effect is a property of; that decides where its fitted size belongs.
enum class EffectNature {
  machine,      ///< how the machine deflects: readings are corrected for it, every predicted deflection has it
  load,         ///< where the load acts on the tool: the declared point is corrected, for planned loads too
  measurement,  ///< a fault of the day's measurement: readings are corrected for it, predictions lack it
  geometry,     ///< lengths and zeros: every identification has the measured ones already, nothing is added
};

/// What a campaign has that effects need.
struct CampaignContents {
  std::size_t reflectors = 0;
  std::size_t load_steps = 0;  ///< with a force, beyond the return share
  bool return_to_zero = false;
  bool moments = false;  ///< some moment was measured
  bool times = false;
  bool weights = false;  ///< masses of the arm are known
  bool absolute = false, sweeps = false;
  bool nests = false;
  int carriage_positions = 0;  ///< in loaded postures, a hundredth of a metre and more apart; 0: the arm is on no rail
};

/// All that the program knows of an effect but its words, which stand in reports/words.
struct EffectRecord {
  Effect effect = {};
  EffectNature nature = EffectNature::machine;
  bool of_rail = false;  ///< of an arm on a rail alone; others are not asked for it
  /// What is missing to test it with this; empty where nothing is. Null: nothing ever is.
  Remark (*missing)(const CampaignContents& contents) = nullptr;
  /// Its equations, one or more. Null: it has no columns.
  std::vector<EffectModel> (*models)(const ModelScope& scope) = nullptr;
};

}  // namespace stiffscope::effects
