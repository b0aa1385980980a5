#include "core/diagnosis/verdict.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/confounding.h"
#include "core/diagnosis/localization.h"
#include "core/preparation/standing_motion.h"

namespace stiffscope::diagnosis {

namespace {

std::string detailOf(const effects::EffectModel& model, const std::vector<std::size_t>& parts) {
  std::vector<std::size_t> sorted = parts;
  std::sort(sorted.begin(), sorted.end());
  std::string detail;
  for (const std::size_t p : sorted) {
    const std::string& name = model.parts[p].detail;
    if (name.empty() || model.parts[p].is_shape) continue;
    detail += (detail.empty() ? "" : ", ") + name;
  }
  return detail;
}

/// `at_point`: the working point that a step of a shape starts from.
Remark parametersOf(const effects::EffectModel& model, const effects::LinearizationPoint& at_point,
                    const std::vector<std::size_t>& parts, const Eigen::VectorXd& own) {
  std::vector<Remark> fitted;
  Eigen::Index at = 0;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const effects::EffectPart& part = model.parts[p];
    if (std::find(parts.begin(), parts.end(), p) != parts.end()) {
      const auto size = static_cast<Eigen::Index>(part.most.size());
      std::vector<double> its(own.begin() + at, own.begin() + at + size);
      if (part.is_shape) its.front() = model.shapeAt(at_point) * std::exp(its.front());
      fitted.emplace_back(RemarkId::fitted_part, part.detail, part.unit, std::move(its));
    }
    at += static_cast<Eigen::Index>(part.most.size());
  }
  return fitted.empty() ? Remark() : Remark(RemarkId::fitted_parts, std::move(fitted));
}

class Decider {
 public:
  explicit Decider(const VerdictInput& from)
      : from_(from),
        models_(from.input.models),
        selector_(selectorOf(from.input, from.fit, from.fit.projection,
                             static_cast<double>(from.fit.data->postures.size()), from.allowed)) {}

  Decision run() {
    nameGeometry();
    nameChosen();
    rankNamed();
    nameUnknown();
    withdrawNames();
    listOthers();
    explain();
    return std::move(decision_);
  }

 private:
  const FittedSet& set() const { return from_.fit.set; }

  std::vector<ChosenModel> without(std::size_t i) const {
    std::vector<ChosenModel> others = set().models;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    return others;
  }

  Eigen::VectorXd own(const Eigen::VectorXd& effects, std::size_t model) const {
    return effects.segment(from_.fit.data->layout.model_at[model] - from_.fit.data->layout.effects,
                           static_cast<Eigen::Index>(models_[model].parameters()));
  }

  void nameGeometry() {
    if (!from_.geometry.tested || from_.geometry.rms <= kGeometryTolerance) return;
    geometry_named_ = true;
    EffectClass one;
    one.effects = {effects::Effect::kinematic_error};
    const double size = from_.geometry.rms / kGeometryTolerance;
    one.score = size * size * static_cast<double>(from_.fit.rules.loading_rows);
    one.in_verdict = true;
    one.parameters = Remark(RemarkId::axes_off_nominal, from_.geometry.largest_shift, from_.geometry.largest_tilt);
    decision_.verdict.entries.push_back({one.effects, ""});
    decision_.classes.push_back(one);
    decision_.recipes.emplace_back();
    besides_.emplace_back(RemarkId::geometry_off_nominal, from_.geometry.rms, kGeometryTolerance);
  }

  /// A geometry that is wrong puts the flange, and with it the load cell, elsewhere along the last axis, which
  /// sweeps do not see.
  bool followsFromGeometry(effects::Effect effect, const Eigen::VectorXd& parameters) const {
    if (!geometry_named_) return false;
    constexpr double kAsMuch = 2.0;
    if (effect == effects::Effect::load_point_error) return parameters.norm() < kAsMuch * from_.geometry.largest_shift;
    if (effect == effects::Effect::load_cell_misalignment)
      return parameters.norm() < kAsMuch * from_.geometry.largest_tilt;
    return false;
  }

  void nameChosen() {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < set().models.size(); ++i) {
      const FittedSet fewer = selector_.fit(without(i));
      order.emplace_back(set().score() - fewer.score(), i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [change, i] : order) {
      const ChosenModel& chosen = set().models[i];
      const effects::EffectModel& model = models_[chosen.model];
      const Eigen::VectorXd parameters = own(set().effects, chosen.model);
      // A drift has moved the frame by the time of the loading: one cause, not two.
      if (from_.station.course == preparation::StationCourse::drifted && model.effect == effects::Effect::frame_error)
        continue;
      if (followsFromGeometry(model.effect, parameters)) {
        besides_.emplace_back(RemarkId::follows_from_geometry, std::string(effects::idOf(model.effect)),
                              parametersOf(model, from_.fit.state.at, chosen.parts, parameters));
        continue;
      }
      EffectClass one;
      // What the nests show was taken off: the little that is left of it looks like anything.
      const auto& given = from_.fit.rules.given;
      const bool by_nests = std::find(given.begin(), given.end(), chosen.model) != given.end();
      one.effects = by_nests ? std::vector<effects::Effect>{model.effect} : classOf(i);
      one.detail = detailOf(model, chosen.parts) + (by_nests ? "" : otherParts(i));
      one.score = -change;
      one.in_verdict = true;
      one.parameters = parametersOf(model, from_.fit.state.at, chosen.parts, parameters);
      decision_.verdict.entries.push_back({one.effects, one.detail});
      decision_.classes.push_back(one);
      decision_.recipes.push_back({chosen});
      if (one.effects.size() > 1) decision_.ties.push_back({i, one.effects});
      named_.insert(named_.end(), one.effects.begin(), one.effects.end());
    }
  }

  /// The geometry among the effects by what it matters.
  void rankNamed() {
    if (!geometry_named_) return;
    auto& classes = decision_.classes;
    auto& entries = decision_.verdict.entries;
    for (std::size_t at = 0; at + 1 < classes.size() && classes[at].score < classes[at + 1].score; ++at) {
      std::swap(classes[at], classes[at + 1]);
      std::swap(entries[at], entries[at + 1]);
      std::swap(decision_.recipes[at], decision_.recipes[at + 1]);
    }
  }

  /// Parts of the same effect that would do as well as the one chosen: " or joint 3".
  std::string otherParts(std::size_t i) const {
    const ChosenModel& chosen = set().models[i];
    const effects::EffectModel& model = models_[chosen.model];
    if (chosen.parts.size() != 1) return {};
    std::string others;
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      if (p == chosen.parts.front()) continue;
      std::vector<ChosenModel> instead = set().models;
      instead[i].parts = {p};
      const FittedSet other = selector_.fit(instead);
      if (other.plausible && other.score() - set().score() < kSeparated * selector_.misfit(set()))
        others += " or " + model.parts[p].detail;
    }
    return others;
  }

  /// The chosen effect and those whose best imitation of its fitted field cannot be told from it.
  std::vector<effects::Effect> classOf(std::size_t i) const {
    const ChosenModel& chosen = set().models[i];
    std::vector<effects::Effect> effects{models_[chosen.model].effect};
    Eigen::VectorXd field = Eigen::VectorXd::Zero(set().effects.size());
    const Eigen::Index at = from_.fit.data->layout.model_at[chosen.model] - from_.fit.data->layout.effects;
    field.segment(at, static_cast<Eigen::Index>(models_[chosen.model].parameters())) = own(set().effects, chosen.model);
    const Projection made = withField(from_.fit.projection, field);
    const double scale = selector_.misfit(set());
    for (std::size_t m = 0; m < models_.size(); ++m) {
      const effects::Effect effect = models_[m].effect;
      if (!from_.allowed[m] || set().has(models_, effect)) continue;
      if (std::find(effects.begin(), effects.end(), effect) != effects.end()) continue;
      const double apart = separation(from_.input, from_.fit, made, without(i), m, from_.allowed);
      if (apart < kSeparated * scale) effects.push_back(effect);
    }
    return effects;
  }

  void nameUnknown() {
    nameUnknownPositions();
    if (!leavesUnexplained(from_.fit)) return;
    nameUnknownOnce();
    besides_.emplace_back(RemarkId::deflection_not_explained, from_.fit.model_error);
  }

  /// Unloaded positions that scatter beyond what noise and the repeatability of an arm put there.
  void nameUnknownPositions() {
    const PositionsLeft positions = positionsLeft(from_.fit, from_.positions);
    if (!positions.beyondLimit()) return;
    unknown_positions_ = true;
    nameUnknownOnce();
    besides_.emplace_back(RemarkId::positions_not_explained, positions.left, positions.limit);
  }

  /// A name must leave what looks like noise. Where something significant stays that no effect explains, an effect
  /// whose own rows keep more than `kMostLeft` of their gap's squares beyond noise is only a candidate; so is what
  /// other readings speak against.
  void withdrawNames() {
    const double deflection = leavesUnexplained(from_.fit) ? from_.gap.shareLeft() : 0.0;
    const double positions = unknown_positions_ ? from_.positions.shareLeft() : 0.0;
    constexpr double kMostLeft = 0.1;
    std::vector<effects::Effect> candidates;
    for (std::size_t i = 0; i < decision_.classes.size(); ++i) {
      EffectClass& one = decision_.classes[i];
      const bool geometry = one.effects.front() == effects::Effect::kinematic_error;
      const bool keeps_gap = deflection > kMostLeft || (positions > kMostLeft && (geometry || byPositions(i)));
      const auto& given = from_.fit.rules.given;
      const bool by_nests = !geometry && std::find(given.begin(), given.end(), modelOf(i)) != given.end();
      const bool refuted = refutedByNests(one) || refutedByStanding(i);
      if (by_nests || !(keeps_gap || refuted)) continue;
      one.in_verdict = false;
      decision_.verdict.entries[i].effects.clear();
      if (keeps_gap && !refuted) candidates.push_back(one.effects.front());
    }
    keepNamed();
    if (candidates.empty()) return;
    std::vector<std::string> ids;
    for (const effects::Effect effect : candidates) ids.emplace_back(effects::idOf(effect));
    besides_.emplace_back(RemarkId::candidates_only, ids, std::max(deflection, positions), kMostLeft);
  }

  /// What the verdict names before what it does not, and unknown where a name was taken out.
  void keepNamed() {
    Decision sorted;
    for (const bool named : {true, false}) {
      for (std::size_t i = 0; i < decision_.classes.size(); ++i) {
        if (decision_.classes[i].in_verdict != named) continue;
        if (named) sorted.verdict.entries.push_back(decision_.verdict.entries[i]);
        sorted.classes.push_back(decision_.classes[i]);
        sorted.recipes.push_back(decision_.recipes[i]);
      }
    }
    const auto& entries = decision_.verdict.entries;
    const bool said =
        std::any_of(entries.begin(), entries.end(), [](const VerdictEntry& entry) { return entry.effects.empty(); });
    decision_.verdict.entries = std::move(sorted.verdict.entries);
    decision_.classes = std::move(sorted.classes);
    decision_.recipes = std::move(sorted.recipes);
    if (said) nameUnknownOnce();
  }

  std::size_t modelOf(std::size_t named) const { return decision_.recipes[named].front().model; }

  /// Squares of what an effect of the set does, in parts of the noise that the fit has: in unloaded positions and in
  /// deflections; and those of its deflections, m^2.
  struct OwnField {
    double positions = 0.0, deflections = 0.0, squares = 0.0;
  };

  OwnField fieldOf(std::size_t named) const {
    const Eigen::VectorXd parameters = own(set().effects, modelOf(named));
    const Eigen::Index at = from_.fit.data->layout.model_at[modelOf(named)];
    const double inflation = from_.fit.state.position_inflation;
    OwnField sum;
    for (const GapPosture& posture : from_.fit.data->postures) {
      const Eigen::VectorXd field = posture.columns.middleCols(at, parameters.size()) * parameters;
      for (Eigen::Index row = 0; row < field.size(); ++row) {
        const double square = field[row] * field[row], variance = posture.noiseSquares(row, 1);
        if (row < posture.position_rows) {
          sum.positions += square / (inflation * variance);
        } else {
          sum.deflections += square / variance;
          sum.squares += square;
        }
      }
    }
    return sum;
  }

  /// Whether unloaded positions rather than deflections show it.
  bool byPositions(std::size_t named) const {
    const OwnField field = fieldOf(named);
    return field.positions > field.deflections;
  }

  /// A station that moves takes all nests along as one body: where they lose their shape it is something else.
  bool refutedByNests(const EffectClass& one) {
    if (one.effects.front() != effects::Effect::tracker_drift || !from_.station.rounds.deforming()) return false;
    besides_.emplace_back(RemarkId::nests_speak_against_drift);
    return true;
  }

  /// Friction, play and springs that harden depend on the load and on how it came: readings that go on moving while
  /// it stands look like them from one load step to the next. Only where that motion is not small beside the effect.
  bool refutedByStanding(std::size_t named) {
    const effects::Effect effect = decision_.classes[named].effects.front();
    const bool by_history = effect == effects::Effect::hysteresis || effect == effects::Effect::backlash ||
                            effect == effects::Effect::joint_hardening;
    if (!by_history || !standing_.significant()) return false;
    constexpr double kNotSmall = 0.1;  // of its deflections' rms
    const double rms = std::sqrt(fieldOf(named).squares / static_cast<double>(deflectionRows()));
    if (standing_.rms < kNotSmall * rms) return false;
    besides_.emplace_back(RemarkId::moves_while_load_stands, std::string(effects::idOf(effect)), standing_.rms,
                          standing_.t);
    return true;
  }

  Eigen::Index deflectionRows() const {
    Eigen::Index rows = 0;
    for (const GapPosture& posture : from_.fit.data->postures) rows += posture.right.size() - posture.position_rows;
    return std::max<Eigen::Index>(1, rows);
  }

  void nameUnknownOnce() {
    const auto& entries = decision_.verdict.entries;
    if (entries.empty() || !entries.back().effects.empty()) decision_.verdict.entries.push_back({{}, ""});
  }

  void listOthers() {
    constexpr std::size_t kListed = 8;
    const FittedSet base = selector_.given();
    for (const FittedSet& single : selector_.ranked(base)) {
      if (decision_.classes.size() >= kListed) break;
      const ChosenModel& chosen = single.models.back();
      const effects::EffectModel& model = models_[chosen.model];
      if (std::find(named_.begin(), named_.end(), model.effect) != named_.end()) continue;
      if (base.score() - single.score() <= 0.0) continue;
      EffectClass one;
      one.effects = {model.effect};
      one.detail = detailOf(model, chosen.parts);
      one.score = base.score() - single.score();
      one.parameters = parametersOf(model, from_.fit.state.at, chosen.parts, own(single.effects, chosen.model));
      decision_.classes.push_back(one);
      decision_.recipes.push_back(single.models);
      named_.push_back(model.effect);
    }
  }

  void explain() {
    std::vector<Remark>& reasons = decision_.verdict.reasons;
    const auto& rules = from_.fit.rules;
    reasons.emplace_back(RemarkId::left_by_stiffnesses, from_.gap.before, from_.gap.noise,
                         from_.fit.left_before.perEquation(), from_.input.absolute, from_.as_measured);
    if (decision_.verdict.entries.empty()) {
      reasons.emplace_back(RemarkId::no_effect_passes, rules.detect,
                           std::sqrt(rules.least_drop / rules.loading_rows) * from_.fit.data->state_noise);
    }
    reasons.insert(reasons.end(), besides_.begin(), besides_.end());
    sayChiSquare();
    reasons.emplace_back(RemarkId::floor_nests, from_.station.remark);
    if (from_.input.absolute) reasons.emplace_back(RemarkId::positions_take_part, from_.input.sweeps);
  }

  /// Whatever is too small to matter: what chance does not explain is said.
  void sayChiSquare() {
    const double left = leftPerEquation(from_.fit), limit = from_.fit.left_limit;
    if (!leavesUnexplained(from_.fit) && left > limit)
      decision_.verdict.reasons.emplace_back(RemarkId::chi_square_significant, left, limit);
    if (unknown_positions_ || !from_.input.absolute) return;
    Eigen::Index rows = 0;
    for (const GapPosture& posture : from_.fit.data->postures) rows += posture.position_rows;
    const double inflation = from_.fit.state.position_inflation;
    const double by_chance = limitOfChiSquare(std::max(1.0, static_cast<double>(rows)), from_.noise.degrees);
    if (inflation > by_chance)
      decision_.verdict.reasons.emplace_back(RemarkId::positions_scatter, inflation, by_chance);
  }

  const VerdictInput& from_;
  const std::vector<effects::EffectModel>& models_;
  Selector selector_;
  Decision decision_;
  bool geometry_named_ = false, unknown_positions_ = false;
  const preparation::StandingMotion standing_ = preparation::standingMotion(from_.input.campaign);
  std::vector<effects::Effect> named_;
  std::vector<Remark> besides_;
};

}  // namespace

Decision decideVerdict(const VerdictInput& from) { return Decider(from).run(); }

}  // namespace stiffscope::diagnosis
