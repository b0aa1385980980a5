#pragma once

#include <optional>
#include <utility>
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

  /// All known columns beside a model: their products with its directions and with its residual.
  struct Products {
    Eigen::MatrixXd directions;
    Eigen::VectorXd residual;
  };
  Products productsOf(const LinearModel& model) const;

  /// `others` with this family's parts in it; empty where none holds against chance. `beside`: the products of
  /// `others`, the same for all families. `equations`: how many the rows are worth.
  std::optional<LinearModel> fit(std::size_t family, const LinearModel& others, const Products& beside,
                                 double equations) const;

  /// Penalty of the family's form with the fewest terms.
  double leastPenalty(std::size_t family) const;

  /// Fall of -2 log likelihood of `equations` normal residuals when their squares fall from one to the other.
  static double fall(double before, double after, double equations);

 private:
  /// A part that is known beforehand: its columns among `columns_`.
  struct Prepared {
    EffectPart part;
    std::vector<Eigen::Index> columns;
    int tried = 1;
  };
  /// A part to be added.
  struct Candidate {
    EffectPart part;
    PartColumns columns;
    int tried = 1;
  };
  /// What may start at any posture and stays, without times: `across[k]` are products of its columns from posture
  /// kFewestAside + k on, the geometry projected off, and `own[k]` their squares before.
  struct Start {
    Eigen::MatrixXd columns;  ///< from the first posture on
    std::vector<Eigen::MatrixXd> across;
    std::vector<Eigen::VectorXd> own;
  };

  std::optional<LinearModel> fitAlone(std::size_t family, const LinearModel& others, Products beside,
                                      double equations) const;
  /// False where two effects are in a model that would share one joint's angle out between them: a compensator on axis
  /// 2 is its first harmonics, and joint 2's periodic errors have them too.
  static bool apart(const LinearModel& model);
  void prepareColumns();
  void prepareStarts();
  template <int kWidth>
  Start startOf(Eigen::MatrixXd columns) const;
  /// The best gain of one kind of start, and its time.
  template <int kWidth>
  std::pair<double, double> bestOf(const Start& start, const LinearModel& model) const;
  /// For directions that were added to the model last; of this family's columns.
  void extend(const LinearModel& model, std::size_t family, Eigen::Index from, Products& products) const;
  Candidate candidateOf(EffectPart part, int tried) const;
  Candidate candidateOf(const Prepared& prepared) const;
  /// Without terms that the day does not tell beside the model, and without those that would be of the wrong sign, the
  /// most wrong one first, or beyond their physical bound. `gain`: by how much the rest lowers the squares.
  std::optional<Prepared> plausible(Prepared prepared, const Products& beside, double& gain) const;
  std::optional<Candidate> bestPart(std::size_t family, const LinearModel& model, const Products& beside,
                                    double equations) const;
  std::optional<Candidate> bestPeriodic(const Periodogram& periodogram) const;
  std::optional<EffectPart> bestStart(UnloadedEffect effect, const LinearModel& model) const;
  double penaltyOf(std::size_t terms, int tried) const;
  bool holds(const LinearModel& before, LinearModel& after, std::size_t terms, int tried, double equations) const;

  const LinearisedDay& day_;
  double log_chance_;
  int most_parts_;
  std::vector<EffectFamily> families_;
  std::vector<std::vector<Prepared>> parts_, wholes_;  ///< of each family
  std::vector<Eigen::Index> first_column_;             ///< of each family's, and their number
  Eigen::MatrixXd columns_;                            ///< of all of these, across the geometry
  Eigen::VectorXd lengths_;                            ///< before that
  Eigen::MatrixXd squares_;                            ///< products of the columns with each other
  Start frame_start_, scale_start_;
  std::vector<Start> target_starts_;        ///< of each reflector
  std::optional<Periodogram> periodogram_;  ///< across the geometry alone
};

}  // namespace stiffscope::calibration
