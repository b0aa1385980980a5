#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/frames/geometry_calibration.h"
#include "core/identification/complete_pose.h"
#include "core/identification/noise_share.h"
#include "core/identification/outliers.h"
#include "core/identification/subsets.h"
#include "core/identification/transmission.h"

namespace stiffscope::identification {

enum class Method { complete_pose = 0, partial_pose = 1, decoupled_partial_pose = 2 };

inline constexpr std::array<Method, 3> kMethods{Method::complete_pose, Method::partial_pose,
                                                Method::decoupled_partial_pose};

struct IdentifyOptions {
  std::optional<int> step;  ///< load step; empty: the one with the largest mean force
  bool all_steps = false;   ///< all load steps together, a posture's as one block; returns to zero are none
  /// Include K_c of (4), which has no free parameter, and take Jacobians at the middle of the displacement;
  /// false: neglect K_c and take them unloaded, as the paper does.
  bool finite_deflection = true;
  SubsetOptions subsets;
  PostureBootstrapOptions bootstrap;
  TrustLimits trust;
  bool papers_choice = false;  ///< show first the paper's method, DPP, where it can be had, whatever it compensates
  bool robust = false;         ///< leave postures out that disagree with the rest (outliers.h); they are always named
  /// Estimates with their scatter, equations and frames, and nothing that judges them: no shares, residuals, subsets
  /// and lengths, no outlying postures, no part of the uncertainty that postures share. For where these alone are
  /// looked at.
  bool estimates_only = false;
  /// One method alone: the decoupled one, by which the own weight's sag is taken off, or Partial Pose where it cannot
  /// be had. For where frames are all that is looked at.
  bool for_frames = false;
};

/// Deflection compensated by the estimate from all postures, and over the subsets.
struct Compensation {
  double all_postures = 0.0;   ///< identified on all, judged on all
  SubsetCompensation subsets;  ///< means over the subsets: on the postures used, on those held out, on all
  double held_out_sd = std::numeric_limits<double>::quiet_NaN();  ///< of subsets.held_out, over the subsets
};

struct MethodResult {
  bool available = false;
  Remark reason;  ///< why not, and what measurement would make it available
  StiffnessEstimate estimate;
  frames::LoadingGeometry geometry;        ///< the method's own
  std::vector<CaseEquations> wrist_rows;   ///< P_wrist's equations in that geometry; empty where not measured
  std::vector<CaseEquations> target_rows;  ///< the reflectors'
  std::vector<CaseEquations> pose_rows;    ///< Complete Pose's own, not normalised; empty for the other methods
  std::vector<double> wrist_residual;      ///< |displacement left| of P_wrist, per load case, m
  std::vector<double> target_residual;     ///< the same, mean over the reflectors
  std::optional<Compensation> at_wrist;    ///< empty where P_wrist is not measured
  std::optional<Compensation> at_targets;
  SubsetStudy subsets;
  PostureBootstrap bootstrap;  ///< empty where it is not asked for
};

/// Complete Pose's result against the characteristic length (L is not unique).
struct LengthSensitivity {
  double length = 0.0;     ///< m
  double condition = 0.0;  ///< of the stacked normalised Jacobian
  JointVector compliance;
  std::size_t subsets = 0;                 ///< over which it is judged: fewer than a method is
  std::optional<Compensation> at_wrist;    ///< empty where P_wrist is not measured
  std::optional<Compensation> at_targets;  ///< the reflectors
};

/// The method whose numbers people read first.
struct ShownFirst {
  enum class Judged { not_at_all, at_reflectors, at_wrist };

  Method method = Method::complete_pose;
  Judged judged = Judged::not_at_all;  ///< where held-out shares decided
  Remark reason;
};

struct Identification {
  int step = 0;                             ///< the one with the largest mean force of those used
  std::vector<int> steps;                   ///< used, together
  frames::Frames frames;                    ///< the own weight's sag taken off where it can be
  frames::LoadingGeometry geometry;         ///< the swept one; without sweeps, the calibrated
  std::vector<LoadCase> cases;              ///< in that geometry
  std::vector<LeftOutPosture> left_out;     ///< postures that are not used, with the reason
  std::vector<OutlyingPosture> outlying;    ///< disagree with the rest; used nevertheless, unless `robust`
  bool robust = false;                      ///< `outlying` are left out
  std::vector<WristMove> wrist;             ///< one a case; empty where P_wrist is not measured
  std::vector<double> wrist_displacement;   ///< |displacement| of P_wrist, uncompensated, per case, m
  std::vector<double> target_displacement;  ///< the same, mean over the reflectors
  Identifiability identifiability;
  frames::GeometryCalibration calibration;
  CharacteristicLength characteristic_length;
  std::vector<LengthSensitivity> length_sensitivity;
  std::optional<LengthSensitivity> residual_length;  ///< at the L of the residual variances (method_runs.h)
  std::array<MethodResult, 3> methods;               ///< by Method
  std::optional<ShownFirst> shown_first;             ///< empty without an available method
  std::optional<NoiseShare> noise;
  std::optional<Transmission> transmission;  ///< gears by their two encoders; empty without second encoders
  std::vector<Remark> cautions;              ///< warningsOf this result
  double servo_change = 0.0;                 ///< largest change of a reported joint angle under load, rad
  double geometric_stiffness_share = 0.0;    ///< rms change of the joint torques by K_c, relative
  bool finite_deflection = true;

  Identification() = default;  ///< of no machine yet
  /// Of so many joints, nothing identified.
  explicit Identification(int joints) {
    identifiability.joints.resize(static_cast<std::size_t>(joints));
    for (MethodResult& method : methods) method.estimate = StiffnessEstimate(joints);
  }

  const MethodResult& of(Method method) const { return methods[static_cast<std::size_t>(method)]; }
};

/// Of methods between which the data does not decide, in this order.
inline constexpr std::array<Method, 3> kMethodsOfEquals{Method::decoupled_partial_pose, Method::partial_pose,
                                                        Method::complete_pose};

/// The method whose result stands for a campaign where one must: the one shown first, where that is among `methods`;
/// else of these the first available in the order of equals. Empty where none is available.
std::optional<Method> bestMethodOf(const Identification& result, std::span<const Method> methods);

/// That method with the reason; one that was asked for alone is first as asked.
std::optional<ShownFirst> shownFirstOf(const Identification& result, std::span<const Method> methods);

/// bestMethodOf all; Complete Pose where none is available. `result.of(method)` says `available`.
Method bestMethod(const Identification& result);

}  // namespace stiffscope::identification
