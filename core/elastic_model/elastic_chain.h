#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <vector>

namespace stiffscope::elastic_model {

/// One degree of freedom of a body against the one that carries it. Places and directions are those in base_link with
/// the whole chain at zero; an axis moves with what lies further in, the joints of its own body before it included.
struct ChainJoint {
  enum class Kind {
    drive,         ///< turned by the robot's motor: the angle as the controller reports it, rad
    turn_spring,   ///< N m/rad, at rest at 0
    shift_spring,  ///< N/m, at rest at 0
  };

  std::string name;
  Kind kind = Kind::drive;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the axis, m; of no meaning for a shift
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double stiffness = 0.0;                                   ///< 0 for a drive
  double lower = -std::numeric_limits<double>::infinity();  ///< of a drive, rad
  double upper = std::numeric_limits<double>::infinity();
};

/// Mass of a body: kg, its centre in base_link with the chain at zero (m), inertia about that centre in the axes of
/// base_link (kg m^2).
struct ChainMass {
  double mass_kg = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
};

/// A rigid body, carried by the one before it in the chain (the first by base_link) through its joints in series,
/// innermost first. Its frame stands at `origin`, parallel to base_link, with the chain at zero.
struct ChainBody {
  std::string name;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<ChainJoint> joints;  ///< one drive, or up to five springs
  ChainMass mass;                  ///< none: a body that only joins springs
};

/// A named frame on a body.
struct ChainSite {
  std::string name;
  int body = -1;                                                     ///< index of the body; -1: base_link
  Eigen::Isometry3d base_from_site = Eigen::Isometry3d::Identity();  ///< with the chain at zero
};

/// An elastic arm as a serial chain on base_link, which stands still. SI and radians, all in base_link at zero.
struct ElasticChain {
  std::string name, base;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2
  std::vector<ChainBody> bodies;
  std::vector<ChainSite> sites;
};

/// What simulators of dynamics want of bodies that have no mass of their own: small enough for no effect at rest (the
/// weight is 1e-5 N), large enough for the equations of motion of a chain of ten of them.
inline constexpr double kStandInMass = 1e-6;     ///< kg
inline constexpr double kStandInInertia = 1e-3;  ///< kg m^2, about every axis

/// Damping of a spring over its stiffness, s: the machine's is not measured, and it has no part in what stands still.
/// With an implicit velocity step it keeps any spring stable in steps below twice this.
inline constexpr double kDampingTime = 2e-3;
inline constexpr double kTimeStep = 1e-3;  ///< s

}  // namespace stiffscope::elastic_model
