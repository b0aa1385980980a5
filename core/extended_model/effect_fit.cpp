#include "core/extended_model/effect_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/diagnosis/diagnosis_input.h"
#include "core/diagnosis/gap_study.h"
#include "core/diagnosis/held_out.h"
#include "core/diagnosis/localization.h"
#include "core/diagnosis/preconditions.h"
#include "core/diagnosis/system_rows.h"
#include "core/effects/all.h"
#include "core/identification/method_solution.h"
#include "core/numerics/parallel.h"
#include "core/preparation/subsample.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::extended_model {

namespace {

std::vector<effects::EffectModel> modelsOf(const std::vector<RequestedEffect>& wanted,
                                           const campaign::Campaign& campaign) {
  std::vector<effects::EffectModel> models = effects::effectModelsOf(campaign);
  std::erase_if(models, [&](const effects::EffectModel& model) {
    return std::none_of(wanted.begin(), wanted.end(), [&](const RequestedEffect& one) {
      return one.effect == model.effect && (one.shape.empty() || one.shape == model.shape);
    });
  });
  return models;
}

/// A reflector beyond those that a diagnosis looks at is a part that no model has.
void requireParts(const RequestedEffect& wanted, const std::vector<effects::EffectModel>& models, int targets) {
  for (const std::string& part : wanted.parts) {
    const bool has = std::any_of(models.begin(), models.end(), [&](const effects::EffectModel& model) {
      return model.effect == wanted.effect &&
             std::any_of(model.parts.begin(), model.parts.end(),
                         [&](const effects::EffectPart& one) { return one.detail == part; });
    });
    if (!has) throw UnfitEffect(wanted.effect, Remark(RemarkId::reflector_takes_no_part, part, targets));
  }
}

void requireTestable(const std::vector<RequestedEffect>& wanted, const diagnosis::SystemInput& input,
                     const diagnosis::DiagnosisInput& start) {
  const effects::CampaignContents has = diagnosis::whatIsThere(input, start.state, start.station);
  for (const RequestedEffect& one : wanted) {
    const Remark missing = effects::missingFor(one.effect, has);
    if (!missing.empty()) throw UnfitEffect(one.effect, Remark(RemarkId::lacks_what_shows_it, missing));
    if (effects::natureOf(one.effect) != effects::EffectNature::geometry)
      requireParts(one, input.models, start.state.at.targets);
  }
}

/// The models of an effect with the parts asked for, each in full.
std::vector<diagnosis::ChosenModel> asAsked(const RequestedEffect& wanted,
                                            const std::vector<effects::EffectModel>& models) {
  std::vector<diagnosis::ChosenModel> choices;
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (models[m].effect != wanted.effect) continue;
    diagnosis::ChosenModel choice{m, {}};
    for (std::size_t p = 0; p < models[m].parts.size(); ++p) {
      const auto& parts = wanted.parts;
      if (std::find(parts.begin(), parts.end(), models[m].parts[p].detail) != parts.end()) choice.parts.push_back(p);
    }
    if (!choice.parts.empty()) choices.push_back(choice);
  }
  return choices;
}

/// The one way to fit what was asked for, where there is only one.
std::optional<std::vector<diagnosis::ChosenModel>> withoutChoice(const std::vector<RequestedEffect>& wanted,
                                                                 const std::vector<effects::EffectModel>& models) {
  std::vector<diagnosis::ChosenModel> chosen;
  for (const RequestedEffect& one : wanted) {
    std::vector<diagnosis::ChosenModel> choices = asAsked(one, models);
    for (std::size_t m = 0; choices.empty() && m < models.size(); ++m) {
      if (models[m].effect == one.effect && models[m].parts.size() > 1) return std::nullopt;
    }
    for (std::size_t m = 0; one.parts.empty() && m < models.size(); ++m) {
      if (models[m].effect == one.effect) choices.push_back({m, {0}});
    }
    if (choices.size() != 1) return std::nullopt;
    chosen.push_back(choices.front());
  }
  return chosen;
}

/// With the shapes of what is to be fitted: who names a joint means the effect there and not a shape that it began
/// with.
std::vector<diagnosis::ChosenModel> withShapes(std::vector<diagnosis::ChosenModel> chosen,
                                               const std::vector<effects::EffectModel>& models) {
  for (diagnosis::ChosenModel& one : chosen) {
    const std::vector<effects::EffectPart>& parts = models[one.model].parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const bool there = std::find(one.parts.begin(), one.parts.end(), p) != one.parts.end();
      if (parts[p].is_shape && !there) one.parts.push_back(p);
    }
  }
  return chosen;
}

/// An effect of which stiffnesses and geometry leave nothing in these postures has no size.
void requireSeen(const diagnosis::GapFit& fit, const diagnosis::SystemInput& input) {
  for (const diagnosis::ChosenModel& one : fit.set.models) {
    const Eigen::Index first = fit.data->layout.model_at[one.model] - fit.data->layout.effects;
    bool seen = false;
    for (Eigen::Index i = first; i < first + static_cast<Eigen::Index>(input.models[one.model].parameters()); ++i)
      seen = seen || fit.projection.matrix(i, i) > fit.rules.kept_share * fit.projection.before[i];
    if (!seen) throw UnfitEffect(input.models[one.model].effect, Remark(RemarkId::not_told_from_stiffnesses));
  }
}

class Chooser {
 public:
  Chooser(const diagnosis::SystemInput& input, const diagnosis::GapFit& fit, const std::vector<bool>& allowed)
      : models_(input.models),
        fit_(fit),
        selector_(diagnosis::selectorOf(input, fit, fit.projection, static_cast<double>(fit.data->postures.size()),
                                        allowed)) {}

  /// What was asked for by its parts, what the free selection took of the rest, and then, put in beside these, what
  /// that did not make.
  std::vector<diagnosis::ChosenModel> run(const std::vector<RequestedEffect>& wanted) const {
    std::vector<diagnosis::ChosenModel> chosen;
    std::vector<RequestedEffect> missing;
    for (const RequestedEffect& one : wanted) {
      const auto choices = asAsked(one, models_);
      const auto& found = fit_.set.models;
      const auto own = std::find_if(found.begin(), found.end(), [&](const diagnosis::ChosenModel& m) {
        return models_[m.model].effect == one.effect;
      });
      if (!choices.empty()) {
        chosen.push_back(bestOf(choices, one, chosen));
      } else if (own != found.end()) {
        chosen.push_back(*own);
      } else {
        missing.push_back(one);
      }
    }
    for (const RequestedEffect& one : missing) chosen.push_back(bestOf(beside(chosen, one), one, chosen));
    return chosen;
  }

 private:
  /// The effect beside the others, its parts chosen greedily, by each of its equations.
  std::vector<diagnosis::ChosenModel> beside(const std::vector<diagnosis::ChosenModel>& others,
                                             const RequestedEffect& wanted) const {
    std::vector<diagnosis::ChosenModel> choices;
    for (const diagnosis::FittedSet& set : selector_.ranked(selector_.fit(others))) {
      if (models_[set.models.back().model].effect == wanted.effect) choices.push_back(set.models.back());
    }
    return choices;
  }

  diagnosis::ChosenModel bestOf(const std::vector<diagnosis::ChosenModel>& choices, const RequestedEffect& wanted,
                                const std::vector<diagnosis::ChosenModel>& others) const {
    if (choices.empty()) throw UnfitEffect(wanted.effect, Remark(RemarkId::not_told_from_stiffnesses));
    std::vector<double> scores;
    for (const diagnosis::ChosenModel& choice : choices) {
      std::vector<diagnosis::ChosenModel> all = others;
      all.push_back(choice);
      scores.push_back(selector_.fit(all).score());
    }
    return choices[static_cast<std::size_t>(std::min_element(scores.begin(), scores.end()) - scores.begin())];
  }

  const std::vector<effects::EffectModel>& models_;
  const diagnosis::GapFit& fit_;
  diagnosis::Selector selector_;
};

/// Those of the parts in the model: at a bound, too, as far as the data see them, since what holds a parameter there
/// knows it no better. None where all are zero.
std::vector<Eigen::Index> freeParameters(const EffectFit& effects) {
  const diagnosis::GapFit& fit = effects.fit;
  std::vector<Eigen::Index> free;
  bool any = false;
  for (const diagnosis::ChosenModel& one : fit.set.models) {
    const effects::EffectModel& model = effects.input->models[one.model];
    Eigen::Index at = effects.firstOf(one);
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      const bool in_model = std::find(one.parts.begin(), one.parts.end(), p) != one.parts.end();
      for (std::size_t k = 0; k < model.parts[p].most.size(); ++k, ++at) {
        const bool found = fit.set.effects[at] != 0.0;
        const bool seen = fit.projection.matrix(at, at) > fit.rules.kept_share * fit.projection.before[at];
        any = any || found;
        if (found || (in_model && seen)) free.push_back(at);
      }
    }
  }
  if (!any) free.clear();
  std::sort(free.begin(), free.end());
  return free;
}

/// How well an effect's equation describes a machine that has it: sizes of single effects came back within one per cent
/// from the simulator, which solves the loaded equilibrium of another mechanism with finite rotations.
constexpr double kModelShare = 0.01;

/// Of the joint fit with all nuisances, and of the equations themselves.
Eigen::MatrixXd covarianceOfFree(const EffectFit& effects) {
  const diagnosis::GapLayout& layout = effects.fit.data->layout;
  const std::vector<double> ones(effects.fit.data->postures.size(), 1.0);
  const diagnosis::Projection projection = diagnosis::project(diagnosis::sumOf(*effects.fit.data, ones), layout);
  Eigen::MatrixXd matrix = projection.matrix(effects.free, effects.free);
  const Eigen::VectorXd scale =
      matrix.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
  matrix.diagonal().setConstant(1.0 + 1e-12);
  const Eigen::MatrixXd inverse = solveSymmetric(matrix, Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  Eigen::MatrixXd covariance =
      diagnosis::varianceFactor(effects.fit) * (scale.asDiagonal() * inverse * scale.asDiagonal());
  for (const diagnosis::ChosenModel& one : effects.fit.set.models) {
    const effects::EffectModel& model = effects.input->models[one.model];
    if (effects::natureOf(model.effect) != effects::EffectNature::machine) continue;
    const Eigen::Index first = layout.model_at[one.model] - layout.effects;
    const Eigen::Index end = first + static_cast<Eigen::Index>(model.parameters());
    for (std::size_t i = 0; i < effects.free.size(); ++i) {
      if (effects.free[i] < first || effects.free[i] >= end) continue;
      const double size = kModelShare * effects.parameters()[effects.free[i]];
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += size * size;
    }
  }
  return covariance;
}

void describe(EffectFit& effects, const std::vector<bool>& allowed) {
  const diagnosis::GapFit& fit = effects.fit;
  const diagnosis::SystemInput& input = *effects.input;
  const diagnosis::Selector selector =
      diagnosis::selectorOf(input, fit, fit.projection, static_cast<double>(fit.data->postures.size()), allowed);
  for (std::size_t i = 0; i < fit.set.models.size(); ++i) {
    const diagnosis::ChosenModel& chosen = fit.set.models[i];
    const effects::EffectModel& model = input.models[chosen.model];
    std::vector<diagnosis::ChosenModel> others = fit.set.models;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    AddedEffect one{model.effect, {}, model.shape, selector.fit(others).score() - fit.set.score(), true, {}};
    std::vector<std::string> details;
    Eigen::Index at = fit.data->layout.model_at[chosen.model] - fit.data->layout.effects;
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      const effects::EffectPart& part = model.parts[p];
      const bool there = std::find(chosen.parts.begin(), chosen.parts.end(), p) != chosen.parts.end();
      if (there && !part.detail.empty() && !part.is_shape) details.push_back(part.detail);
      for (std::size_t k = 0; k < part.most.size(); ++k, ++at) {
        if (!there) continue;
        EffectParameter parameter{effects::parameterName(part, k), effects::parameterUnit(part, k), fit.set.effects[at],
                                  0.0};
        const auto free = std::find(effects.free.begin(), effects.free.end(), at) - effects.free.begin();
        if (free < effects.covariance.rows()) parameter.sd = std::sqrt(effects.covariance(free, free));
        if (part.is_shape) {
          parameter.value = model.shapeAt(fit.state.at) * std::exp(parameter.value);
          parameter.sd *= parameter.value;
        } else if (std::abs(parameter.value) > part.most[k]) {
          one.plausible = false;
        }
        one.parameters.push_back(parameter);
      }
    }
    one.detail = fmt::format("{}", fmt::join(details, ", "));
    effects.added.push_back(std::move(one));
  }
}

}  // namespace

void describeSizes(EffectFit& effects) {
  effects.added.clear();
  describe(effects, std::vector<bool>(effects.input->models.size(), true));
}

EffectFit fitEffects(const campaign::Campaign& campaign, const RequestedEffects& asked) {
  return fitEffects(preparation::prepareCampaign(campaign), asked);
}

namespace {

EffectFit fitToAll(const preparation::PreparedCampaign& prepared, const RequestedEffects& asked) {
  const campaign::Campaign& campaign = prepared.campaign;
  EffectFit effects;
  effects.notes = asked.notes;
  std::vector<RequestedEffect> wanted;
  for (const RequestedEffect& one : asked.effects) {
    if (effects::natureOf(one.effect) == effects::EffectNature::geometry) {
      effects.geometry.push_back(one.effect);
    } else {
      wanted.push_back(one);
    }
  }
  if (asked.effects.empty()) return effects;
  auto start = std::make_unique<diagnosis::DiagnosisInput>(diagnosis::diagnosisInput(prepared));
  if (!start->reason.empty())
    throw UnfitEffect(asked.effects.front().effect, Remark(RemarkId::no_gap_to_fit, start->reason));
  auto input = std::make_unique<diagnosis::SystemInput>(
      diagnosis::SystemInput{start->campaign, start->noise.noise, campaign.load_cell->force_sigma,
                             campaign.load_cell->moment_sigma, modelsOf(wanted, campaign), start->absolute,
                             start->sweeps, diagnosis::complianceExpected(start->state.at.compliance)});
  if (prepared.rail) input->carriage = prepared.rail->of_stop;
  if (start->station.course == preparation::StationCourse::drifted) input->wandering = &start->station;
  requireTestable(asked.effects, *input, *start);
  if (wanted.empty()) return effects;
  diagnosis::boundDriftByNests(*start, *input);
  const std::vector<bool> allowed(input->models.size(), true);
  diagnosis::FitRules rules;
  rules.noise_degrees = start->noise.degrees;
  rules.fixed = withoutChoice(wanted, input->models);
  if (!rules.fixed) {
    const diagnosis::GapFit free = diagnosis::fitGap(*input, start->state, allowed, rules);
    rules.fixed = Chooser(*input, free, allowed).run(wanted);
  }
  rules.fixed = withShapes(std::move(*rules.fixed), input->models);
  effects.fit = diagnosis::fitGap(*input, start->state, allowed, rules);
  requireSeen(effects.fit, *input);
  for (std::size_t i = 0; i < effects.fit.data->postures.size(); ++i)
    effects.day[effects.fit.data->postures[i].pose] = {effects::CompactPosture(effects.fit.data->postures[i].states),
                                                       i};
  effects.start = std::move(start);
  effects.input = std::move(input);
  effects.free = freeParameters(effects);
  effects.covariance = covarianceOfFree(effects);
  const diagnosis::GapFit alone = diagnosis::withoutEffects(*effects.input, effects.start->state, effects.fit);
  const diagnosis::StiffnessesAlone before =
      diagnosis::stiffnessesAlone(*alone.data, std::vector<double>(alone.data->postures.size(), 1.0), alone.projection);
  effects.gap = diagnosis::deflectionGap(alone, before, effects.fit,
                                         diagnosis::allParameters(effects.fit.nuisances, effects.fit.set.effects));
  describe(effects, allowed);
  if (effects.free.empty()) {  // of size zero: the gap stays what stiffnesses alone leave
    effects.gap.after = effects.gap.before;
    return effects;
  }
  const diagnosis::FitRecipe recipe{false, effects.fit.set.models};
  constexpr int kResamples = 120;
  const diagnosis::HeldOutShrink held_out =
      diagnosis::heldOutShrinks(*effects.input, alone, effects.fit, allowed, {recipe}, kResamples, 1).front();
  effects.shrink = held_out.deflection;
  effects.explained = held_out.explained;
  return effects;
}

}  // namespace

EffectFit overWholeDay(EffectFit spread, const preparation::PreparedCampaign& whole) {
  if (spread.fit.data->postures.empty()) return spread;
  diagnosis::SystemState& state = spread.fit.state;
  // Reflectors that took no part are where the day without effects has them.
  auto& places = state.geometry.targets_at_zero;
  if (places.size() < whole.campaign.targets.size()) {
    const auto all = identification::solveDay(whole.campaign).arm.geometry.targets_at_zero;
    places.insert(places.end(), all.begin() + std::ssize(places), all.end());
  }
  const diagnosis::LoadingRows whole_rows(whole.campaign);
  constexpr std::size_t kBlock = 64;  // the rows themselves of a whole day would be most of the memory
  std::vector<std::vector<effects::CompactPosture>> blocks((whole_rows.poses() + kBlock - 1) / kBlock);
  numerics::onAllCores(blocks.size(), [&](std::size_t block) {
    for (const diagnosis::SystemRows& rows :
         whole_rows.rows(state.geometry, state.at, state.corrections, block * kBlock,
                         std::min(whole_rows.poses(), (block + 1) * kBlock)))
      blocks[block].emplace_back(rows.states);
  });
  std::map<int, DayPosture> day;
  for (std::vector<effects::CompactPosture>& block : blocks) {
    for (effects::CompactPosture& one : block) day[one.pose()].states = std::move(one);
  }
  const std::vector<std::size_t> kept = preparation::spreadPostures(whole.campaign, preparation::kMostDiagnosed);
  for (auto& [pose, posture] : spread.day) {
    const auto of_whole = static_cast<int>(kept[static_cast<std::size_t>(pose)]);
    posture.states.setPose(of_whole);
    day[of_whole] = std::move(posture);
  }
  spread.day = std::move(day);
  return spread;
}

EffectFit fitEffects(const preparation::PreparedCampaign& prepared, const RequestedEffects& asked) {
  if (!diagnosis::isLong(prepared.campaign)) return fitToAll(prepared, asked);
  return overWholeDay(fitToAll(diagnosis::spreadForDiagnosis(prepared), asked), prepared);
}

std::vector<effects::PresentEffect> machineEffects(const EffectFit& effects, const Eigen::VectorXd& parameters) {
  const diagnosis::GapLayout& layout = effects.fit.data->layout;
  std::vector<effects::PresentEffect> machine;
  for (const diagnosis::ChosenModel& one : effects.fit.set.models) {
    const effects::EffectModel& model = effects.input->models[one.model];
    if (effects::natureOf(model.effect) != effects::EffectNature::machine) continue;
    const Eigen::VectorXd own =
        parameters.segment(layout.model_at[one.model] - layout.effects, static_cast<Eigen::Index>(model.parameters()));
    if (!own.isZero(0.0)) machine.push_back({&model, own});
  }
  return machine;
}

Eigen::VectorXd parametersFrom(const EffectFit& effects, const std::vector<double>& weights) {
  const diagnosis::GapFit& fit = effects.fit;
  const diagnosis::Projection projection = diagnosis::project(diagnosis::sumOf(*fit.data, weights), fit.data->layout);
  double postures = 0.0;
  for (const double weight : weights) postures += weight;
  const std::vector<bool> allowed(effects.input->models.size(), true);
  return diagnosis::selectorOf(*effects.input, fit, projection, std::max(2.0, postures), allowed)
      .fit(fit.set.models)
      .effects;
}

}  // namespace stiffscope::extended_model
