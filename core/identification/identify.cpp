#include "core/identification/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/identification/cautions.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/judge_method.h"
#include "core/identification/partial_pose.h"
#include "core/identification/settled_frames.h"
#include "core/input/input_error.h"

namespace stiffscope {

namespace {

constexpr double kMissMatters = 0.02;  // share of P_wrist's displacement that a wrist's miss may put there

std::vector<NormalEquations> normalOf(const std::vector<CaseEquations>& equations) {
  std::vector<NormalEquations> normal;
  for (const CaseEquations& one : equations) normal.push_back(normalEquations(one));
  return normal;
}

class Identifier {
 public:
  Identifier(const Campaign& campaign, const IdentifyOptions& options)
      : campaign_(campaign), options_(options) {}

  Frames frames() {
    chooseStep();
    return settleFrames(campaign_, result_.step, options_).frames;
  }

  Identification run() {
    chooseStep();
    SettledFrames settled = settleFrames(campaign_, result_.step, options_);
    result_.frames = std::move(settled.frames);
    result_.left_out = std::move(settled.left_out);
    swept_ = std::move(settled.arm);
    judge();
    completePoseMethod();
    partialPoseMethod();
    decoupledMethod();
    describeCampaign();
    result_.cautions = cautionsOf(result_);
    return std::move(result_);
  }

 private:
  MethodResult& method(Method which) { return result_.methods[static_cast<std::size_t>(which)]; }

  InputPlace inFile(const std::string& file) const { return {(campaign_.folder / file).string(), 0, {}}; }

  void chooseStep() {
    if (!campaign_.states || !campaign_.load_cell) {
      throw InputError(inFile("campaign.xml"), "",
                       !campaign_.states
                           ? "no 'states': joint angles and load-cell readings are needed to identify"
                           : "no 'load_cell': where the measured wrench acts is needed to identify");
    }
    if (!campaign_.loading && !campaign_.displacements) {
      throw InputError(inFile("campaign.xml"), "",
                       "neither 'loading' nor 'displacements': readings under load are needed to identify");
    }
    const auto heaviest = heaviestStep(campaign_);
    if (options_.step) {
      const auto& rows = campaign_.states->rows;
      const bool known = *options_.step != 0 &&
                         std::any_of(rows.begin(), rows.end(),
                                     [&](const State& state) { return state.step == *options_.step; });
      if (!known) {
        throw InputError(inFile(campaign_.states->file), std::to_string(*options_.step),
                         "not a load step of this campaign");
      }
    } else if (!heaviest) {
      throw InputError(inFile(campaign_.states->file), "", "no load step has a force");
    }
    result_.step = options_.step ? *options_.step : *heaviest;
    result_.finite_deflection = options_.finite_deflection;
  }

  void judge() {
    result_.identifiability = judgeJoints(swept_.geometry, swept_.cases, *campaign_.load_cell,
                                          reflectorEquations(swept_), options_.trust);
    unknown_ = result_.identifiability.mask();
  }

  /// What all methods need; the reason where it is not there.
  std::string commonReason(const LoadedArm& arm) const {
    if (arm.cases.empty()) {
      if (!campaign_.loading && campaign_.displacements && !arm.geometry.displacements_in_r0) {
        return "the displacements are in the tracker's frame: circle sweeps of axes 1 and 2 would place it, or "
               "frame=\"base_link\" if they are in the robot's";
      }
      return campaign_.loading && !arm.geometry.r0_from_loading
                 ? "the loading's readings cannot be brought into R0: circle sweeps of axes 1 and 2 would "
                   "place them"
                 : "no posture has readings unloaded and under this load";
    }
    if (std::none_of(unknown_.begin(), unknown_.end(), [](bool one) { return one; })) {
      return "the load turns no joint enough to see its stiffness";
    }
    return {};
  }

  void completePoseMethod() {
    MethodResult& out = method(Method::complete_pose);
    out.reason = commonReason(swept_);
    if (!out.reason.empty()) return;
    if (!swept_.hasFlangePoses()) {
      out.reason =
          swept_.cases.front().absolute
              ? "a flange pose needs three reflectors, placed by circle sweeps, in every posture"
              : "a flange pose needs absolute positions of three reflectors; this campaign has displacements "
                "of " +
                    std::to_string(campaign_.targets.size()) + " point(s): measure `loading` with three";
      return;
    }
    const Eigen::Vector3d tcp = result_.frames.tcp_in_flange;
    result_.characteristic_length = characteristicLength(swept_.geometry, swept_.cases, tcp);
    const double length = result_.characteristic_length.length;
    out.estimate = solveSettled(swept_, options_.finite_deflection, [&](const LoadedArm& arm) {
      return completePose(poseEquations(arm, tcp), length, unknown_);
    });
    constexpr int kEvery = 5;
    const std::vector<CaseEquations> equations = poseEquations(swept_, tcp);
    for (std::size_t i = 0; i < result_.characteristic_length.curve.size(); i += kEvery) {
      const auto& [at, condition] = result_.characteristic_length.curve[i];
      result_.length_sensitivity.push_back({at, condition, completePose(equations, at, unknown_).compliance});
    }
    std::vector<NormalEquations> normal;
    for (const CaseEquations& one : equations) normal.push_back(normalEquations(normalised(one, length)));
    judgeMethod(swept_, std::move(normal), false, options_.subsets, out);
  }

  /// The loaded arm in the calibrated geometry. Where no sweep gave stiffnesses for the own weight's sag,
  /// calibration and stiffnesses are found in turns here, or the sag would be taken for geometry.
  LoadedArm calibratedArm() {
    LoadingGeometry start = swept_.geometry;
    const bool settle_sag = swept_.cases.empty() && result_.frames.weight.links_known;
    for (int round = 0;; ++round) {
      result_.calibration = calibrateGeometry(campaign_, start);
      if (!result_.calibration.done) return swept_;
      LoadedArm arm = loadedArm(campaign_, result_.calibration.geometry, result_.frames.wrist, result_.step);
      if (!settle_sag || round == kSagRounds || arm.cases.empty()) return arm;
      start.compliance = sagCompliance(campaign_, options_, arm);
    }
  }

  void partialPoseMethod() {
    MethodResult& out = method(Method::partial_pose);
    LoadedArm arm = swept_;
    if (campaign_.loading) {
      arm = calibratedArm();
      if (!result_.calibration.done) {
        out.reason = "the geometry cannot be calibrated: " + result_.calibration.reason;
        return;
      }
    } else {
      result_.calibration.reason =
          "the campaign has displacements only, no absolute positions: the URDF's geometry stands";
    }
    if (unknown_ == JointMask{}) {  // no swept geometry to judge by: judge in this one
      result_.identifiability =
          judgeJoints(arm.geometry, arm.cases, *campaign_.load_cell, reflectorEquations(arm), options_.trust);
      unknown_ = result_.identifiability.mask();
    }
    out.reason = commonReason(arm);
    if (!out.reason.empty()) return;
    out.estimate = solveSettled(arm, options_.finite_deflection, [&](const LoadedArm& one) {
      return partialPose(reflectorEquations(one), unknown_);
    });
    judgeMethod(arm, normalOf(reflectorEquations(arm)), false, options_.subsets, out);
    if (swept_.cases.empty()) shown_ = std::move(arm);
  }

  void decoupledMethod() {
    MethodResult& out = method(Method::decoupled_partial_pose);
    out.reason = commonReason(swept_);
    if (!out.reason.empty()) return;
    if (swept_.wrist.empty()) {
      out.reason =
          result_.frames.wrist.measured
              ? "P_wrist needs absolute readings of three reflectors of known radius in every posture"
              : "the wrist centre is not measured: " + result_.frames.wrist.reason;
      if (!campaign_.wrist_sweep) {
        out.reason += "; measure a wrist sweep (axes 4-6 moving) and `loading` with three reflectors";
      }
      return;
    }
    out.estimate = solveSettled(swept_, options_.finite_deflection, [&](const LoadedArm& arm) {
      return decoupledPartialPose(wristPointEquations(arm), reflectorEquations(arm), unknown_);
    });
    const double leak = wristLeak(out.estimate.compliance);
    if (leak > kMissMatters) {
      out.reason = fmt::format(
          "the wrist's axes do not meet (4 and 5 miss by {:.3f} mm, 5 and 6 by {:.3f} mm): turning in joints "
          "4-6 moves "
          "P_wrist by {:.1f} % of its displacement, more than the {:.0f} % that decoupling bears",
          1e3 * result_.frames.wrist.miss_45, 1e3 * result_.frames.wrist.miss_56, 100.0 * leak,
          100.0 * kMissMatters);
      return;
    }
    judgeMethod(swept_, normalOf(wristPointEquations(swept_)), true, options_.subsets, out);
  }

  /// Share of P_wrist's displacement that joints 4-6 put there because their axes miss each other.
  double wristLeak(const Vector6d& compliance) const {
    Vector6d wrist_only = compliance;
    wrist_only.head<3>().setZero();
    double leak = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < swept_.cases.size(); ++i) {
      // The wrist centre where the arm's geometry has it, so that only the axes' miss counts.
      const Eigen::Vector3d centre =
          swept_.cases[i].posture.motion[3] * result_.frames.wrist.centre_at_zero_in_r0;
      leak += (pointRows(swept_.geometry, swept_.cases[i], centre, swept_.torques[i]) * wrist_only).norm();
      whole += swept_.wrist[i].displacement().norm();
    }
    return whole > 0.0 ? leak / whole : 0.0;
  }

  void describeCampaign() {
    const LoadedArm& shown = swept_.cases.empty() ? shown_ : swept_;
    const MethodResult& reference = firstAvailable();
    result_.cases = shown.cases;
    result_.wrist = shown.wrist;
    for (const WristMove& move : shown.wrist)
      result_.wrist_displacement.push_back(move.displacement().norm());
    for (const LoadCase& load_case : shown.cases) {
      double sum = 0.0;
      for (const TargetMove& move : load_case.targets) sum += move.displacement().norm();
      result_.target_displacement.push_back(sum / static_cast<double>(load_case.targets.size()));
      result_.servo_change = std::max(result_.servo_change, load_case.servo.cwiseAbs().maxCoeff());
    }
    result_.noise = noiseShare(campaign_, shown.geometry, shown.cases, shown.wrist,
                               result_.frames.wrist.radii, result_.frames.wrist.centre_at_zero_in_r0);
    if (!reference.available) return;
    const auto plain = jointTorques(shown.geometry, shown.cases);
    const auto full =
        jointTorquesWithGeometricStiffness(shown.geometry, shown.cases, reference.estimate.compliance);
    double change = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      change += (full[i] - plain[i]).squaredNorm();
      whole += plain[i].squaredNorm();
    }
    if (whole > 0.0) result_.geometric_stiffness_share = std::sqrt(change / whole);
  }

  const MethodResult& firstAvailable() const {
    for (const Method which : {Method::decoupled_partial_pose, Method::partial_pose, Method::complete_pose}) {
      if (result_.of(which).available) return result_.of(which);
    }
    return result_.of(Method::partial_pose);
  }

  const Campaign& campaign_;
  const IdentifyOptions options_;
  Identification result_;
  LoadedArm swept_;
  LoadedArm shown_;  // the calibrated arm, where no sweep gives one
  JointMask unknown_{};
};

}  // namespace

Frames settledFrames(const Campaign& campaign) {
  const bool loads = campaign.states && campaign.load_cell && campaign.loading && heaviestStep(campaign);
  return loads ? Identifier(campaign, {}).frames() : measureFrames(campaign);
}

Identification identify(const Campaign& campaign, const IdentifyOptions& options) {
  return Identifier(campaign, options).run();
}

}  // namespace stiffscope
