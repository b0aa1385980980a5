#include "core/calibration/family_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "metrology/linear_algebra.h"

namespace stiffscope::calibration {

namespace {

/// Log of the probability that a chi-square variable of `dof` degrees of freedom exceeds x, from its leading term.
double logTail(double x, int dof) {
  const double half = dof / 2.0;
  return std::min(0.0, -x / 2.0 + (half - 1.0) * std::log(std::max(1e-300, x / 2.0)) - std::lgamma(half));
}

/// Once or twice a turn of one of six joints is what gears and encoder rings do first; any other order is one of many.
constexpr int kUsual = 12;

constexpr std::size_t kFewestAside = 5;  // postures on either side of a start: fewer are outliers

}  // namespace

FamilyFit::FamilyFit(const LinearisedDay& day, double chance, int most_parts)
    : day_(day), most_parts_(most_parts), families_(effectFamilies(day.day())) {
  log_chance_ = std::log(chance / static_cast<double>(families_.size()));
  for (const EffectFamily& family : families_) {
    auto& parts = parts_.emplace_back();
    for (const EffectPart& part : family.parts) parts.push_back(prepare(part));
    auto& wholes = wholes_.emplace_back();
    for (const EffectPart& whole : family.wholes) wholes.push_back(prepare(whole));
  }
  // The only reflector's motion would be the flange's: it has no columns.
  const std::size_t targets = day.day().targets.size() > 1 ? day.day().targets.size() : 0;
  for (std::size_t target = 0; target < targets; ++target)
    target_columns_.push_back(day.columnsOf(targetMotion(day.day(), static_cast<int>(target), -1.0).terms));
  periodogram_.emplace(day.equations(), day.postures(), day.day(), day.geometry(), day.geometryAlone().residual);
}

FamilyFit::Prepared FamilyFit::prepare(EffectPart part) const {
  const Eigen::MatrixXd raw = day_.columnsOf(part.terms);
  return {std::move(part), day_.acrossGeometry(raw), raw.colwise().norm()};
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
      return penaltyOf(2, kUsual);
    case UnloadedEffect::frame_error:
      return penaltyOf(6, postures);
    case UnloadedEffect::target_motion:
      return penaltyOf(3, postures);
    default:
      break;
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Prepared& one : parts_[family])
    least = std::min(least, penaltyOf(one.part.terms.size(), static_cast<int>(parts_[family].size())));
  for (const Prepared& one : wholes_[family])
    least = std::min(least, penaltyOf(one.part.terms.size(), static_cast<int>(wholes_[family].size())));
  return least;
}

std::optional<FamilyFit::Prepared> FamilyFit::plausible(Prepared prepared, const LinearModel& model) const {
  std::vector<EffectTerm>& terms = prepared.part.terms;
  Eigen::MatrixXd across = prepared.columns;
  if (model.directions.cols() > 0) across -= model.directions * (model.directions.transpose() * prepared.columns);
  const auto leave = [&](Eigen::Index term) {
    terms.erase(terms.begin() + term);
    const auto without = [term](const Eigen::MatrixXd& all) {
      Eigen::MatrixXd rest(all.rows(), all.cols() - 1);
      rest << all.leftCols(term), all.rightCols(all.cols() - 1 - term);
      return rest;
    };
    across = without(across);
    prepared.columns = without(prepared.columns);
    prepared.lengths = without(prepared.lengths.transpose()).transpose();
  };
  const auto most = [&](Eigen::Index t) { return terms[static_cast<std::size_t>(t)].most; };
  for (Eigen::Index t = across.cols(); t-- > 0;) {
    const double length = across.col(t).norm();
    // A whitened column tells its size to one over its length: to within its bound, or nothing.
    if (!(length > LinearisedDay::kAliased * prepared.lengths[t]) || !(length * most(t) > 1.0)) leave(t);
  }
  const auto positive = [&](Eigen::Index t) { return terms[static_cast<std::size_t>(t)].positive; };
  while (!terms.empty()) {
    Eigen::MatrixXd matrix = across.transpose() * across;
    constexpr double kDamping = 1e-9;
    matrix.diagonal() += kDamping * prepared.lengths.cwiseAbs2();
    const Eigen::VectorXd size = solveSymmetric(matrix, Eigen::VectorXd(across.transpose() * model.residual));
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

double FamilyFit::gainOf(const Prepared& prepared, const LinearModel& model) const {
  LinearModel with{{}, model.directions, model.residual, 0.0};
  day_.add(prepared.part, prepared.columns, prepared.lengths, 0.0, with);
  return model.squares() - with.squares();
}

std::optional<FamilyFit::Candidate> FamilyFit::bestPart(std::size_t family, const LinearModel& model,
                                                        Periodogram* periodogram) const {
  std::optional<Candidate> best;
  double gain = 0.0;
  if (periodogram != nullptr) {
    const PeriodicPeak* highest = nullptr;
    const std::vector<PeriodicPeak> peaks = periodogram->peaks();
    for (const PeriodicPeak& peak : peaks) {
      if (highest == nullptr || peak.gain > highest->gain) highest = &peak;
    }
    if (highest == nullptr) return std::nullopt;
    const bool usual = highest->order == 1.0 || highest->order == 2.0;
    return Candidate{prepare(transmissionError(highest->joint, highest->order)), usual ? kUsual : Periodogram::kTried};
  }
  if (auto start = bestStart(families_[family].effect, model))
    return Candidate{prepare(std::move(*start)), static_cast<int>(day_.postures().size())};
  for (const Prepared& part : parts_[family]) {
    const auto prepared = plausible(part, model);
    if (!prepared) continue;
    const double own = gainOf(*prepared, model);
    if (!best || own > gain) best = Candidate{*prepared, static_cast<int>(parts_[family].size())}, gain = own;
  }
  return best;
}

/// What starts at a posture and stays: sums over the postures from there on, for all starts in one pass.
std::optional<EffectPart> FamilyFit::bestStart(UnloadedEffect effect, const LinearModel& model) const {
  const std::size_t postures = day_.postures().size();
  const auto search = [&](const auto& columns_of, Eigen::Index width) {
    Eigen::MatrixXd by_geometry = Eigen::MatrixXd::Zero(day_.geometry().cols(), width),
                    by_model = Eigen::MatrixXd::Zero(model.directions.cols(), width),
                    own = Eigen::MatrixXd::Zero(width, width);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(width);
    std::pair<double, double> best{0.0, 0.0};  // gain, time
    for (std::size_t k = postures; k-- > kFewestAside;) {
      const Eigen::MatrixXd columns = columns_of(k);
      const Eigen::Index rows = columns.rows(), from = day_.firstRow(k);
      by_geometry.noalias() += day_.geometry().middleRows(from, rows).transpose() * columns;
      if (by_model.rows() > 0) by_model.noalias() += model.directions.middleRows(from, rows).transpose() * columns;
      own.noalias() += columns.transpose() * columns;
      right.noalias() += columns.transpose() * model.residual.segment(from, rows);
      if (k + kFewestAside > postures) continue;
      const Eigen::MatrixXd across = own - by_geometry.transpose() * by_geometry - by_model.transpose() * by_model;
      constexpr double kSquares = LinearisedDay::kAliased * LinearisedDay::kAliased;
      if ((across.diagonal().array() <= kSquares * own.diagonal().array()).any()) continue;
      const double gain = right.dot(Eigen::VectorXd(solveSymmetric(across, right)));
      if (gain > best.first) best = {gain, day_.timeBefore(k)};
    }
    return best;
  };
  const auto& equations = day_.equations();
  if (effect == UnloadedEffect::frame_error) {
    const auto best = search([&](std::size_t k) -> const Eigen::MatrixXd& { return equations[k].by_motion; }, 6);
    if (best.first > 0.0) return frameError(best.second);
  }
  if (effect == UnloadedEffect::scale_error) {
    const Eigen::MatrixXd always = day_.columnsOf(scaleError(-1.0).terms);
    const auto best = search(
        [&](std::size_t k) -> Eigen::MatrixXd {
          return always.middleRows(day_.firstRow(k), equations[k].residual.size());
        },
        1);
    if (best.first > 0.0) return scaleError(best.second);
  }
  if (effect != UnloadedEffect::target_motion) return std::nullopt;
  std::pair<double, double> best{0.0, 0.0};
  int moved = -1;
  for (std::size_t target = 0; target < target_columns_.size(); ++target) {
    const auto own = search(
        [&](std::size_t k) -> Eigen::MatrixXd {
          return target_columns_[target].middleRows(day_.firstRow(k), equations[k].residual.size());
        },
        3);
    if (own.first > best.first) best = own, moved = static_cast<int>(target);
  }
  if (moved < 0) return std::nullopt;
  return targetMotion(day_.day(), moved, best.second);
}

bool FamilyFit::holds(const LinearModel& before, LinearModel& after, const Candidate& candidate,
                      double equations) const {
  const double chi2 = fall(before.squares(), after.squares(), equations);
  const double log_chance = logTail(chi2, static_cast<int>(candidate.prepared.part.terms.size())) +
                            std::log(static_cast<double>(candidate.tried));
  after.parts.back().chance = std::exp(log_chance);
  after.parts.back().penalty = after.penalty - before.penalty;
  return log_chance < log_chance_ && chi2 > after.penalty - before.penalty;
}

LinearModel FamilyFit::withParts(LinearModel model, const std::vector<EffectPart>& parts, UnloadedEffect but) const {
  for (const EffectPart& part : parts) {
    if (part.effect == but) continue;
    const Prepared prepared = prepare(part);
    day_.add(part, prepared.columns, prepared.lengths, part.penalty, model);
  }
  return model;
}

std::optional<LinearModel> FamilyFit::fit(std::size_t family, const LinearModel& others, double equations) const {
  auto fitted = fitAlone(family, others, equations);
  if (fitted && !apart(*fitted)) return std::nullopt;
  return fitted;
}

bool FamilyFit::apart(const LinearModel& model) {
  const auto any = [&](UnloadedEffect effect, const std::string& detail) {
    return std::any_of(model.parts.begin(), model.parts.end(),
                       [&](const EffectPart& part) { return part.effect == effect && part.detail == detail; });
  };
  return !(any(UnloadedEffect::gravity_compensator, "") && any(UnloadedEffect::transmission_error, "joint 2"));
}

std::optional<LinearModel> FamilyFit::fitAlone(std::size_t family, const LinearModel& others, double equations) const {
  const bool periodic = families_[family].effect == UnloadedEffect::transmission_error;
  std::optional<Periodogram> periodogram;
  if (periodic) {
    periodogram = periodogram_;
    periodogram->projectOff(others.directions, others.directions.transpose() * day_.geometryAlone().residual);
  }
  LinearModel by_parts = others;
  for (int k = 0; k < most_parts_; ++k) {
    const auto candidate = bestPart(family, by_parts, periodic ? &*periodogram : nullptr);
    if (!candidate) break;
    LinearModel with = by_parts;
    day_.add(candidate->prepared.part, candidate->prepared.columns, candidate->prepared.lengths,
             penaltyOf(candidate->prepared.part.terms.size(), candidate->tried), with);
    if (!holds(by_parts, with, *candidate, equations)) break;
    if (periodic) {
      const Eigen::Index more = with.directions.cols() - by_parts.directions.cols();
      periodogram->projectOff(with.directions.rightCols(more),
                              with.directions.rightCols(more).transpose() * by_parts.residual);
    }
    by_parts = std::move(with);
  }
  std::optional<LinearModel> best;
  double cost = 0.0;
  if (by_parts.parts.size() > others.parts.size()) {
    cost = by_parts.penalty - others.penalty - fall(others.squares(), by_parts.squares(), equations);
    best = std::move(by_parts);
  }
  for (const Prepared& whole : wholes_[family]) {
    const auto prepared = plausible(whole, others);
    if (!prepared) continue;
    const Candidate candidate{*prepared, static_cast<int>(wholes_[family].size())};
    LinearModel with = others;
    day_.add(prepared->part, prepared->columns, prepared->lengths,
             penaltyOf(prepared->part.terms.size(), candidate.tried), with);
    if (!holds(others, with, candidate, equations)) continue;
    const double own = with.penalty - others.penalty - fall(others.squares(), with.squares(), equations);
    if (!best || own < cost) best = std::move(with), cost = own;
  }
  return best;
}

}  // namespace stiffscope::calibration
