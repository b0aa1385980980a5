#include "core/diagnosis/diagnose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "core/diagnosis/confounding.h"
#include "core/diagnosis/gap_study.h"
#include "core/diagnosis/geometry_error.h"
#include "core/diagnosis/held_out.h"
#include "core/diagnosis/localization.h"
#include "core/diagnosis/verdict.h"
#include "core/io/input_error.h"
#include "core/preparation/subsample.h"
#include "core/robot/wrench.h"

namespace stiffscope::diagnosis {

namespace {

void requireLoads(const campaign::Campaign& campaign) {
  const io::InputPlace place{(campaign.folder / "campaign.xml").string(), 0, {}};
  if (!campaign.states || !campaign.load_cell) {
    throw io::InputError(place, "",
                         !campaign.states ? "no 'states': joint angles and load-cell readings are needed to diagnose"
                                          : "no 'load_cell': where the measured wrench acts is needed to diagnose");
  }
  if (!campaign.loading && !campaign.displacements) {
    throw io::InputError(place, "",
                         "neither 'loading' nor 'displacements': readings under load are needed to diagnose");
  }
  if (!identification::heaviestStep(campaign)) {
    throw io::InputError({(campaign.folder / campaign.states->file).string(), 0, {}}, "", "no load step has a force");
  }
}

constexpr double kClearOfFloor = 0.3;  // m, of the flange above base_link's origin

JointVector somePosture(const robot::Robot& arm, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.05, 0.95);
  JointVector q(arm.joints());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
    const double low = std::max(limits.lower, -std::numbers::pi), high = std::min(limits.upper, std::numbers::pi);
    q[j] = low + share(random) * (high - low);
  }
  return q;
}

/// Whitened normal equations of one more posture: unloaded, and under one force.
Eigen::MatrixXd normalOf(const SystemInput& input, const GapFit& fit, const JointVector& q,
                         const Eigen::Vector3d& force) {
  const GapPosture& like = fit.data->postures.front();
  const effects::ArmState& seen = like.states[effects::heaviestState(like.states)];
  effects::ArmState rest = effects::stateAt(fit.state.geometry, q, JointVector::Zero(q.size()));
  rest.pose = like.pose;
  rest.targets = like.states.front().targets;
  for (const int target : rest.targets) {
    rest.points.push_back(
        rest.posture.motion.back() *
        fit.state.geometry.targets_at_zero[static_cast<std::size_t>(target)].value_or(Eigen::Vector3d::Zero()));
  }
  effects::ArmState loaded = rest;
  loaded.loaded = true;
  loaded.step = 1;
  loaded.cell_axes = rest.flange.linear() * seen.flange.linear().transpose() * seen.cell_axes;
  loaded.load = {rest.flange * (seen.flange.inverse() * seen.load.point), force, Eigen::Vector3d::Zero()};
  loaded.load_torque = robot::jointTorque(fit.state.geometry.arm, rest.posture, loaded.load);
  const effects::PostureStates states{rest, loaded};
  const Eigen::Index rows = rest.rows();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, fit.data->layout.end + 1);
  columns.leftCols(fit.data->layout.joints()) = effects::byEachJoint(rest, loaded.load_torque);
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const Eigen::MatrixXd field =
        input.models[m].columns(fit.state.at, states, 1) - input.models[m].columns(fit.state.at, states, 0);
    columns.middleCols(fit.data->layout.model_at[m], field.cols()) = field;
  }
  const double sd = std::hypot(fit.data->state_noise, fit.state.model_error);
  columns /= sd > 0.0 ? sd : 1.0;
  return columns.transpose() * columns;
}

double leastSeparation(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed, const Tie& tie,
                       const Projection& projection) {
  const ChosenModel& chosen = fit.set.models[tie.chosen];
  const Eigen::Index at = fit.data->layout.model_at[chosen.model] - fit.data->layout.effects;
  const auto size = static_cast<Eigen::Index>(input.models[chosen.model].parameters());
  Eigen::VectorXd field = Eigen::VectorXd::Zero(fit.set.effects.size());
  field.segment(at, size) = fit.set.effects.segment(at, size);
  std::vector<ChosenModel> others = fit.set.models;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(tie.chosen));
  const Projection made = withField(projection, field);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const effects::Effect effect = input.models[m].effect;
    const bool tied = std::find(tie.effects.begin() + 1, tie.effects.end(), effect) != tie.effects.end();
    if (tied && allowed[m]) least = std::min(least, separation(input, fit, made, others, m, allowed));
  }
  return least;
}

/// The one more posture and load that would best tell the effects of a tie apart: of random postures within
/// the joint limits (above the floor), each pulled by the campaign's largest force along each axis of R0 at
/// the same point of the tool, that where the least of the tied effects' separations (see separation) grows
/// most. Read as the campaign reads. Empty where none helps.
std::optional<NextMeasurement> nextFor(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed,
                                       const Tie& tie, std::uint64_t seed) {
  const Eigen::MatrixXd now = sumOf(*fit.data, std::vector<double>(fit.data->postures.size(), 1.0));
  const double before = leastSeparation(input, fit, allowed, tie, project(now, fit.data->layout));
  std::mt19937_64 random(seed);
  const double force = fit.state.at.largest_force;
  const double floor = fit.state.at.r0_from_base_link.translation().z() + kClearOfFloor;
  double best = before;
  NextMeasurement next;
  constexpr int kPostures = 40;
  for (int k = 0; k < kPostures; ++k) {
    const JointVector q = somePosture(input.campaign.robot, random);
    if (effects::stateAt(fit.state.geometry, q, JointVector::Zero(q.size())).flange.translation().z() < floor) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::MatrixXd more = now + normalOf(input, fit, q, force * Eigen::Vector3d::Unit(axis));
      const double apart = leastSeparation(input, fit, allowed, tie, project(more, fit.data->layout));
      if (apart <= best) continue;
      best = apart;
      next.what = Remark(RemarkId::posture_that_separates, std::vector<double>(q.begin(), q.end()), force, axis,
                         kSeparated, before, apart);
    }
  }
  if (best <= before) return std::nullopt;
  next.separates = tie.effects;
  next.gain = best - before;
  return next;
}

class Diagnoser {
 public:
  Diagnoser(const preparation::PreparedCampaign& prepared, const GapStudy& study, const DiagnoseOptions& options)
      : prepared_(prepared),
        options_(options),
        start_(*study.start),
        input_(*study.input),
        allowed_(study.allowed),
        given_(study.given),
        held_out_(study.held_out),
        fit_(study.fit),
        result_(prepared.campaign.robot.joints()) {
    if (study.alone) alone_ = *study.alone;
    result_.not_testable = study.not_testable;
  }

  Diagnosis run() {
    result_.unusable_reason = start_.reason;
    if (!start_.reason.empty()) return std::move(result_);
    const double chance = options_.chance_limit ? *options_.chance_limit
                                                : chanceLimit(input_, fit_, allowed_, options_.chance_draws,
                                                              options_.false_alarm, options_.seed);
    fit_.rules.detect = std::max(fit_.rules.detect, chance);
    if (options_.design_only) {
      result_.usable = true;
      result_.aliases = designConfounding(input_, fit_, allowed_);
      return std::move(result_);
    }
    describe();
    decide();
    if (options_.resamples > 0 && !options_.verdict_only) shrink();
    return std::move(result_);
  }

 private:
  void describe() {
    if (alone_.data->postures.empty()) alone_ = withoutEffects(input_, start_.state, fit_);
    result_.usable = true;
    result_.postures = static_cast<int>(fit_.data->postures.size());
    for (const GapPosture& posture : fit_.data->postures) result_.states += static_cast<int>(posture.states.size());
    result_.state_noise = fit_.data->state_noise;
    result_.noise_source = start_.noise.source;
    result_.noise_factor_along = start_.noise.along_factor;
    result_.noise_factor_across = start_.noise.across_factor;
    result_.significance_limit = fit_.rules.detect;
    result_.size_limit = sizeOfDrop(fit_, fit_.rules.least_drop);
    result_.lack_of_fit = fit_.left_before.perEquation();  // as identification states it
    result_.left_over = leftPerEquation(fit_);
    result_.left_over_limit = fit_.left_limit;
    result_.model_error = fit_.model_error;
    result_.geometric_stiffness_share = start_.geometric_stiffness_share;
    before_ = stiffnessesAlone(*alone_.data, std::vector<double>(alone_.data->postures.size(), 1.0), alone_.projection);
    after_ = allParameters(fit_.nuisances, fit_.set.effects);
    result_.gap = deflectionGap(alone_, before_, fit_, after_);
    result_.positions = positionGap(alone_, before_, fit_, after_);
    result_.positions_tested = input_.absolute;
    if (options_.verdict_only) return;
    result_.at_points = gapAtPoints(*alone_.data, before_.for_deflection, *fit_.data, after_);
    asMeasured();
    result_.where = whereDeflection(input_, alone_, before_.for_deflection);
    result_.where_after = whereDeflection(input_, fit_, after_);
    result_.where_positions = wherePosition(input_, alone_, before_.for_position);
    result_.aliases = designConfounding(input_, fit_, allowed_);
    result_.detectable = detectableSizes(input_, fit_, allowed_);
    stiffnesses();
  }

  /// Where the station's motion was taken off, the gap before is that of the readings as they are.
  void asMeasured() {
    if (given_.empty()) return;
    std::optional<GapAsMeasured> raw =
        gapAsMeasured(prepared_, input_, fit_, after_, parametersWithoutEach(input_, alone_, fit_, allowed_));
    if (!raw) return;
    with_motion_ = raw->deflection.has_value();
    if (raw->deflection) result_.gap.before = *raw->deflection;
    if (raw->position) result_.positions.before = *raw->position;
    result_.as_measured = std::move(raw->by_posture);
    result_.at_points = std::move(raw->at_points);
    station_ = std::move(raw->left);
  }

  void stiffnesses() {
    Eigen::VectorXd variance = complianceVariance(fit_, input_);
    const double scale = varianceFactor(fit_);
    for (Eigen::Index j = 0; j < variance.size(); ++j) {
      const double before = before_.for_deflection[j], after = fit_.nuisances[j];
      const double sd = std::sqrt(scale * std::max(0.0, variance[j]));
      constexpr double kSeen = 3.0;  // standard deviations
      result_.identifiable[static_cast<std::size_t>(j)] = after > kSeen * sd;
      result_.stiffness_before[j] = before != 0.0 ? 1.0 / before : 0.0;
      result_.stiffness_after[j] = after != 0.0 ? 1.0 / after : 0.0;
      result_.stiffness_after_sd[j] = after != 0.0 ? sd / (after * after) : 0.0;
    }
  }

  void decide() {
    result_.geometry = geometryError(input_, fit_.state);
    const VerdictInput input{input_,       fit_,        allowed_,          start_.station, result_.geometry,
                             start_.noise, result_.gap, result_.positions, with_motion_};
    Decision decision = decideVerdict(input);
    result_.verdict = std::move(decision.verdict);
    result_.classes = std::move(decision.classes);
    if (options_.verdict_only) return;
    recipes_ = std::move(decision.recipes);
    for (const Tie& tie : decision.ties) {
      if (auto one = nextFor(input_, fit_, allowed_, tie, options_.seed)) result_.next.push_back(std::move(*one));
    }
  }

  /// Of the whole selection, which may be known, then of each class.
  std::vector<HeldOutShrink> heldOut() const {
    const bool known = held_out_ && held_out_->detect == fit_.rules.detect &&
                       held_out_->resamples == options_.resamples && held_out_->seed == options_.seed;
    std::vector<FitRecipe> recipes;
    if (!known) recipes.push_back({true, {}});
    for (const auto& models : recipes_) recipes.push_back({false, models});
    auto held_out = heldOutShrinks(input_, alone_, fit_, allowed_, recipes, options_.resamples, options_.seed);
    if (known) held_out.insert(held_out.begin(), held_out_->shrink);
    return held_out;
  }

  void shrink() {
    const std::vector<HeldOutShrink> held_out = heldOut();
    result_.shrink_together = held_out[0].deflection;
    HeldOutShrink station;
    if (!station_.empty()) {
      station = shrinkOver(station_, options_.resamples, options_.seed);
      result_.shrink_together = station.deflection;
    }
    for (std::size_t i = 0; i < result_.classes.size(); ++i) {
      EffectClass& one = result_.classes[i];
      // Where the selection found just this class, its interval repeats that selection. What else it found, and the
      // verdict does not name, is not this one's.
      const bool alone = one.in_verdict && recipes_[i] == fit_.set.models;
      const HeldOutShrink& own = alone ? held_out[0] : held_out[i + 1];
      one.shrink = own.deflection;
      one.shrink_of_positions = own.position;
      one.explained = own.explained;
      const bool by_station = one.in_verdict && !given_.empty() &&
                              (one.effects.front() == effects::Effect::frame_error ||
                               one.effects.front() == effects::Effect::tracker_drift);
      if (!by_station) continue;
      one.shrink = station.deflection;
      one.shrink_of_positions = station.position;
      const double noise = result_.gap.noise * result_.gap.noise, whole = result_.gap.before * result_.gap.before;
      if (whole > 1.05 * noise) one.explained = (whole - result_.gap.after * result_.gap.after) / (whole - noise);
    }
  }

  const preparation::PreparedCampaign& prepared_;
  DiagnoseOptions options_;
  const DiagnosisInput& start_;
  const SystemInput& input_;
  const std::vector<bool>& allowed_;
  const std::vector<std::size_t>& given_;
  const std::optional<StudyHeldOut>& held_out_;
  GapFit fit_;    // with the effects chosen, not the study's own: the limit of a finding is put into its rules
  GapFit alone_;  // joint stiffnesses alone
  StiffnessesAlone before_;
  Eigen::VectorXd after_;
  std::vector<std::vector<ChosenModel>> recipes_;
  std::vector<HeldOut>
      station_;               // by posture: readings as they are, and with the station's motion off and the verdict in
  bool with_motion_ = false;  ///< the gap before is of readings with the station's motion
  Diagnosis result_;
};

Diagnosis diagnoseAll(const preparation::PreparedCampaign& prepared, const DiagnoseOptions& options) {
  const GapStudy study = studyGap(prepared, {options.noise_share, options.deflection_share, options.only});
  return Diagnoser(prepared, study, options).run();
}

/// What a long day has beside the postures that are looked at.
struct LongDay {
  std::vector<std::size_t> places;  ///< of the day's postures, those that are looked at
  std::size_t postures = 0, reflectors = 0, first_reflectors = 0;
  bool long_sweeps = false;

  explicit LongDay(const campaign::Campaign& campaign)
      : places(preparation::spreadPostures(campaign, preparation::kMostDiagnosed)),
        postures(campaign.pose_ids.size()),
        reflectors(campaign.targets.size()),
        first_reflectors(reflectors > preparation::kMostReflectors
                             ? preparation::firstReflectors(campaign, preparation::kMostReflectors)
                             : reflectors),
        long_sweeps(preparation::hasLongSweep(campaign)) {}

  /// In the day's own numbers, saying what was left out.
  Diagnosis stated(Diagnosis diagnosis) const {
    if (long_sweeps) diagnosis.verdict.reasons.push_back(Remark(RemarkId::sweeps_thinned, preparation::kMostSwept));
    if (first_reflectors < reflectors)
      diagnosis.verdict.reasons.push_back(Remark(RemarkId::reflectors_thinned, reflectors, first_reflectors));
    if (postures <= preparation::kMostDiagnosed) return diagnosis;
    for (PointGap& one : diagnosis.at_points) one.pose = static_cast<int>(places[static_cast<std::size_t>(one.pose)]);
    diagnosis.verdict.reasons.push_back(Remark(RemarkId::postures_thinned, postures, diagnosis.postures));
    return diagnosis;
  }
};

}  // namespace

Diagnosis diagnose(const campaign::Campaign& campaign, const DiagnoseOptions& options) {
  return diagnose(campaign::Campaign(campaign), options);
}

Diagnosis diagnose(campaign::Campaign&& campaign, const DiagnoseOptions& options) {
  requireLoads(campaign);
  preparation::PreparedCampaign prepared = preparation::prepareCampaign(std::move(campaign));
  if (!isLong(prepared.campaign)) return diagnoseAll(prepared, options);
  const LongDay day(prepared.campaign);
  prepared = spreadForDiagnosis(prepared);
  return day.stated(diagnoseAll(prepared, options));
}

Diagnosis diagnose(const preparation::PreparedCampaign& prepared, const DiagnoseOptions& options) {
  requireLoads(prepared.campaign);
  if (!isLong(prepared.campaign)) return diagnoseAll(prepared, options);
  return LongDay(prepared.campaign).stated(diagnoseAll(spreadForDiagnosis(prepared), options));
}

Diagnosis diagnose(const preparation::PreparedCampaign& prepared, const GapStudy& study,
                   const DiagnoseOptions& options) {
  if (study.usable() && !study.hasEquations()) throw std::logic_error("a diagnosis needs the study's equations");
  requireLoads(prepared.campaign);
  if (!isLong(prepared.campaign)) return Diagnoser(prepared, study, options).run();
  return LongDay(prepared.campaign).stated(Diagnoser(spreadForDiagnosis(prepared), study, options).run());
}

}  // namespace stiffscope::diagnosis
