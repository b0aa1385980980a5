#include "core/identification/outliers.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/estimate.h"
#include "core/identification/remarks.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"
#include "metrology/tail_probability.h"

namespace stiffscope::identification {

namespace {

constexpr double kLevel = 0.001;
constexpr std::size_t kFewest = 5;
constexpr double kMostHidden = 0.25;  // of the postures: where more disagree at once, it is not they that are wrong

/// One posture in a fit of all.
struct Posture {
  const CaseEquations* equations = nullptr;
  Eigen::VectorXd residual;  ///< r at the common compliances
  NormalEquations normal;    ///< A^T A, A^T r
};

/// What a pass over the postures needs of all of them, so that leaving one out costs nothing of the others.
/// With c(without p) = c + d the residual of another posture q is r_q - A_q d.
class Sums {
 public:
  explicit Sums(const std::vector<Posture>& postures) {
    for (const Posture& one : postures) {
      normal += one.normal;
      squares += one.residual.squaredNorm();
      rows += one.residual.size();
    }
  }

  /// What momentsWithout takes: one pass more, which few campaigns need.
  void addMoments(const std::vector<Posture>& postures) {
    const Eigen::Index common = postures.front().residual.size();
    if (std::all_of(postures.begin(), postures.end(),
                    [&](const Posture& one) { return one.residual.size() == common; })) {
      addCommonMoments(postures);
    }
  }

  /// Second moments of the other postures' residuals; empty without common coordinates.
  Eigen::MatrixXd momentsWithout(const Posture& own, const JointVector& d) const {
    const Eigen::Index columns = d.size() + 1, rows = moments_.rows() / columns;
    Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints + 1, 1> mix(columns);
    mix << -d, 1.0;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, rows);
    for (Eigen::Index k = 0; k < columns; ++k) {
      for (Eigen::Index l = 0; l < columns; ++l)
        sum += mix[k] * mix[l] * moments_.block(k * rows, l * rows, rows, rows);
    }
    const Eigen::VectorXd moved = own.residual - own.equations->matrix * d;
    if (rows > 0) sum -= moved * moved.transpose();
    return sum;
  }

  NormalEquations normal;
  double squares = 0.0;
  Eigen::Index rows = 0;

 private:
  /// Some columns of the sum at a time, each over the postures in their order.
  void addCommonMoments(const std::vector<Posture>& postures) {
    const Eigen::Index rows = postures.front().residual.size(), columns = postures.front().equations->matrix.cols() + 1,
                       size = columns * rows;
    Eigen::MatrixXd entries(size, static_cast<Eigen::Index>(postures.size()));
    numerics::smallWorkOnAllCores(postures.size(), [&](std::size_t p) {
      entries.col(static_cast<Eigen::Index>(p)) << postures[p].equations->matrix.reshaped(), postures[p].residual;
    });
    moments_.setZero(size, size);
    numerics::onAllCores(
        static_cast<std::size_t>(rows),
        [&](std::size_t block) {
          const Eigen::Index from = columns * static_cast<Eigen::Index>(block);
          for (Eigen::Index p = 0; p < entries.cols(); ++p) {
            const auto own = entries.col(p);
            for (Eigen::Index c = from; c < from + columns; ++c)
              moments_.col(c).tail(size - c) += own[c] * own.tail(size - c);
          }
        },
        postures.size() >= numerics::kWorthThreads);
    moments_.triangularView<Eigen::StrictlyUpper>() = moments_.transpose().eval();
  }

  Eigen::MatrixXd moments_;  ///< of [A r], all its entries with all
};

NormalEquations without(const NormalEquations& sum, const Posture& own) {
  return {sum.matrix - own.normal.matrix, sum.right - own.normal.right};
}

/// Degrees of freedom left to the others.
double dofWithout(const Sums& all, const Posture& own, double unknowns) {
  return static_cast<double>(all.rows - own.residual.size()) - unknowns;
}

/// All but the p value; f 0 where the others leave nothing to judge by.
OutlyingPosture judge(const Sums& all, const Posture& own, const robot::JointMask& unknown, double unknowns) {
  const JointVector step = solveNormal(without(all.normal, own), unknown);
  const Eigen::VectorXd deleted = own.residual - own.equations->matrix * step;
  const double coordinates = static_cast<double>(deleted.size());
  OutlyingPosture result;
  result.posture = own.equations->posture;
  result.rms = std::sqrt(deleted.squaredNorm() / coordinates);
  // (I - H) e = r, so that e^T (I - H) e is r^T e: what leaving it out takes off the sum of squares, too.
  const double studentised = own.residual.dot(deleted), sum = all.squares - studentised,
               rows = static_cast<double>(all.rows) - coordinates;
  result.others = std::sqrt(std::max(0.0, sum) / rows);
  const double left = dofWithout(all, own, unknowns);
  if (!(left > 0.0) || !(sum > 0.0)) return result;
  result.f = studentised / coordinates / (sum / left);
  return result;
}

/// Whether it can be outlying: by as many degrees of freedom as it has coordinates, the most there can be.
/// Fewer only make so small a tail larger.
bool canBeOutlying(const Sums& all, const Posture& own, double f, double unknowns, double postures) {
  const auto coordinates = static_cast<int>(own.residual.size());
  // No F distribution has less than 0.3 above 1.
  return f > 1.0 && metrology::fTail(f, coordinates, dofWithout(all, own, unknowns)) * postures < kLevel;
}

double pValue(const Sums& all, const Posture& own, double f, const robot::JointMask& unknown, double unknowns,
              double postures) {
  const JointVector step = solveNormal(without(all.normal, own), unknown);
  // How many independent numbers a posture's residual is; without common coordinates the least there can be.
  const double per_posture = std::max(1.0, satterthwaite(all.momentsWithout(own, step)));
  const double below = per_posture * dofWithout(all, own, unknowns) / static_cast<double>(own.residual.size());
  const double tail = metrology::fTail(f, std::max(1, static_cast<int>(per_posture)), std::max(1.0, below));
  return std::min(1.0, tail * postures);
}

/// Residuals at the least squares solution of these equations.
std::vector<Posture> fitAll(const std::vector<const CaseEquations*>& equations, const robot::JointMask& unknown) {
  std::vector<Posture> postures(equations.size());
  numerics::smallWorkOnAllCores(equations.size(), [&](std::size_t p) {
    postures[p] = {equations[p], {}, normalEquations(*equations[p])};
  });
  const auto sum = numerics::sumInBlocks<NormalEquations>(
      postures.size(), [&](std::size_t p, NormalEquations& all) { all += postures[p].normal; });
  const JointVector compliance = solveNormal(sum, unknown);
  numerics::smallWorkOnAllCores(equations.size(), [&](std::size_t p) {
    const auto& matrix = equations[p]->matrix;
    postures[p].residual = equations[p]->right - matrix * compliance;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      postures[p].normal.right[j] = matrix.col(j).dot(postures[p].residual);
  });
  return postures;
}

/// The one that disagrees most with the rest; p value 1 where none can be outlying.
OutlyingPosture worstOf(const std::vector<Posture>& postures, const robot::JointMask& unknown, double unknowns,
                        std::size_t& worst) {
  const auto count = static_cast<double>(postures.size());
  Sums sums(postures);
  std::vector<OutlyingPosture> judged(postures.size());
  std::vector<char> can_be(postures.size());
  numerics::smallWorkOnAllCores(postures.size(), [&](std::size_t p) {
    judged[p] = judge(sums, postures[p], unknown, unknowns);
    can_be[p] = canBeOutlying(sums, postures[p], judged[p].f, unknowns, count);
  });
  OutlyingPosture most;
  if (std::find(can_be.begin(), can_be.end(), char{true}) == can_be.end()) return most;
  sums.addMoments(postures);
  numerics::smallWorkOnAllCores(postures.size(), [&](std::size_t p) {
    if (can_be[p]) judged[p].p_value = pValue(sums, postures[p], judged[p].f, unknown, unknowns, count);
  });
  for (std::size_t p = 0; p < postures.size(); ++p) {
    if (judged[p].p_value < most.p_value) most = judged[p], worst = p;
  }
  return most;
}
/// The fit to postures that are not suspected, by which others are judged: as judge and pValue do for one that is left
/// out of all.
class FitOfOthers {
 public:
  FitOfOthers(const std::vector<const CaseEquations*>& others, const robot::JointMask& unknown)
      : unknown_(unknown), coordinates_(others.front()->right.size()) {
    normal_ = numerics::sumInBlocks<NormalEquations>(
        others.size(), [&](std::size_t p, NormalEquations& sum) { sum += normalEquations(*others[p]); });
    compliance_ = solveNormal(normal_, unknown);
    moments_.setZero(coordinates_, coordinates_);
    for (const CaseEquations* one : others) {
      const Eigen::VectorXd residual = one->right - one->matrix * compliance_;
      const double count = static_cast<double>(residual.size());
      squares_ += residual.squaredNorm();
      rows_ += count;
      largest_ = std::max(largest_, std::sqrt(residual.squaredNorm() / count));
      if (residual.size() != coordinates_) coordinates_ = 0;
      if (coordinates_ > 0) moments_ += residual * residual.transpose();
    }
    if (coordinates_ > 0) independent_ = std::max(1.0, satterthwaite(moments_));
  }

  /// Largest residual of a posture of the fit, per coordinate, m.
  double largest() const { return largest_; }

  /// `unknowns`: joints solved for. `postures`: how many are judged, all together.
  OutlyingPosture judged(const CaseEquations& own, double unknowns, double postures) const {
    const Eigen::VectorXd deleted = own.right - own.matrix * compliance_;
    NormalEquations with = normalEquations(own);
    with.matrix += normal_.matrix;
    with.right = own.matrix.transpose() * deleted;
    const double count = static_cast<double>(deleted.size()), left = rows_ - unknowns;
    OutlyingPosture one;
    one.posture = own.posture;
    one.rms = std::sqrt(deleted.squaredNorm() / count);
    one.others = std::sqrt(squares_ / rows_);
    if (!(left > 0.0) || !(squares_ > 0.0)) return one;
    one.f = deleted.dot(deleted - own.matrix * solveNormal(with, unknown_)) / count / (squares_ / left);
    const double per_posture = deleted.size() == coordinates_ ? independent_ : 1.0;
    const double tail =
        metrology::fTail(one.f, std::max(1, static_cast<int>(per_posture)), std::max(1.0, per_posture * left / count));
    one.p_value = std::min(1.0, tail * postures);
    return one;
  }

 private:
  robot::JointMask unknown_;
  NormalEquations normal_;
  JointVector compliance_;
  Eigen::MatrixXd moments_;       ///< of the residuals
  Eigen::Index coordinates_ = 0;  ///< of each posture; 0 where they differ
  double squares_ = 0.0, rows_ = 0.0, largest_ = 0.0, independent_ = 1.0;
};

/// The worst is taken away first and the rest judged again; `rest` is left with the others.
std::vector<OutlyingPosture> oneByOne(std::vector<const CaseEquations*>& rest, const robot::JointMask& unknown,
                                      double unknowns) {
  std::vector<OutlyingPosture> found;
  const std::size_t all = rest.size();
  while (rest.size() >= kFewest && 2 * rest.size() > all) {
    std::size_t worst = 0;
    const OutlyingPosture most = worstOf(fitAll(rest, unknown), unknown, unknowns, worst);
    if (most.p_value >= kLevel) break;
    found.push_back(most);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  return found;
}

/// By posture, its residual per coordinate against a fit that several wrong postures do not pull to themselves: first
/// least sums of residuals instead of squares, which has one solution, then Cauchy weights, which leave those far off
/// none. The scale is the median of the postures.
std::vector<double> robustResiduals(const std::vector<const CaseEquations*>& equations,
                                    const robot::JointMask& unknown) {
  struct Parts {
    NormalEquations normal;
    double squares = 0.0, rows = 0.0;

    double residual(const JointVector& c) const {
      const double left = squares - 2.0 * c.dot(normal.right) + c.dot(normal.matrix * c);
      return std::sqrt(std::max(0.0, left) / rows);
    }
  };
  std::vector<Parts> postures(equations.size());
  numerics::smallWorkOnAllCores(equations.size(), [&](std::size_t p) {
    postures[p] = {normalEquations(*equations[p]), equations[p]->right.squaredNorm(),
                   static_cast<double>(equations[p]->right.size())};
  });
  std::vector<double> residuals(equations.size(), 0.0), weights(equations.size(), 1.0);
  constexpr int kRounds = 30;  // of each kind
  bool of_sums = true;
  for (int round = 0; round < 2 * kRounds; ++round) {
    NormalEquations sum(static_cast<Eigen::Index>(unknown.size()));
    for (std::size_t p = 0; p < postures.size(); ++p) {
      sum.matrix += weights[p] * postures[p].normal.matrix;
      sum.right += weights[p] * postures[p].normal.right;
    }
    const JointVector compliance = solveNormal(sum, unknown);
    double change = 0.0;
    for (std::size_t p = 0; p < postures.size(); ++p) {
      const double before = residuals[p];
      residuals[p] = postures[p].residual(compliance);
      change = std::max(change, std::abs(residuals[p] - before));
    }
    const double scale = numerics::upperMedian(residuals);
    constexpr double kLeast = 0.1, kSettled = 0.01;  // of the scale: nearer, a posture is met
    if (!(scale > 0.0) || (!of_sums && change < kSettled * scale)) break;
    of_sums = of_sums && change >= kSettled * scale && round < kRounds;
    for (std::size_t p = 0; p < postures.size(); ++p) {
      const double apart = residuals[p] / scale;
      weights[p] = of_sums ? 1.0 / std::max(kLeast, apart) : 1.0 / (1.0 + apart * apart);
    }
  }
  return residuals;
}

/// Those that the others hide from the one by one, all at once: suspected are those far from a robust fit, and each is
/// judged by the fit of those that are not. One that does not disagree with these joins them, and the rest are judged
/// again. `found` are those that were found one by one, judged with the others. Empty where nothing was hidden, and
/// where it does not stand apart: what the model lacks puts postures at all distances.
std::vector<OutlyingPosture> allAtOnce(const std::vector<const CaseEquations*>& equations,
                                       const std::vector<OutlyingPosture>& found, const robot::JointMask& unknown,
                                       double unknowns) {
  constexpr double kFar = 2.5;  // times the median
  const std::vector<double> residuals = robustResiduals(equations, unknown);
  const double far = kFar * numerics::upperMedian(residuals);
  std::vector<const CaseEquations*> suspected, others;
  for (std::size_t p = 0; p < equations.size(); ++p) {
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const OutlyingPosture& one) { return one.posture == equations[p]->posture; });
    (known || residuals[p] > far ? suspected : others).push_back(equations[p]);
  }
  while (suspected.size() > found.size() && others.size() >= kFewest && 2 * others.size() > equations.size()) {
    const FitOfOthers fit(others, unknown);
    std::vector<OutlyingPosture> all;
    std::vector<const CaseEquations*> still;
    double nearest = std::numeric_limits<double>::infinity();
    for (const CaseEquations* one : suspected) {
      all.push_back(fit.judged(*one, unknowns, static_cast<double>(equations.size())));
      nearest = std::min(nearest, all.back().rms);
      (all.back().p_value < kLevel ? still : others).push_back(one);
    }
    if (still.size() < suspected.size()) {
      suspected = std::move(still);
      continue;
    }
    constexpr double kApart = 3.0;
    if (nearest < kApart * fit.largest() ||
        static_cast<double>(all.size()) > kMostHidden * static_cast<double>(equations.size()))
      return {};
    std::stable_sort(all.begin(), all.end(),
                     [](const OutlyingPosture& a, const OutlyingPosture& b) { return a.f > b.f; });
    return all;
  }
  return {};
}

}  // namespace

std::vector<OutlyingPosture> outlyingPostures(const std::vector<CaseEquations>& equations,
                                              const robot::JointMask& unknown) {
  std::vector<const CaseEquations*> all;
  for (const CaseEquations& one : equations) all.push_back(&one);
  const auto unknowns = static_cast<double>(std::count(unknown.begin(), unknown.end(), true));
  if (unknowns == 0.0 || all.size() < kFewest) return {};
  std::vector<const CaseEquations*> rest = all;
  const std::vector<OutlyingPosture> found = oneByOne(rest, unknown, unknowns);
  const std::vector<OutlyingPosture> hidden = allAtOnce(all, found, unknown, unknowns);
  return hidden.empty() ? found : hidden;
}

namespace {

template <class Table>
void drop(Table& table, const std::vector<bool>& dropped) {
  if (!table) return;
  std::erase_if(table->rows, [&](const auto& row) { return dropped[static_cast<std::size_t>(row.pose)]; });
  table->rows.shrink_to_fit();  // most of a long day may go
}

}  // namespace

void dropPostures(const std::vector<bool>& dropped, campaign::Campaign& campaign) {
  drop(campaign.loading, dropped);
  drop(campaign.states, dropped);
  drop(campaign.displacements, dropped);
}

campaign::Campaign withoutPostures(const campaign::Campaign& campaign, const std::vector<OutlyingPosture>& postures) {
  std::vector<bool> dropped(campaign.pose_ids.size(), false);
  for (const OutlyingPosture& one : postures) dropped[static_cast<std::size_t>(one.posture)] = true;
  campaign::Campaign rest = campaign;
  dropPostures(dropped, rest);
  return rest;
}

void nameLeftOut(const campaign::Campaign& campaign, const std::vector<OutlyingPosture>& postures,
                 std::vector<LeftOutPosture>& left_out) {
  for (const OutlyingPosture& one : postures) {
    const std::string& pose = campaign.pose_ids[static_cast<std::size_t>(one.posture)];
    std::erase_if(left_out, [&](const LeftOutPosture& other) { return other.pose == pose; });
    left_out.push_back({pose, Remark(RemarkId::disagrees, one.rms, one.rms / one.others)});
  }
}

}  // namespace stiffscope::identification
