#include "core/identification/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"
#include "core/input/input_error.h"

namespace stiffscope {

namespace {

constexpr int kSagRounds = 3;
constexpr double kMissMatters = 0.02;  // share of P_wrist's displacement that a wrist's miss may put there

/// The load cases and equations of one geometry.
struct System {
  LoadingGeometry geometry;
  std::vector<LoadCase> cases;
  std::vector<WristMove> wrist;       // one a case, or empty
  std::vector<Vector6d> torques;
};

System makeSystem(const Campaign& campaign, const LoadingGeometry& geometry, const WristCentre& wrist, int step,
                  std::vector<std::string>* left_out) {
  System system{geometry, loadCases(campaign, geometry, step, left_out), {}, {}};
  if (wrist.measured) {
    for (const LoadCase& load_case : system.cases) {
      const auto move = wristMove(load_case, wrist.radii, wrist.centre_at_zero_in_r0);
      if (!move) {
        system.wrist.clear();
        break;
      }
      system.wrist.push_back(*move);
    }
  }
  system.torques = jointTorques(geometry, system.cases);
  return system;
}

std::vector<CaseEquations> reflectorEquations(const System& system) {
  std::vector<CaseEquations> equations;
  for (std::size_t i = 0; i < system.cases.size(); ++i) {
    equations.push_back(partialPoseEquations(system.geometry, system.cases[i], system.torques[i]));
  }
  return equations;
}

std::vector<CaseEquations> wristPointEquations(const System& system) {
  std::vector<CaseEquations> equations;
  for (std::size_t i = 0; i < system.wrist.size(); ++i) {
    equations.push_back(wristEquations(system.geometry, system.cases[i], system.wrist[i], system.torques[i]));
  }
  return equations;
}

std::vector<CaseEquations> poseEquations(const System& system, const Eigen::Vector3d& tcp_in_flange) {
  std::vector<CaseEquations> equations;
  for (std::size_t i = 0; i < system.cases.size(); ++i) {
    equations.push_back(completePoseEquations(system.geometry, system.cases[i], tcp_in_flange, system.torques[i]));
  }
  return equations;
}

/// Solves by one method. For the finite deflection the equations are made again with the torque (K_c, and the wrench
/// turned with the flange where its turn is not measured) and the middle posture that the last estimate implies.
template <class Solve>
StiffnessEstimate solveWith(System& system, bool finite_deflection, const Solve& solve) {
  for (LoadCase& load_case : system.cases) {
    load_case.middle.reset();
    if (load_case.wrench_turns_with != 0) load_case.wrench = load_case.wrench_unturned;
  }
  system.torques = jointTorques(system.geometry, system.cases);
  StiffnessEstimate estimate = solve(system);
  constexpr int kRounds = 2;  // K_c is about a hundredth: two rounds leave a millionth
  for (int round = 0; finite_deflection && round < kRounds; ++round) {
    system.torques = jointTorquesWithGeometricStiffness(system.geometry, system.cases, estimate.compliance);
    turnWrenches(system.geometry, estimate.compliance, system.torques, system.cases);
    system.torques = jointTorquesWithGeometricStiffness(system.geometry, system.cases, estimate.compliance);
    takeJacobiansAtMiddle(system.geometry, estimate.compliance, system.torques, system.cases);
    estimate = solve(system);
  }
  return estimate;
}

class Identifier {
 public:
  Identifier(const Campaign& campaign, const IdentifyOptions& options) : campaign_(campaign), options_(options) {}

  Identification run() {
    chooseStep();
    settleFrames();
    judge();
    completePoseMethod();
    partialPoseMethod();
    decoupledMethod();
    describeCampaign();
    return std::move(result_);
  }

 private:
  MethodResult& method(Method which) { return result_.methods[static_cast<std::size_t>(which)]; }

  InputPlace inFile(const std::string& file) const { return {(campaign_.folder / file).string(), 0, {}}; }

  void chooseStep() {
    if (!campaign_.states || !campaign_.load_cell) {
      throw InputError(inFile("campaign.xml"), "",
                       !campaign_.states ? "no 'states': joint angles and load-cell readings are needed to identify"
                                         : "no 'load_cell': where the measured wrench acts is needed to identify");
    }
    if (!campaign_.loading && !campaign_.displacements) {
      throw InputError(inFile("campaign.xml"), "",
                       "neither 'loading' nor 'displacements': readings under load are needed to identify");
    }
    const auto heaviest = heaviestStep(campaign_);
    if (options_.step) {
      const auto& rows = campaign_.states->rows;
      const bool known = *options_.step != 0 && std::any_of(rows.begin(), rows.end(), [&](const State& state) {
        return state.step == *options_.step;
      });
      if (!known) {
        throw InputError(inFile(campaign_.states->file), std::to_string(*options_.step), "not a load step of this campaign");
      }
    } else if (!heaviest) {
      throw InputError(inFile(campaign_.states->file), "", "no load step has a force");
    }
    result_.step = options_.step ? *options_.step : *heaviest;
    result_.finite_deflection = options_.finite_deflection;
  }

  /// Frames and a first stiffness in turns, until the sag in the sweeps is that of the stiffness.
  void settleFrames() {
    result_.frames = measureFrames(campaign_);
    for (int round = 0;; ++round) {
      swept_ = makeSystem(campaign_, sweptGeometry(campaign_, result_.frames, sag_), result_.frames.wrist, result_.step,
                          nullptr);
      const bool last = round == kSagRounds || !result_.frames.weight.links_known || swept_.cases.empty();
      if (last) break;
      const JointMask seen = judgeJoints(swept_.geometry, swept_.cases, *campaign_.load_cell,
                                         reflectorEquations(swept_), options_.trust).mask();
      const Vector6d next = solveWith(swept_, options_.finite_deflection, [&](const System& system) {
        return swept_.wrist.empty()
                   ? partialPose(reflectorEquations(system), seen)
                   : decoupledPartialPose(wristPointEquations(system), reflectorEquations(system), seen);
      }).compliance;
      sag_ = next.cwiseMax(0.0);  // a negative compliance would lift the arm
      result_.frames = refineFrames(campaign_, result_.frames, sag_);
    }
    result_.left_out.clear();
    swept_ = makeSystem(campaign_, sweptGeometry(campaign_, result_.frames, sag_), result_.frames.wrist, result_.step,
                        &result_.left_out);
  }

  void judge() {
    result_.identifiability = judgeJoints(swept_.geometry, swept_.cases, *campaign_.load_cell,
                                          reflectorEquations(swept_), options_.trust);
    unknown_ = result_.identifiability.mask();
  }

  /// What all methods need; the reason where it is not there.
  std::string commonReason(const System& system) const {
    if (system.cases.empty()) {
      return campaign_.loading && !system.geometry.r0_from_loading
                 ? "the loading's readings cannot be brought into R0: circle sweeps of axes 1 and 2 would place them"
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
    const bool poses = std::all_of(swept_.cases.begin(), swept_.cases.end(), [](const LoadCase& load_case) {
      return load_case.flange_unloaded && load_case.flange_loaded;
    });
    if (!poses) {
      out.reason = swept_.cases.front().absolute
                       ? "a flange pose needs three reflectors, placed by circle sweeps, in every posture"
                       : "a flange pose needs absolute positions of three reflectors; this campaign has displacements "
                         "of " + std::to_string(campaign_.targets.size()) + " point(s): measure `loading` with three";
      return;
    }
    const Eigen::Vector3d tcp = result_.frames.tcp_in_flange;
    result_.characteristic_length = characteristicLength(swept_.geometry, swept_.cases, tcp);
    const double length = result_.characteristic_length.length;
    out.estimate = solveWith(swept_, options_.finite_deflection, [&](const System& system) {
      return completePose(poseEquations(system, tcp), length, unknown_);
    });
    constexpr int kEvery = 5;
    const std::vector<CaseEquations> equations = poseEquations(swept_, tcp);
    for (std::size_t i = 0; i < result_.characteristic_length.curve.size(); i += kEvery) {
      const auto& [at, condition] = result_.characteristic_length.curve[i];
      result_.length_sensitivity.push_back({at, condition, completePose(equations, at, unknown_).compliance});
    }
    study(out, swept_, equations, length);
  }

  /// The system in the calibrated geometry. Where no sweep gave stiffnesses for the own weight's sag, calibration and
  /// stiffnesses are found in turns here, or the sag would be taken for geometry.
  System calibratedSystem() {
    LoadingGeometry start = swept_.geometry;
    const bool settle_sag = swept_.cases.empty() && result_.frames.weight.links_known;
    for (int round = 0;; ++round) {
      result_.calibration = calibrateGeometry(campaign_, start);
      if (!result_.calibration.done) return swept_;
      System system =
          makeSystem(campaign_, result_.calibration.geometry, result_.frames.wrist, result_.step, nullptr);
      if (!settle_sag || round == kSagRounds || system.cases.empty()) return system;
      const JointMask seen = judgeJoints(system.geometry, system.cases, *campaign_.load_cell,
                                         reflectorEquations(system), options_.trust).mask();
      start.compliance = solveWith(system, options_.finite_deflection, [&](const System& one) {
        return partialPose(reflectorEquations(one), seen);
      }).compliance.cwiseMax(0.0);
    }
  }

  void partialPoseMethod() {
    MethodResult& out = method(Method::partial_pose);
    System system = swept_;
    if (campaign_.loading) {
      system = calibratedSystem();
      if (!result_.calibration.done) {
        out.reason = "the geometry cannot be calibrated: " + result_.calibration.reason;
        return;
      }
    } else {
      result_.calibration.reason = "the campaign has displacements only, no absolute positions: the URDF's geometry stands";
    }
    if (unknown_ == JointMask{}) {  // no swept geometry to judge by: judge in this one
      result_.identifiability =
          judgeJoints(system.geometry, system.cases, *campaign_.load_cell, reflectorEquations(system), options_.trust);
      unknown_ = result_.identifiability.mask();
    }
    out.reason = commonReason(system);
    if (!out.reason.empty()) return;
    out.estimate = solveWith(system, options_.finite_deflection, [&](const System& one) {
      return partialPose(reflectorEquations(one), unknown_);
    });
    study(out, system, reflectorEquations(system), 0.0);
  }

  void decoupledMethod() {
    MethodResult& out = method(Method::decoupled_partial_pose);
    out.reason = commonReason(swept_);
    if (!out.reason.empty()) return;
    if (swept_.wrist.empty()) {
      out.reason = result_.frames.wrist.measured
                       ? "P_wrist needs absolute readings of three reflectors of known radius in every posture"
                       : "the wrist centre is not measured: " + result_.frames.wrist.reason;
      if (!campaign_.wrist_sweep) {
        out.reason += "; measure a wrist sweep (axes 4-6 moving) and `loading` with three reflectors";
      }
      return;
    }
    out.estimate = solveWith(swept_, options_.finite_deflection, [&](const System& system) {
      return decoupledPartialPose(wristPointEquations(system), reflectorEquations(system), unknown_);
    });
    const double leak = wristLeak(out.estimate.compliance);
    if (leak > kMissMatters) {
      out.reason = fmt::format(
          "the wrist's axes do not meet (4 and 5 miss by {:.3f} mm, 5 and 6 by {:.3f} mm): turning in joints 4-6 moves "
          "P_wrist by {:.1f} % of its displacement, more than the {:.0f} % that decoupling bears",
          1e3 * result_.frames.wrist.miss_45, 1e3 * result_.frames.wrist.miss_56, 100.0 * leak, 100.0 * kMissMatters);
      return;
    }
    study(out, swept_, wristPointEquations(swept_), 0.0);
  }

  /// Share of P_wrist's displacement that joints 4-6 put there because their axes miss each other.
  double wristLeak(const Vector6d& compliance) const {
    Vector6d wrist_only = compliance;
    wrist_only.head<3>().setZero();
    double leak = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < swept_.cases.size(); ++i) {
      // The wrist centre where the arm's geometry has it, so that only the axes' miss counts.
      const Eigen::Vector3d centre = swept_.cases[i].posture.motion[3] * result_.frames.wrist.centre_at_zero_in_r0;
      leak += (pointRows(swept_.geometry, swept_.cases[i], centre, swept_.torques[i]) * wrist_only).norm();
      whole += swept_.wrist[i].displacement().norm();
    }
    return whole > 0.0 ? leak / whole : 0.0;
  }

  /// Judges a solved method on all postures and on subsets. `fitted` are the equations that the method solves: CP's pose
  /// equations (with the length), PP's reflectors, DPP's P_wrist.
  void study(MethodResult& out, const System& system, const std::vector<CaseEquations>& fitted, double length) {
    out.available = true;
    out.geometry = system.geometry;
    out.wrist_rows = wristPointEquations(system);
    out.target_rows = reflectorEquations(system);
    SubsetMethod subset;
    subset.unknown = unknown_;
    for (const CaseEquations& one : fitted) {
      subset.normal.push_back(normalEquations(length > 0.0 ? normalised(one, length) : one));
    }
    if (&out == &method(Method::decoupled_partial_pose)) {
      for (const CaseEquations& one : out.target_rows) subset.reflectors.push_back(normalEquations(one));
    }
    if (!out.wrist_rows.empty()) subset.at_wrist = DeflectionJudge(out.wrist_rows);
    subset.at_targets = DeflectionJudge(out.target_rows);
    out.subsets = studySubsets(subset, options_.subsets);
    if (!out.wrist_rows.empty()) {
      out.at_wrist = Compensation{subset.at_wrist.compensated(out.estimate.compliance), out.subsets.at_wrist};
      out.wrist_residual = subset.at_wrist.residual(out.estimate.compliance);
    }
    out.at_targets = Compensation{subset.at_targets.compensated(out.estimate.compliance), out.subsets.at_targets};
    out.target_residual = subset.at_targets.residual(out.estimate.compliance);
    for (std::size_t i = 0; i < out.target_residual.size(); ++i) {
      out.target_residual[i] /= subset.at_targets.pointsOf(i);
    }
  }

  void describeCampaign() {
    const MethodResult& reference = firstAvailable();
    result_.cases = swept_.cases;
    result_.wrist = swept_.wrist;
    for (const WristMove& move : swept_.wrist) result_.wrist_displacement.push_back(move.displacement().norm());
    for (const LoadCase& load_case : swept_.cases) {
      double sum = 0.0;
      for (const TargetMove& move : load_case.targets) sum += move.displacement().norm();
      result_.target_displacement.push_back(sum / static_cast<double>(load_case.targets.size()));
      result_.servo_change = std::max(result_.servo_change, load_case.servo.cwiseAbs().maxCoeff());
    }
    result_.noise = noiseShare(campaign_, swept_.geometry, swept_.cases, swept_.wrist, result_.frames.wrist.radii,
                               result_.frames.wrist.centre_at_zero_in_r0);
    if (!reference.available) return;
    const auto plain = jointTorques(swept_.geometry, swept_.cases);
    const auto full =
        jointTorquesWithGeometricStiffness(swept_.geometry, swept_.cases, reference.estimate.compliance);
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
  const IdentifyOptions& options_;
  Identification result_;
  System swept_;
  Vector6d sag_ = Vector6d::Zero();
  JointMask unknown_{};
};

}  // namespace

Identification identify(const Campaign& campaign, const IdentifyOptions& options) {
  return Identifier(campaign, options).run();
}

}  // namespace stiffscope
