#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/effects/arm_state.h"
#include "core/effects/effect.h"

namespace stiffscope::effects {

/// What the models of the effects are linearised at. Effects that multiply another unknown (a wrong load
/// point times a compliance) or bend with their own size (friction) take that other one from here and are
/// fitted again and again.
struct PresentTurn;
struct PresentMotion;

struct WorkingPoint {
  Vector6d compliance = Vector6d::Zero();  ///< of the joints, rad/Nm, none negative
  Vector6d friction = Vector6d::Zero();  ///< Nm; 0: not known yet, the joint lags from the first newton metre
  double sticking = 1.0;  ///< stiffness with which friction holds before it slips, over the joint's own
  int targets = 0;                       ///< of the campaign
  Eigen::VectorXd compensator;  ///< torque on joint 2: sin, cos of q_2, of 2 q_2 and so on, Nm; empty: none
  Vector6d play = Vector6d::Zero();              ///< backlash of the joints, rad; zero: not known yet
  Vector6d harder_by_square = Vector6d::Zero();  ///< stiffness k (1 + a tau^2) of the joints: a, 1/Nm^2
  Vector6d harder_by_size = Vector6d::Zero();    ///< stiffness k (1 + a |tau|): a, 1/Nm
  Vector6d largest_torque = Vector6d::Zero();    ///< own weight and load, largest of all states, Nm
  double passage = 0.05;  ///< part of the largest torque over which the backlash passes from side to side
  std::vector<PresentTurn> turns;                ///< effects in the model that turn joints unloaded
  std::vector<PresentMotion> motions;            ///< and those that move bodies
  double largest_force = 1.0;  ///< N, of the campaign: scales what is proportional to the load
  /// From the declared point of the wrench to where the load itself pulls, flange axes, m.
  Eigen::Vector3d load_offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d epoch_centre = Eigen::Vector3d::Zero();  ///< about which frames turn
  double first_time = 0.0, time_span = 1.0;                ///< s, of the loading
  double sweep_time = 0.0;                                 ///< s; the sweeps' epoch as far as it is known
  Eigen::Isometry3d r0_from_base_link = Eigen::Isometry3d::Identity();
};

/// Parameters of an effect that come or stay away together: one joint's, one pair's, one reflector's.
struct EffectPart {
  std::string detail;        ///< "joint 3", "joints 2 and 3", "P12"; empty where nothing is to be named
  std::vector<double> most;  ///< physical bound of each parameter's magnitude
  bool positive = false;     ///< a compliance, a width: never negative
  std::string unit;          ///< of the parameters
};

/// Joint angles of an effect that only turns joints, one column a parameter, rad per unit.
using JointAngles = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Offset of every reflector in a state: 3 rows a reflector, one column a parameter, m per unit.
using Offset = Eigen::MatrixXd (*)(const WorkingPoint& at, const PostureStates& posture, std::size_t state);

/// An effect that moves the arm's bodies by the own weight alone, with its size.
struct PresentMotion {
  Offset offset = nullptr;
  std::vector<int> first_body;  ///< by parameter: it and all bodies beyond it move as one
  Eigen::VectorXd parameters;
};

/// An effect that turns joints by the own weight alone, with its size: part of where the unloaded arm stands.
struct PresentTurn {
  JointAngles (*angles)(const WorkingPoint& at, const PostureStates& posture, std::size_t state) = nullptr;
  Eigen::VectorXd parameters;
};

/// One effect as a model of the offset u of every reflector in a state: u = columns * parameters.
struct EffectModel {
  Effect effect = Effect::link_compliance;
  std::string shape;  ///< which of the effect's equations, where it has several
  std::vector<EffectPart> parts;
  std::size_t most_parts = 1;  ///< that may be present together
  /// 3 rows a reflector, one column a parameter, parts in their order, m per unit.
  Offset offset = nullptr;
  /// Instead of `offset` where the effect only turns joints.
  JointAngles (*angles)(const WorkingPoint& at, const PostureStates& posture, std::size_t state) = nullptr;
  /// Where its equations bend with their own parameters: moves the working point to these, and leaves in
  /// `own` those that are sizes of the effect (not shapes). Null: they do not bend.
  void (*settle)(WorkingPoint& at, Eigen::VectorXd& own) = nullptr;
  /// By parameter, where `offset` is a rigid motion of the arm from this body outwards; else empty.
  std::vector<int> first_body = {};

  Eigen::MatrixXd columns(const WorkingPoint& at, const PostureStates& posture, std::size_t state) const {
    return angles ? byJoints(posture[state], angles(at, posture, state)) : offset(at, posture, state);
  }

  std::size_t parameters() const {
    std::size_t count = 0;
    for (const EffectPart& part : parts) count += part.most.size();
    return count;
  }
};

/// Parts of one parameter each for the six joints.
std::vector<EffectPart> jointParts(double most, bool positive, const std::string& unit);

/// The wrench's own displacement field: joint springs turned by the torque of a changed wrench on the tool.
Eigen::VectorXd bySprings(const WorkingPoint& at, const ArmState& state, const robot::Wrench& change);

/// What parameter `k` of a part is called, and its unit: "joint 3", "P12 x", "1/EI of link 2", "turn about x".
std::string parameterName(const EffectModel& model, const EffectPart& part, std::size_t k);
std::string parameterUnit(const EffectPart& part, std::size_t k);

/// What an effect is a property of; that decides where its fitted size belongs.
enum class EffectNature {
  machine,      ///< how the machine gives: taken off the readings, and added to every predicted deflection
  load,         ///< where the load acts on the tool: the declared point is corrected, for planned loads too
  measurement,  ///< a fault of the day's measurement: taken off the readings; the machine does not do it
  geometry,     ///< lengths and zeros: every identification has the measured ones already, nothing is added
};

EffectNature natureOf(Effect effect);

/// Whether the effect has a part in what the machine does under a planned load.
bool entersCompensation(Effect effect);

/// What is done with the effect, and why, in words.
std::string useOf(Effect effect);

}  // namespace stiffscope::effects
