#pragma once

#include <string>
#include <vector>

// Results for a terminal: plain text, no line over 100 columns but for names from the campaign.

namespace stiffscope::accuracy {
struct AccuracyDiagnosis;
}
namespace stiffscope::audit {
struct AuditReport;
}
namespace stiffscope::calibration {
struct Calibration;
struct CalibrationOptions;
}  // namespace stiffscope::calibration
namespace stiffscope::campaign {
struct Campaign;
struct KnownStiffness;
}  // namespace stiffscope::campaign
namespace stiffscope::comparison {
struct Comparison;
struct GeometryChange;
}  // namespace stiffscope::comparison
namespace stiffscope::compensation {
struct CompensatedPosture;
}
namespace stiffscope::diagnosis {
struct Diagnosis;
struct NextMeasurement;
struct SpikeStudy;
}  // namespace stiffscope::diagnosis
namespace stiffscope::extended_model {
struct EffectFit;
struct ExtendedModel;
}  // namespace stiffscope::extended_model
namespace stiffscope::frames {
struct Frames;
}
namespace stiffscope::interchange {
struct TaughtProgram;
}
namespace stiffscope::mistakes {
struct ModelAgreement;
}
namespace stiffscope::identification {
struct HeldOutLoads;
struct Identification;
struct StepStudy;
enum class Method;
}  // namespace stiffscope::identification
namespace stiffscope::planning {
struct Plan;
struct UnloadedPlan;
}  // namespace stiffscope::planning
namespace stiffscope::toolpath {
struct CompensatedPath;
struct PathJob;
}  // namespace stiffscope::toolpath
namespace stiffscope::validation {
struct BlindResult;
}
namespace stiffscope::workspace {
struct WorkspaceStiffness;
}

namespace stiffscope::reports {

struct ShapeFit;
struct StatedComparison;

/// The audit for people: a table of the checks, then what those that did not pass say, then the rejected
/// readings.
std::string auditText(const campaign::Campaign& campaign, const audit::AuditReport& report);
/// That the day contradicts the model, and what would mend it; empty where it does not.
std::string agreementText(const mistakes::ModelAgreement& agreement);

/// The result of `diagnose` on a day without a load.
std::string accuracyText(const campaign::Campaign& campaign, const accuracy::AccuracyDiagnosis& accuracy);

/// The result of `calibrate` for a terminal.
std::string calibrationText(const campaign::Campaign& campaign, const calibration::Calibration& calibration,
                            const calibration::CalibrationOptions& options);

/// Its axes as a CSV table, a row an axis: point_x_m..point_z_m, direction_x..direction_z, standard uncertainties
/// across the axis, and the parameters to the next axis (theta_deg, d_mm, a_mm, alpha_deg, beta_deg) with the URDF's
/// beside them.
std::string calibrationCsv(const calibration::Calibration& calibration);

/// The result of `compare` of two result files.
std::string statedComparisonText(const StatedComparison& comparison);

/// The result of `compare` for a terminal.
std::string comparisonText(const campaign::Campaign& before, const campaign::Campaign& after,
                           const comparison::Comparison& comparison);

/// The comparison of two days without a load: what moved in the geometry.
std::string geometryChangeText(const campaign::Campaign& before, const campaign::Campaign& after,
                               const comparison::GeometryChange& change);

/// The result of `compensate` for a terminal, and under it what a reader must know, a sentence each.
std::string compensationText(const campaign::Campaign& campaign, identification::Method method,
                             const std::vector<compensation::CompensatedPosture>& postures,
                             const std::vector<campaign::KnownStiffness>& known,
                             const std::vector<std::string>& cautions, bool weighs_what_hides);

/// The result of `compensate --path`: joints, deflection of the tool's tip along the path without and with
/// compensation, why poses are refused, and what to know.
std::string pathText(const campaign::Campaign& campaign, identification::Method method, const toolpath::PathJob& job,
                     const toolpath::CompensatedPath& path, const std::vector<campaign::KnownStiffness>& known,
                     const std::vector<std::string>& cautions);

/// What became of a program's targets in `compensate --program`: joint targets replaced in `out`, of all that it has,
/// and those that were left, in space or computed, by their lines.
std::string programText(const interchange::TaughtProgram& program, const std::string& out,
                        const std::vector<compensation::CompensatedPosture>& targets, double rounding);

/// The diagnosis for people: the verdict with its reason, the candidates with how far each shrinks the gap,
/// where the gap lies, stiffnesses before and after, what could not be tested and what to measure next.
std::string diagnosisText(const campaign::Campaign& campaign, const diagnosis::Diagnosis& diagnosis);

/// What to measure to tell effects apart, a line each.
std::string nextText(const std::vector<diagnosis::NextMeasurement>& next);

/// How often each effect was named that was added to the day's readings, by size, and what else was said.
std::string spikeText(const diagnosis::Diagnosis& baseline, const diagnosis::SpikeStudy& study);

/// What was added to the joint springs, with which sizes, what it explains, what is done with it.
std::string addedEffectsText(const extended_model::EffectFit& effects);

/// The same with each method without and with the effects: stiffnesses, residuals, shares compensated.
std::string extendedModelText(const extended_model::ExtendedModel& model,
                              const std::vector<identification::Method>& methods);

/// The fitted shape for people: each parameter with its standard uncertainty, the residuals, and the method.
std::string fitText(const ShapeFit& fitted);

/// The result of `frames` for a terminal: plain text, no line over 100 columns but for names from the campaign.
std::string framesText(const campaign::Campaign& campaign, const frames::Frames& frames);

/// The result of `identify` for a terminal.
std::string identificationText(const campaign::Campaign& campaign, const identification::Identification& result,
                               const std::vector<identification::Method>& methods);

/// Joints whose interval is wide or open, a line each: there a symmetric uncertainty of the stiffness misleads.
std::string wideIntervals(const identification::Identification& result,
                          const std::vector<identification::Method>& methods);

/// Percentile intervals of the bootstrap beside the stated ones; empty where there is none.
std::string bootstrapText(const identification::Identification& result,
                          const std::vector<identification::Method>& methods);

/// Stiffness by load step and whether it depends on the load.
std::string stepsText(const identification::StepStudy& study, const identification::Identification& result,
                      const std::vector<identification::Method>& methods);

/// Shares compensated under load steps and directions that took no part. `effects`: some are in the model.
std::string heldOutLoadsText(const identification::HeldOutLoads& loads, const identification::Identification& result,
                             const std::vector<identification::Method>& methods, bool effects);

/// Gears by their two encoders beside what the tracker sees; of a result that has them.
std::string transmissionText(const identification::Identification& result,
                             const std::vector<identification::Method>& methods);

/// Conditioning, softest and stiffest direction at P_TCP, and what neglecting K_c costs, a line a posture.
std::string posturesText(const campaign::Campaign& campaign, const identification::Identification& result,
                         identification::Method method);

/// The result of `stiffness` for a terminal: softest and stiffest direction by posture, the slice, the placement, and
/// what the numbers hold.
std::string workspaceText(const campaign::Campaign& campaign, const workspace::WorkspaceStiffness& found);

/// Below angles of a campaign with joint readings.
inline constexpr const char* kAsControllerStates = "Angles as the controller states them (joint_reading).";

/// The result of `plan` for a terminal.
std::string planText(const campaign::Campaign& campaign, const planning::Plan& plan);

/// The planned postures as a CSV table: pose, q1_deg.. of each joint as the campaign's tables state them (joint
/// readings), the load-cell reading expected (as `compensate --postures` takes it), and the pull's direction in
/// base_link, pull_x..pull_z.
std::string planCsv(const campaign::Campaign& campaign, const planning::Plan& plan);

/// The same as the `postures` element of a simulation's specification.
std::string planXml(const planning::Plan& plan);

/// The plan of a day without a load: pose, q1_deg.. of each joint, in the order of the day.
std::string unloadedPlanText(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan);
std::string unloadedPlanCsv(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan);
std::string unloadedPlanXml(const planning::UnloadedPlan& plan);

/// The rates and, effect by effect, how many were answered right, for a terminal.
std::string blindText(const validation::BlindResult& result);

}  // namespace stiffscope::reports
