#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/calibrate.h"
#include "core/campaign/campaign.h"
#include "core/numerics/random.h"

// Known causes for readings of a day without a load, by rigid kinematics of the nominal arm: formulas of their own, so
// that the diagnosis is not judged by its own.

namespace stiffscope::bench {

/// One posture of the nominal arm; base_link, m and rad.
struct NominalPosture {
  JointVector q;
  JointVector move, side;                   ///< as reported: since the state before; where from
  double time = 0.0;                        ///< share of the day
  PerJoint<Eigen::Vector3d> on_axis, axis;  ///< a point and the direction of each
  PerBody<Eigen::Isometry3d> motion;        ///< of each body from its place at zero
  PerJoint<Eigen::Vector3d> weight_at;      ///< where what stands beyond joint j, from 0, weighs

  explicit NominalPosture(int joints)
      : q(JointVector::Zero(joints)),
        move(q),
        side(q),
        on_axis(static_cast<std::size_t>(joints), Eigen::Vector3d::Zero()),
        axis(on_axis),
        motion(static_cast<std::size_t>(joints) + 1, Eigen::Isometry3d::Identity()),
        weight_at(on_axis) {}
};

/// A day by the nominal arm, placed where its calibration's registration has it.
struct NominalDay {
  Eigen::Isometry3d base_from_points = Eigen::Isometry3d::Identity();
  Eigen::Vector3d station = Eigen::Vector3d::Zero(), flange_at_zero = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  PerJoint<double> mass_beyond;  ///< of everything that joint j carries, kg
  bool masses_known = false;
  std::vector<NominalPosture> postures;  ///< by Campaign::pose_ids
  std::vector<std::string> targets;
};

NominalDay nominalDay(const campaign::Campaign& campaign, const calibration::Calibration& calibration);

/// What a cause of a size does to a reading at `point` (base_link): where it is then read.
using Moved = std::function<Eigen::Vector3d(const NominalPosture& posture, int target, const Eigen::Vector3d& point,
                                            double size)>;

struct Cause {
  calibration::UnloadedEffect effect = {};
  std::string detail;  ///< as the diagnosis names the part; empty where it names none
  std::string drawn;   ///< for people: order, time
  Moved moved;
};

/// Above this no arm that works is, in a cause's own unit: 1000 Nm/rad of a joint or link, 10,000 of a bearing or
/// floor, 1 % of length or scale, 10 mrad of a joint, a tenth of a move or of another joint's angle, 100 mm, 100 mrad.
double mostPlausible(calibration::UnloadedEffect effect);

/// A random member of an effect: joint, order, time, direction. Empty where the day has none (no masses).
std::optional<Cause> drawCause(calibration::UnloadedEffect effect, const NominalDay& day,
                               numerics::RandomStream& random);

/// What a rigid arm can do to the readings: a small motion of every body in its own axes, and every reflector elsewhere
/// on the last.
class RigidGeometry {
 public:
  /// Readings used: pose, target and point (base_link) of each.
  struct At {
    std::size_t pose = 0;
    int target = 0;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  RigidGeometry(const NominalDay& day, std::vector<At> readings);

  /// Rms of the 3-D position that a cause moves, in all and beyond the rigid geometry, by a small size, m a unit.
  struct Moves {
    double all = 0.0, beyond = 0.0;
  };
  Moves movesOf(const Cause& cause) const;

 private:
  const NominalDay& day_;
  std::vector<At> readings_;
  Eigen::MatrixXd basis_;  ///< orthonormal columns
};

/// The readings with a cause in them, everything else (order, times, states) as it was.
campaign::Campaign withCause(const campaign::Campaign& campaign, const NominalDay& day, const Cause& cause,
                             double size);

}  // namespace stiffscope::bench
