#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/diagnosis_input.h"
#include "core/diagnosis/fit.h"
#include "core/extended_model/requested_effects.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::extended_model {

/// One number a joint in each column: of a step of the effects' parameters, or of a draw.
using JointsByColumn =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints, Eigen::Dynamic>;

/// One number of an added effect.
struct EffectParameter {
  std::string name;  ///< "joint 3", "P12 x", "1/EI of link 2"
  std::string unit;
  double value = 0.0, sd = 0.0;  ///< standard uncertainty, from the joint fit with stiffnesses and geometry
};

/// One effect as it was added.
struct AddedEffect {
  effects::Effect effect = effects::Effect::link_compliance;
  std::string detail;     ///< its parts, in words; empty where nothing is named
  std::string shape;      ///< which of the effect's equations, where it has several
  double score = 0.0;     ///< fall of BIC that it brings beside the others; chance alone reaches 20 hardly ever
  bool plausible = true;  ///< within the physical bounds of effect_model.h
  std::vector<EffectParameter> parameters;
};

/// A posture of the day as the fit sees it.
struct DayPosture {
  effects::CompactPosture states;
  std::optional<std::size_t> in_fit;  ///< which of the fit's postures; empty where a long day's fit left it out
};

/// A set of effects fitted jointly with stiffnesses, geometry and weights on everything the campaign has (all load
/// steps, unloaded positions, sweeps), by the diagnosis's weighted equations: A c + E theta = y. Which parts and which
/// of the equations of an effect is chosen by BIC where it is not given; then this set is fitted, whatever it brings.
struct EffectFit {
  std::unique_ptr<const diagnosis::DiagnosisInput> start;  ///< what `input` refers to
  std::unique_ptr<const diagnosis::SystemInput> input;     ///< its models: only those of the effects wanted
  diagnosis::GapFit fit;
  std::map<int, DayPosture> day;          ///< by the campaign's pose: those with a reflector read in all load steps
  std::vector<AddedEffect> added;         ///< as asked for
  std::vector<effects::Effect> geometry;  ///< of those asked for, what identification corrects by itself
  std::vector<Remark> notes;              ///< on how it came to these effects

  /// Which entries of the effects' parameter vector (fit.set.effects) are free, those at a bound among them, and their
  /// covariance: of the joint
  /// fit, so that what the effects share with stiffnesses and geometry is in it, times chi2 per equation where that is
  /// above 1; and one per cent of an effect of the machine, as far as its equation is good for a real one.
  std::vector<Eigen::Index> free;
  Eigen::MatrixXd covariance;

  diagnosis::Gap
      gap;  ///< of the deflection, rms per coordinate over all load steps: stiffnesses alone, noise, with the effects
  diagnosis::Shrink shrink;  ///< of that rms on postures held out
  double explained = 0.0;    ///< the same in variance, less noise: the share of the gap that the effects explain

  /// A posture of the day as the fit's equations have it; empty where the day does not have it.
  effects::PostureStates statesOf(int pose) const {
    const auto found = day.find(pose);
    return found == day.end() ? effects::PostureStates() : found->second.states.states(fit.state.geometry);
  }

  const Eigen::VectorXd& parameters() const { return fit.set.effects; }
  /// First of an effect's parameters among all, and its own.
  Eigen::Index firstOf(const diagnosis::ChosenModel& one) const {
    return fit.data->layout.model_at[one.model] - fit.data->layout.effects;
  }
  Eigen::VectorXd parametersOf(const diagnosis::ChosenModel& one) const {
    return parameters().segment(firstOf(one), static_cast<Eigen::Index>(input->models[one.model].parameters()));
  }
};

}  // namespace stiffscope::extended_model
