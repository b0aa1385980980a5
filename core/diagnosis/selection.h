#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/projection.h"

namespace stiffscope::diagnosis {

/// One model of an effect with the parts of it that are present.
struct ChosenModel {
  std::size_t model = 0;
  std::vector<std::size_t> parts;

  bool operator==(const ChosenModel&) const = default;
};

/// A set of models fitted together.
struct FittedSet {
  std::vector<ChosenModel> models;
  Eigen::VectorXd effects;  ///< all effect parameters, those not in the set zero
  double chi2 = 0.0;
  double penalty = 0.0;   ///< BIC's, postures counted, with the choice of parts and models
  bool plausible = true;  ///< within the physical bounds; no joint's compliance is surely negative

  double score() const { return chi2 + penalty; }  ///< the smaller the better
  bool has(const std::vector<effects::EffectModel>& table, effects::Effect effect) const;
};

struct SelectionRules {
  double detect = 20.0;     ///< least fall of the score (noise regime) that a first effect must bring
  double least_drop = 0.0;  ///< least fall of chi2 that matters
  /// Least share of what the whole set removes (of chi2) that each of its effects must bring: models of large
  /// effects are not exact to a tenth of their size, and what they leave looks like others. Never more than an
  /// effect of the size of the noise brings.
  double share_of_removed = 0.01;
  double kept_share = 1e-4;  ///< a column of which less (in squares) is left by the projection is not tried
  std::size_t most_effects = 3;
  std::vector<std::size_t> given;  ///< models that other evidence puts in
  double loading_rows = 1.0;       ///< equations of the loading
  double other_rows = 0.0;         ///< chi2 that is expected of the sweeps
  /// Joints whose compliance, where it is surely negative, rules a set out: those that the load turns. Of another one
  /// some micrometres that the model lacks make any number. Empty: all.
  std::vector<bool> loaded;
};

/// Chooses effects: forward, then backward, then all pairs of the best few, by BIC counting postures.
class Selector {
 public:
  Selector(const std::vector<effects::EffectModel>& models, const GapLayout& layout, const Projection& projection,
           double postures, const SelectionRules& rules, const std::vector<bool>& allowed);

  /// Every model alone on top of `base`, its parts chosen greedily; best score first. Those that cannot score below
  /// `limit` may be missing.
  std::vector<FittedSet> ranked(const FittedSet& base, double limit = std::numeric_limits<double>::infinity()) const;
  FittedSet nothing() const;
  FittedSet given() const;
  FittedSet select() const;
  FittedSet fit(const std::vector<ChosenModel>& models) const;
  /// chi2 of fit(models) to within rounding, at a fraction of its cost.
  double roughChi2(const std::vector<ChosenModel>& models) const;
  /// One model on top of `base`, its parts chosen greedily; empty where nothing plausible comes of it.
  std::optional<FittedSet> grown(const FittedSet& base, std::size_t model) const;
  /// Whether what `with` has beyond `without` is significant and matters.
  bool worth(const FittedSet& with, const FittedSet& without) const;
  bool isGiven(std::size_t model) const;  ///< put in by other evidence

  /// How far beyond noise the best set leaves the loading: chi2 per equation, at least 1. Parameters are not taken off:
  /// by them it would be above 1 in half of the days where noise is all that is left.
  double misfit(const FittedSet& set) const;

 private:
  double penaltyOfModel(std::size_t model) const;
  double penaltyOfPart(std::size_t model, std::size_t parameters) const;
  bool mayScoreBelow(double limit, const FittedSet& base, std::size_t model) const;
  std::optional<FittedSet> withBestPart(std::vector<ChosenModel> models, GrowingSubset& subset) const;
  void addPart(std::size_t model, std::size_t part, GrowingSubset& subset) const;
  GrowingSubset subsetOf(const std::vector<ChosenModel>& models) const;
  bool isSeen(std::size_t model, std::size_t part) const;
  FittedSet regrown(FittedSet set) const;  ///< parts of each model chosen again beside the others
  FittedSet pruned(FittedSet set) const;
  bool negativeCompliance(const FittedSet& set, const std::vector<Eigen::Index>& indices) const;

  const std::vector<effects::EffectModel>& models_;
  const GapLayout& layout_;
  const Projection& projection_;
  double postures_;
  SelectionRules rules_;
  std::vector<bool> allowed_;
  Eigen::VectorXd prior_;
  double given_chi2_ = 0.0;
  std::vector<std::vector<Eigen::Index>> part_at_;  // first parameter of each part, from the first effect's
};

}  // namespace stiffscope::diagnosis
