#include "core/calibration/family_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics/parallel.h"
#include "metrology/linear_algebra.h"
#include "metrology/tail_probability.h"

namespace stiffscope::calibration {

namespace {

/// Once or twice a turn of one of the joints is what gears and encoder rings do first; any other order is one of many.
int usualOf(int joints) { return 2 * joints; }

constexpr std::size_t kFewestAside = 5;  // postures on either side of a start: fewer are outliers

}  // namespace

FamilyFit::FamilyFit(const LinearisedDay& day, double chance, int most_parts)
    : day_(day), most_parts_(most_parts), families_(effectFamilies(day.day())) {
  chance_ = chance / static_cast<double>(families_.size());
  prepareColumns();
  prepareStarts();
  periodogram_.emplace(day.equations(), day.postures(), day.day(), day.geometry(), day.geometryAlone().residual);
}

void FamilyFit::prepareColumns() {
  std::vector<EffectTerm> terms;
  // Forms of an effect that are made of the same terms share their columns.
  const auto placeOf = [&](const EffectTerm& term, std::size_t since) {
    for (std::size_t k = since; k < terms.size(); ++k) {
      if (terms[k].name == term.name) return k;
    }
    terms.push_back(term);
    return terms.size() - 1;
  };
  for (const EffectFamily& family : families_) {
    const std::size_t since = terms.size();
    first_column_.push_back(static_cast<Eigen::Index>(since));
    const auto prepare = [&](const std::vector<EffectPart>& parts, std::vector<Prepared>& prepared) {
      for (const EffectPart& part : parts) {
        Prepared& one = prepared.emplace_back();
        one.part = part;
        one.tried = part.tried > 0 ? part.tried : static_cast<int>(parts.size());
        for (const EffectTerm& term : part.terms)
          one.columns.push_back(static_cast<Eigen::Index>(placeOf(term, since)));
      }
    };
    prepare(family.parts, parts_.emplace_back());
    prepare(family.wholes, wholes_.emplace_back());
  }
  columns_ = day_.columnsOf(terms);
  lengths_ = columns_.colwise().norm();
  columns_ = day_.acrossGeometry(columns_);
  const Eigen::Index count = columns_.cols();
  first_column_.push_back(count);
  squares_ = Eigen::MatrixXd::Zero(count, count);
  constexpr Eigen::Index kTogether = 32, kWorthSharing = 100'000;  // columns; numbers
  numerics::onAllCores(
      static_cast<std::size_t>((count + kTogether - 1) / kTogether),
      [&](std::size_t block) {
        const auto from = static_cast<Eigen::Index>(block) * kTogether, own = std::min(kTogether, count - from);
        squares_.block(from, from, count - from, own).noalias() =
            columns_.rightCols(count - from).transpose() * columns_.middleCols(from, own);
      },
      columns_.size() > kWorthSharing);
  squares_.triangularView<Eigen::StrictlyUpper>() = squares_.transpose();
}

void FamilyFit::prepareStarts() {
  const std::vector<PostureEquations>& equations = day_.equations();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(day_.rows(), 6);
  for (std::size_t k = 0; k < equations.size(); ++k)
    motions.middleRows(day_.firstRow(k), equations[k].residual.size()) = equations[k].by_motion;
  frame_start_ = startOf<6>(std::move(motions));
  scale_start_ = startOf<1>(day_.columnsOf(scaleError(-1.0).terms));
  for (std::size_t target = 0; target < day_.day().targets.size(); ++target)
    target_starts_.push_back(
        startOf<3>(day_.columnsOf(targetMotion(day_.day(), static_cast<int>(target), -1.0).terms)));
}

template <int kWidth>
FamilyFit::Start FamilyFit::startOf(Eigen::MatrixXd columns) const {
  Start start{std::move(columns), {}, {}};
  const std::size_t postures = day_.postures().size();
  if (postures < 2 * kFewestAside) return start;
  start.across.resize(postures - 2 * kFewestAside + 1);
  start.own.resize(start.across.size());
  Eigen::Matrix<double, Eigen::Dynamic, kWidth> by_geometry = Eigen::MatrixXd::Zero(day_.geometry().cols(), kWidth);
  Eigen::Matrix<double, kWidth, kWidth> own = Eigen::Matrix<double, kWidth, kWidth>::Zero();
  for (std::size_t k = postures; k-- > kFewestAside;) {
    const Eigen::Index rows = day_.equations()[k].residual.size(), from = day_.firstRow(k);
    const Eigen::Matrix<double, Eigen::Dynamic, kWidth> of_posture = start.columns.middleRows(from, rows);
    by_geometry.noalias() += day_.geometry().middleRows(from, rows).transpose() * of_posture;
    own.noalias() += of_posture.transpose() * of_posture;
    if (k + kFewestAside > postures) continue;
    start.across[k - kFewestAside] = own - by_geometry.transpose() * by_geometry;
    start.own[k - kFewestAside] = own.diagonal();
  }
  return start;
}

FamilyFit::Products FamilyFit::productsOf(const LinearModel& model) const {
  Products products{Eigen::MatrixXd(0, columns_.cols()), columns_.transpose() * model.residual};
  if (model.directions.cols() > 0) products.directions = model.directions.transpose() * columns_;
  return products;
}

void FamilyFit::extend(const LinearModel& model, std::size_t family, Eigen::Index from, Products& products) const {
  const Eigen::Index more = model.directions.cols() - from, first = first_column_[family],
                     count = first_column_[family + 1] - first;
  const auto own = columns_.middleCols(first, count);
  products.residual.segment(first, count).noalias() = own.transpose() * model.residual;
  if (more == 0) return;
  products.directions.conservativeResize(from + more, Eigen::NoChange);
  products.directions.block(from, first, more, count).noalias() = model.directions.rightCols(more).transpose() * own;
}

FamilyFit::Candidate FamilyFit::candidateOf(EffectPart part, int tried) const {
  const Eigen::MatrixXd raw = day_.columnsOf(part.terms);
  return {std::move(part), {day_.acrossGeometry(raw), raw.colwise().norm()}, tried};
}

FamilyFit::Candidate FamilyFit::candidateOf(const Prepared& prepared) const {
  return {prepared.part, {columns_(Eigen::all, prepared.columns), lengths_(prepared.columns)}, prepared.tried};
}

double FamilyFit::fall(double before, double after, double equations) {
  return equations * std::log(before / std::max(1e-300, after));
}

double FamilyFit::penaltyOf(std::size_t terms, int tried) const {
  return static_cast<double>(terms) * std::log(static_cast<double>(day_.postures().size())) +
         2.0 * std::log(static_cast<double>(tried));
}

double FamilyFit::leastPenalty(std::size_t family) const {
  const int postures = static_cast<int>(day_.postures().size());
  switch (families_[family].effect) {
    case UnloadedEffect::transmission_error:
      return penaltyOf(2, usualOf(day_.day().arm.joints()));
    case UnloadedEffect::frame_error:
      return penaltyOf(6, postures);
    case UnloadedEffect::target_motion:
      return penaltyOf(3, postures);
    default:
      break;
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto* forms : {&parts_[family], &wholes_[family]}) {
    for (const Prepared& one : *forms) least = std::min(least, penaltyOf(one.part.terms.size(), one.tried));
  }
  return least;
}

std::optional<FamilyFit::Prepared> FamilyFit::plausible(Prepared prepared, const Products& beside, double& gain) const {
  std::vector<EffectTerm>& terms = prepared.part.terms;
  std::vector<Eigen::Index>& places = prepared.columns;
  const auto count = [&] { return static_cast<Eigen::Index>(terms.size()); };
  const auto leave = [&](Eigen::Index term) {
    terms.erase(terms.begin() + term);
    places.erase(places.begin() + term);
  };
  const auto most = [&](Eigen::Index t) { return terms[static_cast<std::size_t>(t)].most; };
  const auto positive = [&](Eigen::Index t) { return terms[static_cast<std::size_t>(t)].positive; };
  for (Eigen::Index t = count(); t-- > 0;) {
    const Eigen::Index place = places[static_cast<std::size_t>(t)];
    const double left = squares_(place, place) - beside.directions.col(place).squaredNorm();
    constexpr double kSquares = LinearisedDay::kAliased * LinearisedDay::kAliased;
    // A whitened column tells its size to one over its length: to within its bound, or nothing.
    if (!(left > kSquares * lengths_[place] * lengths_[place]) || !(left * most(t) * most(t) > 1.0)) leave(t);
  }
  gain = 0.0;
  while (!terms.empty()) {
    const Eigen::MatrixXd of_directions = beside.directions(Eigen::all, places);
    Eigen::MatrixXd matrix = squares_(places, places);
    if (of_directions.rows() > 0) matrix -= of_directions.transpose() * of_directions;
    constexpr double kDamping = 1e-9;
    matrix.diagonal() += kDamping * lengths_(places).cwiseAbs2();
    const Eigen::VectorXd right = beside.residual(places);
    const Eigen::VectorXd size = solveSymmetric(matrix, right);
    gain = right.dot(size);
    Eigen::Index worst = -1;
    double least = 0.0;
    for (Eigen::Index t = 0; t < size.size(); ++t) {
      const double own = size[t] * std::sqrt(matrix(t, t));
      if (positive(t) && (own < least || (worst < 0 && own <= 0.0))) worst = t, least = own;
    }
    for (Eigen::Index t = 0; worst < 0 && t < size.size(); ++t) {
      if (std::abs(size[t]) > most(t)) worst = t;
    }
    if (worst < 0) break;
    leave(worst);
  }
  const int needed = prepared.part.needs_compliance_of;
  const bool whole = needed < 0 || std::any_of(terms.begin(), terms.end(),
                                               [&](const EffectTerm& term) { return term.compliance_of == needed; });
  if (terms.empty() || !whole) return std::nullopt;
  return prepared;
}

std::optional<FamilyFit::Candidate> FamilyFit::bestPeriodic(const Periodogram& periodogram) const {
  const std::vector<PeriodicPeak> peaks = periodogram.peaks();
  const auto highest = std::max_element(peaks.begin(), peaks.end(),
                                        [](const PeriodicPeak& a, const PeriodicPeak& b) { return a.gain < b.gain; });
  if (highest == peaks.end()) return std::nullopt;
  const int joints = day_.day().arm.joints();
  const bool usual = highest->order == 1.0 || highest->order == 2.0;
  return candidateOf(transmissionError(highest->joint, highest->order),
                     usual ? usualOf(joints) : Periodogram::triedOf(joints));
}

std::optional<FamilyFit::Candidate> FamilyFit::bestPart(std::size_t family, const LinearModel& model,
                                                        const Products& beside, double equations) const {
  if (auto start = bestStart(families_[family].effect, model)) {
    const bool any_target = start->effect == UnloadedEffect::target_motion;
    return candidateOf(std::move(*start),
                       static_cast<int>(day_.postures().size() * (any_target ? target_starts_.size() : 1)));
  }
  std::optional<Prepared> best;
  double most = -std::numeric_limits<double>::infinity();
  const double squares = model.squares();
  for (const Prepared& part : parts_[family]) {
    double gain = 0.0;
    auto prepared = plausible(part, beside, gain);
    if (!prepared) continue;
    const double worth =
        fall(squares, squares - gain, equations) - penaltyOf(prepared->part.terms.size(), prepared->tried);
    if (worth > most) best = std::move(prepared), most = worth;
  }
  if (!best) return std::nullopt;
  return candidateOf(*best);
}

namespace {

/// By how much unknowns with the normal matrix N and right side r lower the sum of squares: r^T N^-1 r.
template <int kWidth>
double explainedSquares(const Eigen::Matrix<double, kWidth, 1>& right,
                        const Eigen::Matrix<double, kWidth, kWidth>& normal) {
  if constexpr (kWidth == 1) {
    return right[0] * (right[0] / normal(0, 0));
  } else {
    return mahalanobisSquared(right, normal);
  }
}

}  // namespace

/// Sums over the postures from there on, for all starts in one pass.
template <int kWidth>
std::pair<double, double> FamilyFit::bestOf(const Start& start, const LinearModel& model) const {
  using Square = Eigen::Matrix<double, kWidth, kWidth>;
  std::pair<double, double> best{0.0, 0.0};
  const std::size_t postures = day_.postures().size();
  Eigen::Matrix<double, Eigen::Dynamic, kWidth> by_model = Eigen::MatrixXd::Zero(model.directions.cols(), kWidth);
  Eigen::Matrix<double, kWidth, 1> right = Eigen::Matrix<double, kWidth, 1>::Zero();
  for (std::size_t k = postures; k-- > kFewestAside;) {
    const Eigen::Index rows = day_.equations()[k].residual.size(), from = day_.firstRow(k);
    const Eigen::Matrix<double, Eigen::Dynamic, kWidth> columns = start.columns.middleRows(from, rows);
    if (by_model.rows() > 0) by_model.noalias() += model.directions.middleRows(from, rows).transpose() * columns;
    right.noalias() += columns.transpose() * model.residual.segment(from, rows);
    if (k + kFewestAside > postures) continue;
    Square across = start.across[k - kFewestAside];
    if (by_model.rows() > 0) across.noalias() -= by_model.transpose() * by_model;
    constexpr double kSquares = LinearisedDay::kAliased * LinearisedDay::kAliased;
    if ((across.diagonal().array() <= kSquares * start.own[k - kFewestAside].array()).any()) continue;
    const double gain = explainedSquares(right, across);
    if (gain > best.first) best = {gain, day_.timeBefore(k)};
  }
  return best;
}

/// What starts at a posture and stays.
std::optional<EffectPart> FamilyFit::bestStart(UnloadedEffect effect, const LinearModel& model) const {
  if (effect == UnloadedEffect::frame_error) {
    const auto best = bestOf<6>(frame_start_, model);
    if (best.first > 0.0) return frameError(best.second);
  }
  if (effect == UnloadedEffect::scale_error) {
    const auto best = bestOf<1>(scale_start_, model);
    if (best.first > 0.0) return scaleError(best.second);
  }
  if (effect != UnloadedEffect::target_motion) return std::nullopt;
  std::pair<double, double> best{0.0, 0.0};
  int moved = -1;
  for (std::size_t target = 0; target < target_starts_.size(); ++target) {
    const auto own = bestOf<3>(target_starts_[target], model);
    if (own.first > best.first) best = own, moved = static_cast<int>(target);
  }
  if (moved < 0) return std::nullopt;
  return targetMotion(day_.day(), moved, best.second);
}

double dearerBy(double unknowns, double equations) { return equations / std::max(1.0, equations - unknowns - 1.0); }

double FamilyFit::paid(const LinearModel& model, double equations) {
  return model.penalty * dearerBy(static_cast<double>(model.directions.cols()), equations);
}

bool FamilyFit::holds(const LinearModel& before, LinearModel& after, std::size_t terms, int tried,
                      double equations) const {
  const double spent = static_cast<double>(after.directions.cols());
  if (spent > kMostSpent * equations) return false;
  const double left = equations - spent, ratio = before.squares() / std::max(1e-300, after.squares());
  const double chance = static_cast<double>(tried) * metrology::fTail((ratio - 1.0) * left / static_cast<double>(terms),
                                                                      static_cast<int>(terms), left);
  after.parts.back().chance = chance;
  after.parts.back().penalty = after.penalty - before.penalty;
  return chance < chance_ &&
         fall(before.squares(), after.squares(), equations) > paid(after, equations) - paid(before, equations);
}

std::optional<LinearModel> FamilyFit::fit(std::size_t family, const LinearModel& others, const Products& beside,
                                          double equations) const {
  auto fitted = fitAlone(family, others, beside, equations);
  if (fitted && !apart(*fitted)) return std::nullopt;
  return fitted;
}

bool FamilyFit::apart(const LinearModel& model) {
  const auto any = [&](UnloadedEffect effect, const std::string& detail) {
    return std::any_of(model.parts.begin(), model.parts.end(),
                       [&](const EffectPart& part) { return part.effect == effect && part.detail == detail; });
  };
  return !(any(UnloadedEffect::gravity_compensator, "") && any(UnloadedEffect::transmission_error, "joint 2")) &&
         !(any(UnloadedEffect::tracker_drift, "") && any(UnloadedEffect::frame_error, ""));
}

std::optional<LinearModel> FamilyFit::fitAlone(std::size_t family, const LinearModel& others, Products beside,
                                               double equations) const {
  const auto with = [&](const LinearModel& before, Candidate candidate) -> std::optional<LinearModel> {
    LinearModel after = before;
    const std::size_t terms = candidate.part.terms.size();
    day_.add(std::move(candidate.part), std::move(candidate.columns), penaltyOf(terms, candidate.tried), after);
    if (!holds(before, after, terms, candidate.tried, equations)) return std::nullopt;
    return after;
  };
  std::optional<Periodogram> periodogram;
  if (families_[family].effect == UnloadedEffect::transmission_error) {
    periodogram = periodogram_;
    periodogram->projectOff(others.directions, others.directions.transpose() * day_.geometryAlone().residual);
  }
  std::optional<LinearModel> best;
  double cost = 0.0;
  const auto consider = [&](LinearModel model) {
    const double own =
        paid(model, equations) - paid(others, equations) - fall(others.squares(), model.squares(), equations);
    if (!best || own < cost) best = std::move(model), cost = own;
  };
  for (const Prepared& whole : wholes_[family]) {
    double gain = 0.0;
    const auto prepared = plausible(whole, beside, gain);
    if (!prepared) continue;
    const double own = penaltyOf(prepared->part.terms.size(), prepared->tried) -
                       fall(others.squares(), others.squares() - gain, equations);
    if (own >= cost) continue;
    if (auto model = with(others, candidateOf(*prepared))) consider(std::move(*model));
  }
  LinearModel by_parts = others;
  // Much that starts at times, one after the other, is no jump.
  constexpr int kMostStarts = 2;
  const UnloadedEffect effect = families_[family].effect;
  const bool starts = effect == UnloadedEffect::frame_error || effect == UnloadedEffect::target_motion ||
                      effect == UnloadedEffect::scale_error;
  const int most = starts ? std::min(kMostStarts, most_parts_) : most_parts_;
  for (int k = 0; k < most; ++k) {
    auto candidate = periodogram ? bestPeriodic(*periodogram) : bestPart(family, by_parts, beside, equations);
    if (!candidate) break;
    auto more = with(by_parts, std::move(*candidate));
    if (!more) break;
    const Eigen::Index before = by_parts.directions.cols(), added = more->directions.cols() - before;
    if (periodogram) {
      periodogram->projectOff(more->directions.rightCols(added),
                              more->directions.rightCols(added).transpose() * by_parts.residual);
    } else {
      extend(*more, family, before, beside);
    }
    by_parts = std::move(*more);
  }
  if (by_parts.parts.size() > others.parts.size()) consider(std::move(by_parts));
  return best;
}

}  // namespace stiffscope::calibration
