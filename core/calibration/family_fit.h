#pragma once

#include <optional>
#include <vector>

#include "core/calibration/linearised_day.h"
#include "core/calibration/periodogram.h"

namespace stiffscope::calibration {

/// Each effect of the vocabulary fitted on its own beside a given model: its best parts, or its best whole form.
class FamilyFit {
 public:
  /// `chance`: largest probability that noise alone makes a part look as large as it does, over all that were tried.
  FamilyFit(const LinearisedDay& day, double chance, int most_parts);

  const std::vector<EffectFamily>& families() const { return families_; }

  /// The model with this family's parts in it; empty where none holds against chance. `equations`: how many the rows
  /// are worth.
  std::optional<LinearModel> fit(std::size_t family, const LinearModel& others, double equations) const;

  /// Of the family's form with the fewest terms.
  double leastPenalty(std::size_t family) const;

  /// `model` with those of `parts` that are not of `but`, with their penalties.
  LinearModel withParts(LinearModel model, const std::vector<EffectPart>& parts, UnloadedEffect but) const;

  /// Fall of -2 log likelihood of `equations` normal residuals when their squares fall from one to the other.
  static double fall(double before, double after, double equations);

 private:
  /// Columns of a part across the geometry, and their lengths before.
  struct Prepared {
    EffectPart part;
    Eigen::MatrixXd columns;
    Eigen::VectorXd lengths;
  };
  struct Candidate {
    Prepared prepared;
    int tried = 1;
  };

  std::optional<LinearModel> fitAlone(std::size_t family, const LinearModel& others, double equations) const;
  /// False where two effects are in a model that would share one joint's angle out between them: a compensator on axis
  /// 2 is its first harmonics, and joint 2's periodic errors have them too.
  static bool apart(const LinearModel& model);
  Prepared prepare(EffectPart part) const;
  /// Without terms that the day does not tell beside `model`, and without those that would be of the wrong sign, the
  /// most wrong one first, or beyond their physical bound.
  std::optional<Prepared> plausible(Prepared prepared, const LinearModel& model) const;
  std::optional<Candidate> bestPart(std::size_t family, const LinearModel& model, Periodogram* periodogram) const;
  std::optional<EffectPart> bestStart(UnloadedEffect effect, const LinearModel& model) const;
  double penaltyOf(std::size_t terms, int tried) const;
  bool holds(const LinearModel& before, LinearModel& after, const Candidate& candidate, double equations) const;
  double gainOf(const Prepared& prepared, const LinearModel& model) const;

  const LinearisedDay& day_;
  double log_chance_;
  int most_parts_;
  std::vector<EffectFamily> families_;
  std::vector<std::vector<Prepared>> parts_, wholes_;  ///< of each family
  std::vector<Eigen::MatrixXd> target_columns_;        ///< of each reflector's motion, raw
  std::optional<Periodogram> periodogram_;             ///< across the geometry alone
};

}  // namespace stiffscope::calibration
