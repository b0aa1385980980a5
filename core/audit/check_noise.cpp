#include "core/audit/redundancies.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/mistakes/remarks.h"
#include "core/numerics/distributions.h"
#include "core/preparation/remarks.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::audit {

double NoiseSum::ratio() const { return dof > 0 ? std::sqrt(chi2 / dof) : 0.0; }

namespace {

constexpr int kEnoughToJudge = 30;  // degrees of freedom

struct NoiseSource {
  NoiseSum sum;
  int kind = 0;  ///< sources of one kind share their faults
};

/// One kind of readings after the other; those of too few degrees of freedom have no say.
class NoiseSources {
 public:
  void add(NoiseSum sum, int kind, Remark says, std::vector<Remark>& evidence) {
    if (sum.dof < kEnoughToJudge) return;
    says.values.emplace_back(sum.ratio());
    evidence.push_back(std::move(says));
    sources_.push_back({sum, kind});
  }

  bool any() const { return !sources_.empty(); }
  bool severalKinds() const {
    return std::any_of(sources_.begin(), sources_.end(),
                       [&](const NoiseSource& one) { return one.kind != sources_.front().kind; });
  }
  /// The one that least else is in.
  const NoiseSum& smallest() const {
    return std::min_element(sources_.begin(), sources_.end(),
                            [](const NoiseSource& a, const NoiseSource& b) { return a.sum.ratio() < b.sum.ratio(); })
        ->sum;
  }
  /// Some scatter by less than chance makes of the declared noise.
  bool below() const {
    const double level = preparation::kLevel / static_cast<double>(sources_.size());
    return std::any_of(sources_.begin(), sources_.end(), [&](const NoiseSource& one) {
      return one.sum.chi2 < numerics::chiSquareLimit(1.0 - level, one.sum.dof);
    });
  }
  /// All scatter by more.
  bool above() const {
    return std::all_of(sources_.begin(), sources_.end(), [](const NoiseSource& one) {
      return one.sum.chi2 > numerics::chiSquareLimit(preparation::kLevel, one.sum.dof);
    });
  }

 private:
  std::vector<NoiseSource> sources_;
};

double awayFromOne(double ratio) { return ratio > 0.0 ? std::max(ratio, 1.0 / ratio) : INFINITY; }

/// The one of two ratios that is nearer to 1; 1 where they are on either side of it.
double borneOut(double one, double other) {
  if ((one - 1.0) * (other - 1.0) <= 0.0) return 1.0;
  return awayFromOne(one) < awayFromOne(other) ? one : other;
}

void takeFactor(double ratio, DeclaredNoise& judged) {
  judged.factors.push_back(ratio);
  judged.deviation = std::max(judged.deviation, awayFromOne(ratio));
  (ratio > 1.0 ? judged.too_small : judged.too_large) = true;
}

/// By a quick source, borne out by the day where it has a say.
void judgeBySize(const NoiseSum& quick, const NoiseSources& day, DeclaredNoise& judged) {
  const double ratio = quick.ratio();
  const bool large = ratio * kWrongNoise < 1.0 && (!day.any() || day.below());
  const bool small = ratio > kWrongNoise && (!day.any() || day.above());
  if (large || small) return takeFactor(ratio, judged);
  judged.factors.push_back(1.0);
  const double held = day.any() ? borneOut(ratio, day.smallest().ratio()) : ratio;
  judged.deviation = std::max(judged.deviation, std::min(kWrongNoise, awayFromOne(held)));
}

/// By the day alone: too small a noise is told from a fault by two kinds of readings that both show it.
void judgeByDay(const NoiseSources& day, DeclaredNoise& judged) {
  const double ratio = day.smallest().ratio();
  if (ratio > kWrongNoise && !day.severalKinds()) {
    judged.reason = Remark(MissingId::one_kind_scatters);
    return;
  }
  if (awayFromOne(ratio) > kWrongNoise) {
    takeFactor(ratio, judged);
    judged.factors.push_back(ratio);
    return;
  }
  judged.factors = {1.0, 1.0};
  judged.deviation = awayFromOne(ratio);
}

/// Of what the readings over the day scatter with the figures as declared, and as found.
void compareWithFound(const NoiseSum& held, DeclaredNoise& judged) {
  judged.before = held.ratio();
  double factor = 1.0;
  for (const double one : judged.factors) {
    if (awayFromOne(one) > awayFromOne(factor)) factor = one;
  }
  judged.after = judged.before / factor;
}

/// Where repeats have raised the noise, sums over it are brought back to what is declared, at the least.
NoiseSum againstDeclared(double chi2, int dof, const preparation::RepeatScatter& scatter) {
  const preparation::NoiseFactors raised = preparation::noiseFactors(scatter);
  const double least = std::min(raised.along, raised.across);
  return {chi2 * least * least, dof};
}

/// Whether a mistake of one of these kinds is suspected, which makes the readings scatter otherwise than declared.
bool suspects(const std::vector<mistakes::Suspected>& cures, std::initializer_list<const char*> ids) {
  return std::any_of(cures.begin(), cures.end(), [&](const mistakes::Suspected& one) {
    return std::any_of(ids.begin(), ids.end(), [&](const char* id) { return one.mistake == id; });
  });
}

enum NoiseKind { kNests, kSweeps, kReturns };

DeclaredNoise judgeTracker(const AuditInput& input) {
  DeclaredNoise judged;
  judged.where = Remark(RemarkId::at_tracker);
  if (!input.noise) {
    judged.reason = Remark(preparation::RemarkId::tracker_noise_not_declared);
    return judged;
  }
  const preparation::RepeatScatter& repeats = input.scatter;
  const NoiseSum along{repeats.along_chi2, repeats.along_dof}, across{repeats.across_chi2, repeats.across_dof};
  NoiseSources at_once, day;
  at_once.add(along, 0, Remark(RemarkId::repeats_along_show), judged.evidence);
  at_once.add(across, 0, Remark(RemarkId::repeats_across_show), judged.evidence);
  const auto over = [&](double chi2, int dof) { return againstDeclared(chi2, dof, repeats); };
  if (input.station.tested) {
    day.add(over(input.station.rigid_chi2, input.station.rigid_dof), kNests, Remark(RemarkId::nests_show),
            judged.evidence);
  }
  NoiseSum short_sweeps;  // of few readings: together
  for (std::size_t axis = 0; axis < input.frames.axes.size(); ++axis) {
    const metrology::AxisFit& fit = input.frames.axes[axis].fit;
    if (!input.frames.axes[axis].measured || !fit.determined) continue;
    const NoiseSum sum = over(fit.chi2_per_dof * fit.degrees_of_freedom, fit.degrees_of_freedom);
    day.add(sum, kSweeps, Remark(RemarkId::sweep_shows, axis + 1), judged.evidence);
    if (sum.dof >= kEnoughToJudge) continue;
    short_sweeps.chi2 += sum.chi2;
    short_sweeps.dof += sum.dof;
  }
  day.add(short_sweeps, kSweeps, Remark(RemarkId::short_sweeps_show), judged.evidence);
  const NoiseSum returns = scatterOfReturns(input);
  day.add(over(returns.chi2, returns.dof), kReturns, Remark(RemarkId::returns_show), judged.evidence);
  if (along.dof >= kEnoughToJudge) {
    judgeBySize(along, day, judged);
    judgeBySize(across, day, judged);
  } else if (day.any()) {
    judgeByDay(day, judged);
  } else {
    judged.reason = Remark(MissingId::too_few_to_judge_tracker, kEnoughToJudge);
  }
  if (judged.reason.empty()) compareWithFound(day.any() ? day.smallest() : across, judged);
  judged.explained = suspects(input.model.arm, {"point_unit"});
  return judged;
}

DeclaredNoise judgeLoadCell(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  DeclaredNoise judged;
  judged.where = Remark(RemarkId::at_load_cell);
  if (!campaign.load_cell || !campaign.states) {
    judged.reason = Remark(MissingId::no_load_cell_readings);
    return judged;
  }
  if (campaign.load_cell->force_sigma <= 0.0 || campaign.load_cell->moment_sigma <= 0.0) {
    judged.reason = Remark(MissingId::load_cell_noise_not_stated);
    return judged;
  }
  const LoadPointFit lever = fitLoadPoint(campaign);
  const NoiseSum unloaded{input.zero.chi2, input.zero.dof};
  NoiseSources at_once, day;
  at_once.add(unloaded, 0, Remark(RemarkId::unloaded_cell_shows), judged.evidence);
  if (lever.done) day.add({lever.chi2, lever.dof}, 0, Remark(RemarkId::lever_shows), judged.evidence);
  // Unloaded readings alone may hold a weight that turns with the postures; moments may have been computed, not read.
  if (!at_once.any() || !day.any()) {
    judged.reason = Remark(MissingId::too_few_to_judge_load_cell);
    return judged;
  }
  judgeBySize(unloaded, day, judged);
  compareWithFound(day.smallest(), judged);
  judged.explained = suspects(input.model.loads, {"not_tared", "wrench_unit"});
  return judged;
}

preparation::AuditCheck noiseCheck(const DeclaredNoise& judged) {
  preparation::AuditCheck check;
  check.id = "noise_declared";
  if (!judged.reason.empty()) {
    check = preparation::notTestable(check.id, judged.reason);
    check.where = judged.where;
    return check;
  }
  check.where = judged.where;
  check.value = judged.deviation;
  check.limit = kWrongNoise;
  check.limit_source = Remark(LimitId::factor_of_two, kEnoughToJudge);
  if (judged.too_large) check.verdict = preparation::AuditVerdict::warn;
  if (judged.too_small) check.verdict = preparation::AuditVerdict::fail;
  const bool wrong = judged.too_small || judged.too_large;
  const RemarkId found = wrong && judged.explained ? RemarkId::noise_explained
                         : judged.too_small        ? RemarkId::noise_too_small
                         : judged.too_large        ? RemarkId::noise_too_large
                                                   : RemarkId::noise_borne_out;
  check.message = Remark(found, judged.deviation, judged.evidence);
  return check;
}

}  // namespace

std::vector<DeclaredNoise> judgeDeclaredNoise(const AuditInput& input) {
  return {judgeTracker(input), judgeLoadCell(input)};
}

Findings checkDeclaredNoise(const AuditInput& input) {
  Findings findings;
  for (const DeclaredNoise& judged : judgeDeclaredNoise(input)) findings.push_back(noiseCheck(judged));
  return findings;
}

std::vector<mistakes::Suspected> suspectedNoise(const AuditInput& input) {
  std::vector<mistakes::Suspected> found;
  for (const DeclaredNoise& judged : judgeDeclaredNoise(input)) {
    if (judged.explained || (!judged.too_large && !judged.too_small)) continue;
    const RemarkId remedy =
        judged.factors.size() == 2 ? RemarkId::declare_tracker_noise : RemarkId::declare_load_cell_noise;
    found.push_back({"noise_declared", judged.where, Remark(remedy, judged.factors),
                     Remark(mistakes::RemarkId::day_scatters, judged.before, judged.after), judged.before,
                     judged.after});
  }
  return found;
}

std::vector<mistakes::Suspected> suspectedZero(const AuditInput& input) {
  std::vector<mistakes::Suspected> found;
  const campaign::Campaign& campaign = input.campaign;
  if (!campaign.load_cell || !campaign.states) return found;
  const mistakes::CellZero& zero = input.zero;
  const auto add = [&](Remark remedy) {
    found.push_back({"not_tared",
                     Remark(mistakes::RemarkId::in_columns, std::string("fx_n to mz_nm"),
                            std::vector<std::string>{campaign.states->file}),
                     std::move(remedy), Remark(RemarkId::unloaded_scatter, zero.before, zero.after), zero.before,
                     zero.after});
  };
  if (zero.drifts) add(Remark(RemarkId::take_step_0_off, zero.drift_force, zero.drift_moment, zero.hours));
  if (zero.weighs && !suspects(input.model.loads, {"not_tared"}))
    add(Remark(mistakes::RemarkId::weight_not_tared, zero.mass, zero.force, zero.force_left));
  return found;
}

}  // namespace stiffscope::audit
