#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/calibration/fitted_day.h"

namespace stiffscope::calibration {

/// The best order of one joint: by how much sin and cos of it lower the sum of the squared whitened residuals.
struct PeriodicPeak {
  int joint = 0;
  double order = 0.0;  ///< periods a turn of the joint
  double gain = 0.0;
};

/// Least-squares periodogram of residuals over a joint's angle (P. Vanicek; N. R. Lomb 1976; J. D. Scargle 1982), for
/// every joint and orders 1 to 100: what a sin(k q_j) + b cos(k q_j) on joint j explains, with everything in an
/// orthonormal basis projected off both. Parts that are found later are projected off as they come, which costs two
/// products an order.
class Periodogram {
 public:
  static constexpr double kFirst = 1.0, kLast = 100.0, kStep = 0.25;
  static constexpr int kOrders = 397;                          ///< (kLast - kFirst) / kStep + 1
  static int triedOf(int joints) { return joints * kOrders; }  ///< for the probability of a false alarm

  /// `basis`: columns are orthonormal; `residual` is across them. Rows posture by posture as in `equations`.
  Periodogram(const std::vector<PostureEquations>& equations, const std::vector<std::size_t>& postures,
              const UnloadedDay& day, const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual);

  /// More orthonormal directions, and the residual's coefficients along them.
  void projectOff(const Eigen::MatrixXd& directions, const Eigen::VectorXd& coefficients);

  /// The best of each joint.
  std::vector<PeriodicPeak> peaks() const;

 private:
  struct OfJoint {
    std::shared_ptr<const Eigen::MatrixXd> waves;  ///< postures x 2 orders: sines, then cosines; copies share them
    Eigen::VectorXd right;                         ///< of each wave with the residual
    Eigen::ArrayXd ss, cc, sc;                     ///< products of sine and cosine of an order, across the basis
    Eigen::ArrayXd ss_all, cc_all;                 ///< before anything was projected off
  };

  /// Products of each wave with columns of rows, by the joint's own columns.
  Eigen::MatrixXd productsOf(std::size_t joint, const Eigen::MatrixXd& columns) const;
  void takeOff(std::size_t joint, const Eigen::MatrixXd& products);

  const std::vector<PostureEquations>* equations_;
  PerJoint<OfJoint> joints_;
};

/// Whitened columns of a part's terms across the geometry, and their lengths before that was projected off.
struct PartColumns {
  Eigen::MatrixXd across;
  Eigen::VectorXd lengths;
};

/// Effects beside the geometry, as far as they are linear about it: what is left and what was spent on it.
struct LinearModel {
  std::vector<EffectPart> parts = {};
  std::vector<std::shared_ptr<const PartColumns>> columns = {};  ///< of each part
  Eigen::MatrixXd directions;  ///< orthonormal, across the geometry: what the parts can do
  Eigen::VectorXd residual;    ///< whitened
  double penalty = 0.0;        ///< of BIC, and of the alternatives that were tried

  double squares() const { return residual.squaredNorm(); }
};

/// How the postures that take part are chosen and divided.
struct LinearisationOptions {
  std::size_t most_postures = 2000;  ///< evenly chosen, neighbours by fours: what comes in pairs is not split
  int inner_folds = 5;
  std::function<int(int pose)> inner_fold;  ///< of each posture, by its place in the campaign
  int outer_folds = 2;                      ///< those that held-out figures are stated for
  std::function<int(int pose)> outer_fold;
};

/// A day's readings as linear equations about a fit of the geometry, whitened by the noise of that fit, with what the
/// geometry can do (and the poses of several stations, of which the nests' equations stand behind the readings')
/// projected off. Readings of weight 0 in the fit take no part.
class LinearisedDay {
 public:
  /// Keeps references to both.
  LinearisedDay(const UnloadedDay& day, const ArmFit& geometry, LinearisationOptions options);

  const UnloadedDay& day() const { return day_; }
  const std::vector<std::size_t>& postures() const { return postures_; }  ///< places in the day's
  const std::vector<PostureEquations>& equations() const { return equations_; }
  Eigen::Index firstRow(std::size_t k) const { return first_row_[k]; }
  Eigen::Index rows() const { return residual_.size(); }
  const Eigen::MatrixXd& geometry() const { return basis_; }  ///< orthonormal
  double timeBefore(std::size_t k) const;                     ///< between that posture and the one before

  LinearModel geometryAlone() const;

  /// The rms noise of one coordinate by which the rows are whitened, m.
  double noise() const;

  /// Whitened columns of terms, the geometry not yet projected off.
  Eigen::MatrixXd columnsOf(const std::vector<EffectTerm>& terms) const;
  Eigen::MatrixXd acrossGeometry(const Eigen::MatrixXd& columns) const;

  /// Adds a part to a model. Columns that the geometry and the model can do themselves add nothing.
  void add(EffectPart part, PartColumns columns, double penalty, LinearModel& model) const;

  /// The model with those parts alone, in their order, that are to stay.
  LinearModel keeping(const LinearModel& model, const std::function<bool(const EffectPart&)>& stays) const;

  /// By how much reflectors of one posture err together in a residual, one at least: variance of their sum.
  double designEffect(const Eigen::VectorXd& residual) const;

  /// Sum of squared whitened residuals, each inner fold by what the others fit, geometry included.
  double heldOut(const LinearModel& model) const;
  /// Squared residuals of each posture, m^2, each outer fold by what the others fit.
  std::vector<double> heldOutByPosture(const LinearModel& model) const;
  /// Sums of these, first of the outer folds, then of other divisions into as many: pieces of postures in a row that
  /// were of one fold stay whole, and which fold a piece is of is drawn, by the same draws for every model.
  std::vector<double> heldOutByDivision(const LinearModel& model, int others) const;

  static constexpr double kAliased = 1e-3;  ///< of a column's length: what is left of it is nothing of its own

 private:
  void addDirections(const PartColumns& columns, LinearModel& model) const;
  void choosePostures(const ArmFit& geometry);
  void gather(const ArmFit& geometry);
  /// Postures in a row that are of one fold.
  struct Run {
    std::size_t first, end;  ///< places in postures_
    Eigen::Index row, rows;
    int fold;
  };
  std::vector<Run> runsOf(const std::vector<int>& fold) const;
  Eigen::MatrixXd allColumns(const LinearModel& model, Eigen::Index from, Eigen::Index rows) const;
  /// To normal equations by all columns: what every fold knows of the stations' poses beforehand.
  void addStations(const LinearModel& model, Eigen::MatrixXd& matrix, Eigen::VectorXd& right) const;
  double plainSquares(std::size_t p, const Eigen::Ref<const Eigen::VectorXd>& residual) const;  ///< m^2
  /// Calls with each posture's whitened residual, its fold predicted by the others: a direction that these do not see
  /// is left alone. Returns the squares of the stations' equations, the mean over the folds.
  template <class Use>
  double holdOut(const LinearModel& model, int folds, const std::vector<int>& fold, const Use& use) const;

  const UnloadedDay& day_;
  const ArmFit& fit_;
  LinearisationOptions options_;
  std::vector<std::size_t> first_reading_;  ///< of each posture of the day
  std::vector<std::size_t> postures_;
  std::vector<PostureEquations> equations_;
  std::vector<Eigen::Index> first_row_;
  std::vector<int> inner_fold_, outer_fold_;  ///< of each posture
  Eigen::MatrixXd basis_;
  Eigen::VectorXd residual_;
  Eigen::Index rows_of_postures_ = 0;  ///< an equation for each part of a station's pose stands behind them
};

/// Besides its parameters each effect has to be worth this: twice what one of a dozen reaches by chance, since what
/// another effect leaves of itself looks like a third one.
inline constexpr double kPriceOfEffect = 16.0;

/// The largest share of the equations that effects' unknowns may take: as many unknowns as equations explain anything,
/// and what they leave is no noise to judge by.
inline constexpr double kMostSpent = 0.5;

/// By what the penalty of p unknowns beside the geometry is multiplied on n equations, n / (n - p - 1) (C. M. Hurvich,
/// C.-L. Tsai 1989, whose correction of AIC this is).
double dearerBy(double unknowns, double equations);

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
  /// A model's penalty as few equations ask it of many unknowns.
  static double paid(const LinearModel& model, double equations);

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
  double chance_;
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
