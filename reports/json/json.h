#pragma once

#include <vector>

#include "reports/json/json_document.h"

// Results as JSON, a function a command.

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
struct StiffnessChange;
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
struct ExtendedModel;
}
namespace stiffscope::interchange {
struct TaughtProgram;
}
namespace stiffscope::mistakes {
struct ModelAgreement;
}
namespace stiffscope::frames {
struct Frames;
}
namespace stiffscope::identification {
enum class Method;
}
namespace stiffscope::planning {
struct Plan;
struct UnloadedPlan;
}  // namespace stiffscope::planning
namespace stiffscope::preparation {
enum class AuditVerdict;
}
namespace stiffscope::simulation {
struct SimulationSpec;
}
namespace stiffscope::toolpath {
struct CompensatedPath;
struct PathJob;
}  // namespace stiffscope::toolpath
namespace stiffscope::validation {
struct BlindOptions;
struct BlindResult;
}  // namespace stiffscope::validation
namespace stiffscope::workspace {
struct WorkspaceStiffness;
}

namespace stiffscope::reports {

struct StatedComparison;

struct ReportContent;

/// Which joint angles a calibration stands on, and, where the log has both kinds, how well either predicts.
Json anglesJson(const calibration::Calibration& calibration);

/// The result of `calibrate`: folds, postures, models (each: effects by id, parts with their sizes, fitted and held-out
/// errors in mm), rejected readings, axes of the geometry in base_link with their standard uncertainties,
/// not_identifiable, base, reflectors, Denavit and Hartenberg's parameters beside the URDF's, stiffness where masses
/// are known.
Json calibrationJson(const campaign::Campaign& campaign, const calibration::Calibration& calibration,
                     const calibration::CalibrationOptions& options);

/// One method's part of `compare`, joint by joint; `ratios_hold`: what joint springs leave is noise.
Json changeJson(const comparison::StiffnessChange& change, bool ratios_hold);

/// The result of `compare` of two result files.
Json statedComparisonJson(const StatedComparison& comparison);

/// The result of `compare`. `joints` are those of the best method that both campaigns have (`method`); all of
/// them stand under `methods`.
Json comparisonJson(const campaign::Campaign& before, const campaign::Campaign& after,
                    const comparison::Comparison& comparison);

/// The result of `compare` of two days without a load: comparable, postures (before, after, common), same_postures,
/// effects (ids fitted beside both geometries), effects_p_value (of unchanged ones), left_mm, machine (changed, chi2,
/// numbers, p_value, at_targets_mm, sd_at_targets_mm), numbers (each: number "joint_zero", "along", "distance",
/// "twist", "tilt", or of coupled axes on one line "off_x", "off_y", "tilt_x", "tilt_y", joint or axes, difference,
/// sd_difference, u_difference, unit, p_value, p_value_holm, at_targets_mm; null and reason where a day does not see
/// it), reflectors (moved, p_value, targets with shift_in_flange_mm), base (machine_change false, shift_mm, turn_deg),
/// cause (the best of causes where it leaves chance alone, else null), causes (each: cause "joint_zero", "link",
/// "axis", "growth", "reflectors" or "turn_about_6" (the last axis), joint, link or axis, unknowns, chi2, left_p_value,
/// bic, size with sd and unit where it has one number, at_targets_mm), cautions.
Json geometryChangeJson(const campaign::Campaign& before, const campaign::Campaign& after,
                        const comparison::GeometryChange& change);

/// The result of `compensate`: a row a posture (of machines of fewer than six joints with remaining_turn_deg, what the
/// commands leave of the flange's turn), and the summary. `known`: stiffnesses from elsewhere that stand in for
/// joints which the day cannot see.
Json compensationJson(const campaign::Campaign& campaign, identification::Method method,
                      const std::vector<compensation::CompensatedPosture>& postures,
                      const std::vector<campaign::KnownStiffness>& known);

/// The result of `compensate --path`: that of `compensate`, its P_TCP the tool's tip; in each row besides, in the
/// workpiece's axes, along_mm, tip_mm, process (force_n, moment_nm about the tip), deflection_in_workpiece_mm, offset
/// (shift_mm, rotation_deg: to add to the programmed pose), and turn_deg, joint_torque_nm, limit_margin_deg (of joint
/// nearest_limit); joints (reached, branches, turn_free).
Json pathJson(const campaign::Campaign& campaign, identification::Method method, const toolpath::PathJob& job,
              const toolpath::CompensatedPath& path, const std::vector<campaign::KnownStiffness>& known);

/// Adds `program` to the result of `compensate`: file, out (null: not written), format, replaced, rounding_mm, in_space
/// (lines of targets that were left).
Json withProgram(Json json, const interchange::TaughtProgram& program, const std::string& out,
                 const std::vector<compensation::CompensatedPosture>& targets, double rounding);

/// The result of `stiffness`: method, model_holds_besides_joints (effects by id), unknown_joints, notes, postures and
/// slice.places (each: q_deg, tcp_m, conditioning, k_x and model: principal stiffnesses, softest first, with interval
/// and direction; both compliances), placement (where a force was given: force_n, best, now, offsets). R0.
/// In `results.json` of a report without `slice.places`, which are many and in its CSV.
enum class SlicePlaces { kept, left_out };
Json workspaceJson(const workspace::WorkspaceStiffness& found, SlicePlaces places = SlicePlaces::kept);

/// The result of `diagnose`. `verdict` is a list of lists of effect ids: the outer names all that is present,
/// an inner one what this data cannot tell apart; [["none"]], or ["unknown"] among them.
Json diagnosisJson(const campaign::Campaign& campaign, const diagnosis::Diagnosis& diagnosis);

/// The result of `diagnose` on a day without a load, under the same keys: the gap is of the unloaded positions,
/// `before` with the geometry calibrated (held out), with `nominal_um` beside it; `parameters` of a class are lists of
/// terms with value and standard uncertainty in SI units.
Json accuracyJson(const campaign::Campaign& campaign, const accuracy::AccuracyDiagnosis& accuracy);

/// Adds `next`: measurements that would tell effects apart, or make one testable.
Json withNext(Json json, const std::vector<diagnosis::NextMeasurement>& measurements);

/// The result of `diagnose --spike`: that of `diagnose` with `spike`: seed, draws, baseline (the verdict without any
/// effect added), effects (effect, detectable_um and reason where it was not added, in_baseline, sizes: times, size_um,
/// draws, named, part_named, class_size, other_named, unknown, others by id). Counts are of draws.
Json withSpikes(Json diagnosis, const diagnosis::SpikeStudy& study);

/// The result of `frames`: R0, axes, link lengths, wrist centre with Table I, P_TCP. Axes, points and the wrist stand
/// in R0 with all joints at zero unless the key says otherwise; what was not measured is null with a reason, or the
/// URDF's, and then `from` beside it says "nominal" (or "partly nominal", between a measured axis and one that was
/// not).
Json framesJson(const campaign::Campaign& campaign, const frames::Frames& frames);

/// The result of `plan`: a row a posture, and what random postures would give.
Json planJson(const campaign::Campaign& campaign, const planning::Plan& plan);

/// Adds `reading_deg` to a planned posture or a command: the angles as the controller states them, where the campaign
/// says how.
void addReading(const campaign::Campaign& campaign, const JointVector& q, Json& row);

/// The result of `plan --unloaded`: rows (a posture each, in the order of the day: predicted_mm with it and all before,
/// gain: by how much the variance grows without it, a share), predicted_mm and predicted_geometry_mm (rms uncertainty
/// of a 3-D position over the workspace, effects free and not), effects (effect, detail, detectable_mm, inflation; null
/// where they are not seen), random and random_twice (the same, medians).
Json unloadedPlanJson(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan);

/// `results.json` of a report: the names of the files it wrote, per campaign what was done to the readings and the
/// results of `audit`, `frames` and `identify`, and what the double encoders avoid. The content has to live as long.
JsonDocument resultsJson(const ReportContent& content);

/// Keys: seal, answers_sha256, seed, as_is_share, cases (list: truth, sizes in noises, true stiffnesses, answer, found,
/// right), confusion (truths, answers, counts: rows are truths), rates (by id: meaning, hits, trials, value, low, high
/// at 95 %, value null without trials), by_size, effects, outside, as_is, shrink (promised against true).
Json blindJson(const validation::BlindOptions& options, const validation::BlindResult& result);

/// truth.json of `simulate`: what the machine truly is, drawn values included, under the keys that `identify` and
/// `frames` have for what they find of it (stiffness_nm_per_rad, axes, links), SI otherwise. `effects`: what it has
/// besides joint springs, one entry a mechanism. Null: rigid. docs/simulation-format.md lists the keys.
Json truthJson(const simulation::SimulationSpec& spec);

/// The result of `audit`: verdict, checks with figure and limit (null where not testable), rejected readings.
Json auditJson(const campaign::Campaign& campaign, const audit::AuditReport& report);
/// Adds that the day contradicts the model, with what would mend it; nothing where it does not.
Json withAgreement(Json result, const mistakes::ModelAgreement& agreement);

/// `pass`, `warn`, `fail` or `not_testable`.
const char* nameOf(preparation::AuditVerdict verdict);

/// `with`: the effects added to the joint springs, what they explain, and each method without and with them.
Json extendedModelJson(const extended_model::ExtendedModel& model, const std::vector<identification::Method>& methods);

/// `model` of the model that the data support (its effects, what springs alone and the model leave of the noise's
/// chi-square, whether that is explained), `apparent` (each method by joint springs alone) and, in each of `methods`,
/// `budget`: rows {source, in_model, u_nm_per_rad, dof: by joint}.
Json withSupport(Json json, const extended_model::ExtendedModel& model,
                 const std::vector<identification::Method>& methods);

/// A result with that key.
Json withEffects(Json json, const extended_model::ExtendedModel& model,
                 const std::vector<identification::Method>& methods);

}  // namespace stiffscope::reports
