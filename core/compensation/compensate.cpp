#include "core/compensation/compensate.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/identification/cell_wrench.h"
#include "core/statics/joint_torque.h"

namespace stiffscope {

namespace {

double toDegrees(double radians) { return radians * 180.0 / std::numbers::pi; }

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

class Compensator {
 public:
  Compensator(const Campaign& campaign, const LoadingGeometry& geometry, const StiffnessEstimate& estimate,
              const Eigen::Vector3d& tcp_in_flange, const CompensateOptions& options)
      : campaign_(campaign), geometry_(geometry), estimate_(estimate), tcp_(tcp_in_flange), options_(options) {}

  CompensatedPosture run(const PostureToCompensate& asked) const {
    CompensatedPosture result;
    result.posture = asked;
    const Vector6d unloaded_angles = loadedAngles(geometry_, estimate_.compliance, asked.q, FlangeLoad());
    const ArmPosture unloaded = postureAt(geometry_.arm, unloaded_angles);
    const Eigen::Isometry3d wanted = flangeAt(geometry_.arm, unloaded);
    const FlangeLoad load = loadAt(unloaded, wanted, asked.wrench_in_cell);
    predict(asked, unloaded, wanted, load, result);
    result.reason = turnsUnknownJoint(unloaded, wanted, load);
    if (!result.reason.empty()) return result;
    if (result.conditioning < options_.least_conditioning) {
      result.reason = fmt::format("too near a singularity: conditioning {:.4f}, at least {:g} is asked for",
                                  result.conditioning, options_.least_conditioning);
      return result;
    }
    solve(asked, wanted, load, result);
    return result;
  }

 private:
  FlangeLoad loadAt(const ArmPosture& posture, const Eigen::Isometry3d& flange, const Vector6d& reading) const {
    const Wrench wrench = cellWrench(*campaign_.load_cell, geometry_, posture, flange, flange, reading);
    return {flange.inverse() * wrench.point, wrench.force, wrench.moment};
  }

  /// The reason to refuse where a joint of unknown stiffness, which counts as rigid here, is turned by the load.
  std::string turnsUnknownJoint(const ArmPosture& unloaded, const Eigen::Isometry3d& flange, const FlangeLoad& load) const {
    const Vector6d torque =
        jointTorque(geometry_.arm, unloaded, {flange * load.point_in_flange, load.force, load.moment});
    for (int joint = 0; joint < 6; ++joint) {
      if (estimate_.identifiable[static_cast<std::size_t>(joint)]) continue;
      if (std::abs(torque[joint]) <= options_.share_unknown * torque.cwiseAbs().maxCoeff()) continue;
      return fmt::format("the load turns axis {} by {:.0f} Nm and k{} is not known: the deflection shown lacks its part",
                         joint + 1, std::abs(torque[joint]), joint + 1);
    }
    return {};
  }

  void predict(const PostureToCompensate& asked, const ArmPosture& unloaded, const Eigen::Isometry3d& wanted,
               const FlangeLoad& load, CompensatedPosture& result) const {
    const Eigen::Isometry3d loaded =
        flangeAt(geometry_.arm, postureAt(geometry_.arm, loadedAngles(geometry_, estimate_.compliance, asked.q, load)));
    result.deflection = loaded * tcp_ - wanted * tcp_;
    result.rotation = rotationVector(loaded.linear() * wanted.linear().transpose());
    const Matrix6d jacobian = jacobianAt(geometry_.arm, unloaded, wanted * tcp_);
    const Vector6d torque =
        jointTorque(geometry_.arm, unloaded, {wanted * load.point_in_flange, load.force, load.moment});
    const Matrix36d rows = jacobian.topRows<3>() * torque.asDiagonal();
    result.deflection_sd = (rows * estimate_.covariance * rows.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
    const Eigen::JacobiSVD<Matrix6d> svd(jacobian);
    result.conditioning = svd.singularValues()[5] / svd.singularValues()[0];
  }

  void solve(const PostureToCompensate& asked, const Eigen::Isometry3d& wanted, const FlangeLoad& load,
             CompensatedPosture& result) const {
    Vector6d commands = asked.q;
    constexpr int kMostSteps = 20;
    constexpr double kThere = 1e-9;  // m and rad
    for (int step = 0; step < kMostSteps; ++step) {
      const ArmPosture posture =
          postureAt(geometry_.arm, loadedAngles(geometry_, estimate_.compliance, commands, load));
      const Eigen::Isometry3d flange = flangeAt(geometry_.arm, posture);
      Vector6d error;
      error << wanted * tcp_ - flange * tcp_, rotationVector(wanted.linear() * flange.linear().transpose());
      result.remaining = error.head<3>().norm();
      if (error.cwiseAbs().maxCoeff() < kThere) {
        result.commands = commands;
        result.reason = outsideLimits(commands);
        result.solved = result.reason.empty();
        return;
      }
      commands += jacobianAt(geometry_.arm, posture, flange * tcp_).partialPivLu().solve(error);
    }
    result.reason = "the steps towards the wanted pose do not converge";
  }

  std::string outsideLimits(const Vector6d& commands) const {
    for (int joint = 0; joint < 6; ++joint) {
      const JointLimits& limits = geometry_.arm.limits[static_cast<std::size_t>(joint)];
      if (commands[joint] < limits.lower || commands[joint] > limits.upper) {
        return fmt::format("joint {} would have to go to {:.3f} deg, outside its limits {:.1f} to {:.1f} deg", joint + 1,
                           toDegrees(commands[joint]), toDegrees(limits.lower), toDegrees(limits.upper));
      }
    }
    return {};
  }

  const Campaign& campaign_;
  const LoadingGeometry& geometry_;
  const StiffnessEstimate& estimate_;
  Eigen::Vector3d tcp_;
  CompensateOptions options_;
};

}  // namespace

std::vector<CompensatedPosture> compensate(const Campaign& campaign, const LoadingGeometry& geometry,
                                           const StiffnessEstimate& estimate, const Eigen::Vector3d& tcp_in_flange,
                                           const std::vector<PostureToCompensate>& postures,
                                           const CompensateOptions& options) {
  const Compensator compensator(campaign, geometry, estimate, tcp_in_flange, options);
  std::vector<CompensatedPosture> results;
  results.reserve(postures.size());
  for (const PostureToCompensate& posture : postures) {
    try {
      results.push_back(compensator.run(posture));
    } catch (const std::runtime_error& error) {  // a load beyond what the springs bear: this posture only
      results.emplace_back();
      results.back().posture = posture;
      results.back().reason = error.what();
    }
  }
  return results;
}

}  // namespace stiffscope
