#include "core/compensation/compensate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/campaign/read_table.h"
#include "core/identification/load_case.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/robot/wrench.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::compensation {

std::vector<Remark> implausibleCommands(const std::vector<CompensatedPosture>& postures) {
  constexpr double kMost = 2.0 * io::kDegree;
  std::vector<Remark> remarks;
  for (const CompensatedPosture& posture : postures) {
    if (!posture.solved) continue;
    Eigen::Index joint = 0;
    const double turn = (posture.commands - posture.posture.q).cwiseAbs().maxCoeff(&joint);
    if (turn <= kMost) continue;
    remarks.emplace_back(RemarkId::implausible_command, posture.posture.id, joint + 1, turn);
  }
  return remarks;
}

namespace {

struct PostureRow {
  std::string id;
  Vector6d q = Vector6d::Zero();
  Vector6d wrench_in_cell = Vector6d::Zero();
  std::size_t line = 0;
};

const campaign::TableLayout<PostureRow>& posturesLayout() {
  using Row = PostureRow;
  static const campaign::TableLayout<Row> layout{
      "postures",
      campaign::joined<Row>({{{"pose", campaign::CellKind::text, [](Row& row) -> std::string& { return row.id; }}},
                             campaign::jointColumns<Row>(),
                             campaign::wrenchColumns<Row>()}),
      {"pose"}};
  return layout;
}

}  // namespace

std::vector<PostureToCompensate> readPostures(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string bytes = io::readTextFile(file);
  campaign::CampaignNames names;
  std::vector<PostureToCompensate> postures;
  for (PostureRow& row : campaign::readTable<PostureRow>({file.string(), bytes}, posturesLayout(), names, warnings)) {
    postures.push_back({std::move(row.id), row.q, row.wrench_in_cell});
  }
  return postures;
}

std::vector<PostureToCompensate> campaignPostures(const campaign::Campaign& campaign, int step) {
  std::vector<PostureToCompensate> postures;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step != step) continue;
    postures.push_back({campaign.pose_ids[static_cast<std::size_t>(state.pose)], state.q, state.wrench_in_cell});
  }
  return postures;
}

namespace {

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The flange unloaded and loaded.
struct Moved {
  Eigen::Isometry3d unloaded, loaded;
};

class Compensator {
 public:
  Compensator(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
              const identification::StiffnessEstimate& estimate, const Eigen::Vector3d& tcp_in_flange,
              const CompensateOptions& options, const effects::EffectDeflection* with)
      : campaign_(campaign),
        geometry_(geometry),
        estimate_(estimate),
        tcp_(tcp_in_flange),
        options_(options),
        with_(with) {}

  CompensatedPosture run(const PostureToCompensate& asked) const {
    CompensatedPosture result;
    result.posture = asked;
    const auto unloaded_angles = effects::loadedAngles(geometry_, estimate_.compliance, asked.q, effects::FlangeLoad());
    if (!unloaded_angles) {
      result.reason = Remark(RemarkId::unloaded_arm_does_not_rest);
      return result;
    }
    const robot::ArmPosture unloaded = robot::postureAt(geometry_.arm, *unloaded_angles);
    const auto resting =
        with_ ? with_->flange(asked.q, effects::FlangeLoad()) : robot::flangeAt(geometry_.arm, unloaded);
    if (!resting) {
      result.reason = Remark(RemarkId::unloaded_arm_does_not_rest);
      return result;
    }
    const Eigen::Isometry3d wanted = *resting;
    const effects::FlangeLoad load = loadAt(unloaded, wanted, asked.wrench_in_cell);
    predict(unloaded, wanted, load, result);
    if (!result.predicted) return result;
    result.reason = refusal(asked, unloaded, wanted, load, result.conditioning);
    if (result.reason.empty()) solve(asked, *unloaded_angles, wanted, load, result);
    return result;
  }

 private:
  effects::FlangeLoad loadAt(const robot::ArmPosture& posture, const Eigen::Isometry3d& flange,
                             const Vector6d& reading) const {
    const robot::Wrench wrench =
        identification::cellWrench(*campaign_.load_cell, geometry_, posture, flange, flange, reading);
    return {flange.inverse() * wrench.point, wrench.force, wrench.moment};
  }

  Vector6d torqueOf(const robot::ArmPosture& posture, const Eigen::Isometry3d& flange,
                    const effects::FlangeLoad& load) const {
    return robot::jointTorque(geometry_.arm, posture, {flange * load.point_in_flange, load.force, load.moment});
  }

  /// Where the loaded arm stands with these commands; empty where it does not come to rest.
  std::optional<robot::ArmPosture> loadedPosture(const Vector6d& commands, const effects::FlangeLoad& load) const {
    const auto angles = effects::loadedAngles(geometry_, estimate_.compliance, commands, load);
    return angles ? std::optional<robot::ArmPosture>(robot::postureAt(geometry_.arm, *angles)) : std::nullopt;
  }

  /// Where the flange of the loaded arm stands with these commands, `posture` the one of its springs alone.
  std::optional<Eigen::Isometry3d> loadedFlange(const Vector6d& commands, const robot::ArmPosture& posture,
                                                const effects::FlangeLoad& load) const {
    return with_ ? with_->flange(commands, load) : robot::flangeAt(geometry_.arm, posture);
  }

  Remark refusal(const PostureToCompensate& asked, const robot::ArmPosture& unloaded, const Eigen::Isometry3d& wanted,
                 const effects::FlangeLoad& load, double conditioning) const {
    const Remark outside = outsideLimits(asked.q, RemarkId::posture_outside_limits);
    if (!outside.empty()) return outside;
    if (conditioning < options_.least_conditioning)
      return Remark(RemarkId::near_singularity, conditioning, options_.least_conditioning);
    return turnsUnusableJoint(torqueOf(unloaded, wanted, load));
  }

  /// The reason to refuse where the load turns a joint of unknown stiffness, which counts as rigid here, or
  /// of a negative one, by which the commands would go the wrong way.
  Remark turnsUnusableJoint(const Vector6d& torque) const {
    for (int joint = 0; joint < 6; ++joint) {
      const bool known = estimate_.identifiable[static_cast<std::size_t>(joint)];
      if (known && estimate_.compliance[joint] >= 0.0) continue;
      if (std::abs(torque[joint]) <= options_.share_unknown * torque.cwiseAbs().maxCoeff()) continue;
      return Remark(known ? RemarkId::turns_joint_of_negative_k : RemarkId::turns_joint_of_unknown_k, joint + 1,
                    std::abs(torque[joint]));
    }
    return {};
  }

  /// `changes`: of the result by what else is uncertain, one column each.
  Eigen::Vector3d sdOf(const Matrix36d& rows, const Eigen::Matrix3Xd& changes) const {
    const Matrix6d& covariance = with_ ? with_->spring_covariance : estimate_.covariance;
    Eigen::Vector3d variance = (rows * covariance * rows.transpose()).diagonal();
    if (changes.cols() > 0) variance += changes.rowwise().squaredNorm();
    return variance.unaryExpr([](double v) { return v < 0.0 ? 0.0 : std::sqrt(v); });  // keeps what is no number
  }

  PointDeflection deflectionOf(const Eigen::Vector3d& point_in_flange, const Eigen::Isometry3d& wanted,
                               const Eigen::Isometry3d& loaded, const robot::ArmPosture& unloaded,
                               const Vector6d& torque, const std::vector<Moved>& varied) const {
    const Eigen::Vector3d place = wanted * point_in_flange, deflection = loaded * point_in_flange - place;
    const Matrix36d rows = robot::jacobianAt(geometry_.arm, unloaded, place).topRows<3>() * torque.asDiagonal();
    Eigen::Matrix3Xd changes(3, static_cast<Eigen::Index>(varied.size()));
    for (std::size_t k = 0; k < varied.size(); ++k)
      changes.col(static_cast<Eigen::Index>(k)) =
          varied[k].loaded * point_in_flange - varied[k].unloaded * point_in_flange - deflection;
    return {deflection, sdOf(rows, changes)};
  }

  /// The flange of the arm with what is uncertain moved; those that do not come to rest are left out.
  std::vector<Moved> variedBy(const Vector6d& q, const effects::FlangeLoad& load) const {
    std::vector<Moved> moved;
    for (std::size_t k = 0; with_ != nullptr && k < with_->varied.size(); ++k) {
      const auto unloaded = with_->varied[k](q, effects::FlangeLoad()), loaded = with_->varied[k](q, load);
      if (unloaded && loaded) moved.push_back({*unloaded, *loaded});
    }
    return moved;
  }

  void predict(const robot::ArmPosture& unloaded, const Eigen::Isometry3d& wanted, const effects::FlangeLoad& load,
               CompensatedPosture& result) const {
    const auto posture = loadedPosture(result.posture.q, load);
    const auto resting = posture ? loadedFlange(result.posture.q, *posture, load) : std::nullopt;
    if (!resting) {
      result.reason = Remark(RemarkId::loaded_arm_does_not_rest);
      return;
    }
    result.predicted = true;
    const Eigen::Isometry3d& loaded = *resting;
    const Vector6d torque = torqueOf(unloaded, wanted, load);
    const Matrix6d jacobian = robot::jacobianAt(geometry_.arm, unloaded, wanted * tcp_);
    const std::vector<Moved> varied = variedBy(result.posture.q, load);
    result.tcp = deflectionOf(tcp_, wanted, loaded, unloaded, torque, varied);
    result.rotation = rotationVector(loaded.linear() * wanted.linear().transpose());
    Eigen::Matrix3Xd turns(3, static_cast<Eigen::Index>(varied.size()));
    for (std::size_t k = 0; k < varied.size(); ++k)
      turns.col(static_cast<Eigen::Index>(k)) =
          rotationVector(varied[k].loaded.linear() * varied[k].unloaded.linear().transpose()) - result.rotation;
    result.rotation_sd = sdOf(jacobian.bottomRows<3>() * torque.asDiagonal(), turns);
    const auto& places = geometry_.targets_at_zero;
    if (std::all_of(places.begin(), places.end(), [](const auto& place) { return place.has_value(); })) {
      const Eigen::Isometry3d flange_from_zero = geometry_.arm.base_from_flange_at_zero.inverse();
      for (const auto& place : places) {
        result.targets.push_back(deflectionOf(flange_from_zero * *place, wanted, loaded, unloaded, torque, varied));
      }
    }
    const Vector6d singular = singularValues(jacobian);
    result.conditioning = singular[5] / singular[0];
  }

  void solve(const PostureToCompensate& asked, const Vector6d& unloaded_angles, const Eigen::Isometry3d& wanted,
             const effects::FlangeLoad& load, CompensatedPosture& result) const {
    const auto once = effects::loadedAngles(geometry_, estimate_.compliance, asked.q, load);
    Vector6d commands = asked.q - (*once - unloaded_angles);  // the predicted turn, mirrored: the first try
    constexpr int kMostSteps = 20;
    constexpr double kThere = 1e-9;  // m and rad
    for (int step = 0; step < kMostSteps; ++step) {
      const auto posture = loadedPosture(commands, load);
      const auto resting = posture ? loadedFlange(commands, *posture, load) : std::nullopt;
      if (!resting) {
        result.reason = Remark(RemarkId::loaded_arm_does_not_rest);
        return;
      }
      const Eigen::Isometry3d& flange = *resting;
      Vector6d error;
      error << wanted * tcp_ - flange * tcp_, rotationVector(wanted.linear() * flange.linear().transpose());
      result.remaining = error.head<3>().norm();
      if (step == 0) result.mirrored_remaining = result.remaining;
      if (error.cwiseAbs().maxCoeff() < kThere) {
        result.commands = commands;
        result.reason = outsideLimits(commands, RemarkId::command_outside_limits);
        result.solved = result.reason.empty();
        return;
      }
      commands += solveLu(robot::jacobianAt(geometry_.arm, *posture, flange * tcp_), error);
    }
    result.reason = Remark(RemarkId::steps_do_not_converge);
  }

  Remark outsideLimits(const Vector6d& angles, RemarkId what) const {
    for (int joint = 0; joint < 6; ++joint) {
      const robot::JointLimits& limits = geometry_.arm.limits[static_cast<std::size_t>(joint)];
      if (angles[joint] < limits.lower || angles[joint] > limits.upper)
        return Remark(what, joint + 1, angles[joint], limits.lower, limits.upper);
    }
    return {};
  }

  const campaign::Campaign& campaign_;
  const frames::LoadingGeometry& geometry_;
  const identification::StiffnessEstimate& estimate_;
  Eigen::Vector3d tcp_;
  CompensateOptions options_;
  const effects::EffectDeflection* with_;
};

}  // namespace

std::vector<CompensatedPosture> compensate(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                           const identification::StiffnessEstimate& estimate,
                                           const Eigen::Vector3d& tcp_in_flange,
                                           const std::vector<PostureToCompensate>& postures,
                                           const CompensateOptions& options, const effects::EffectDeflection* with) {
  const Compensator compensator(campaign, geometry, estimate, tcp_in_flange, options, with);
  std::vector<CompensatedPosture> results;
  results.reserve(postures.size());
  for (const PostureToCompensate& posture : postures) results.push_back(compensator.run(posture));
  return results;
}

}  // namespace stiffscope::compensation
