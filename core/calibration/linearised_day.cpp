#include "core/calibration/family_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::calibration {

LinearisedDay::LinearisedDay(const UnloadedDay& day, const ArmFit& geometry, LinearisationOptions options)
    : day_(day), fit_(geometry), options_(std::move(options)) {
  choosePostures(geometry);
  gather(geometry);
}

void LinearisedDay::choosePostures(const ArmFit& geometry) {
  std::vector<std::size_t> usable;
  std::size_t reading = 0;
  for (std::size_t i = 0; i < day_.postures.size(); ++i) {
    first_reading_.push_back(reading);
    bool any = false;
    for (std::size_t k = 0; k < day_.postures[i].readings.size(); ++k, ++reading)
      any = any || geometry.weights[reading] > 0.0;
    if (any) usable.push_back(i);
  }
  constexpr std::size_t kTogether = 4;
  const std::size_t most = std::max<std::size_t>(1, options_.most_postures);
  const std::size_t every = std::max<std::size_t>(1, (usable.size() + most - 1) / most);
  for (std::size_t k = 0; k < usable.size(); ++k) {
    if ((k / kTogether) % every == 0) postures_.push_back(usable[k]);
  }
}

void LinearisedDay::gather(const ArmFit& geometry) {
  Eigen::Index rows = 0;
  const FittedDay fitted(day_, geometry);
  equations_.resize(postures_.size());
  numerics::smallWorkOnAllCores(postures_.size(), [&](std::size_t k) {
    equations_[k] = equationsOf(fitted, day_.postures[postures_[k]], first_reading_[postures_[k]]);
  });
  for (std::size_t k = 0; k < postures_.size(); ++k) {
    first_row_.push_back(rows);
    rows += equations_[k].residual.size();
    inner_fold_.push_back(options_.inner_fold(day_.postures[postures_[k]].pose));
    outer_fold_.push_back(options_.outer_fold(day_.postures[postures_[k]].pose));
  }
  const auto parameters = static_cast<Eigen::Index>(geometry.free.size());
  rows_of_postures_ = rows;
  rows += static_cast<Eigen::Index>(geometry.stations.size());
  Eigen::MatrixXd jacobian(rows, parameters);
  residual_.resize(rows);
  for (std::size_t k = 0; k < postures_.size(); ++k) {
    jacobian.middleRows(first_row_[k], equations_[k].residual.size()) = equations_[k].by_parameters;
    residual_.segment(first_row_[k], equations_[k].residual.size()) = equations_[k].residual;
  }
  // What is known of the stations' poses beforehand: an equation each, in parts of its standard uncertainty.
  jacobian.bottomRows(rows - rows_of_postures_).setZero();
  for (Eigen::Index k = 0; k < parameters; ++k) {
    const Eigen::Index pose = geometry.free[static_cast<std::size_t>(k)] - geometry.stationsAt();
    if (pose < 0) continue;
    jacobian(rows_of_postures_ + pose, k) = 1.0;
    residual_[rows_of_postures_ + pose] = -geometry.sizes[geometry.stationsAt() - geometry.steps.size() + pose];
  }
  // Orthonormal basis of what geometry can do, by way of the normal matrix of columns of length one.
  const Eigen::VectorXd length = jacobian.colwise().norm();
  for (Eigen::Index k = 0; k < parameters; ++k) jacobian.col(k) /= std::max(1e-300, length[k]);
  const SymmetricEigen eigen = symmetricEigen(jacobian.transpose() * jacobian);
  constexpr double kNothing = 1e-9;
  Eigen::Index rank = 0;
  for (Eigen::Index k = 0; k < parameters; ++k) rank += eigen.values[k] > kNothing ? 1 : 0;
  basis_ = jacobian * eigen.vectors.rightCols(rank) * eigen.values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  residual_ -= basis_ * (basis_.transpose() * residual_);
}

double LinearisedDay::noise() const {
  double declared = 0.0, count = 0.0;
  for (const std::size_t i : postures_) {
    for (const Reading& reading : day_.postures[i].readings) declared += reading.covariance.trace() / 3.0, ++count;
  }
  return std::sqrt(declared / std::max(1.0, count) + fit_.model_sd * fit_.model_sd);
}

double LinearisedDay::timeBefore(std::size_t k) const {
  return (day_.postures[postures_[k]].time + day_.postures[postures_[k - 1]].time) / 2.0;
}

LinearModel LinearisedDay::geometryAlone() const {
  LinearModel model;
  model.directions.resize(residual_.size(), 0);
  model.residual = residual_;
  return model;
}

Eigen::MatrixXd LinearisedDay::columnsOf(const std::vector<EffectTerm>& terms) const {
  Eigen::MatrixXd columns(residual_.size(), static_cast<Eigen::Index>(terms.size()));
  columns.bottomRows(residual_.size() - rows_of_postures_).setZero();
  const FittedDay fitted(day_, fit_);
  numerics::smallWorkOnAllCores(postures_.size(), [&](std::size_t k) {
    columns.middleRows(first_row_[k], equations_[k].residual.size()) =
        calibration::columnsOf(fitted, day_.postures[postures_[k]], equations_[k], terms);
  });
  return columns;
}

Eigen::MatrixXd LinearisedDay::acrossGeometry(const Eigen::MatrixXd& columns) const {
  constexpr Eigen::Index kTogether = 32, kWorthSharing = 100'000;  // columns; numbers
  Eigen::MatrixXd across(columns.rows(), columns.cols());
  numerics::onAllCores(
      static_cast<std::size_t>((columns.cols() + kTogether - 1) / kTogether),
      [&](std::size_t block) {
        const auto from = static_cast<Eigen::Index>(block) * kTogether;
        const auto own = columns.middleCols(from, std::min(kTogether, columns.cols() - from));
        across.middleCols(from, own.cols()) = own - basis_ * (basis_.transpose() * own);
      },
      columns.size() > kWorthSharing);
  return across;
}

void LinearisedDay::addDirections(const PartColumns& columns, LinearModel& model) const {
  const Eigen::Index before = model.directions.cols();
  Eigen::Index count = before;
  model.directions.conservativeResize(Eigen::NoChange, before + columns.across.cols());
  for (Eigen::Index k = 0; k < columns.across.cols(); ++k) {
    Eigen::VectorXd direction = columns.across.col(k);
    const auto others = model.directions.leftCols(count);
    // Twice is enough (Kahan, Parlett).
    for (int turn = 0; turn < 2; ++turn) direction -= others * (others.transpose() * direction);
    const double length = direction.norm();
    if (!(length > kAliased * columns.lengths[k])) continue;
    direction /= length;
    model.directions.col(count++) = direction;
    model.residual -= direction * direction.dot(model.residual);
  }
  model.directions.conservativeResize(Eigen::NoChange, count);
}

void LinearisedDay::add(EffectPart part, PartColumns columns, double penalty, LinearModel& model) const {
  addDirections(columns, model);
  model.penalty += penalty;
  model.parts.push_back(std::move(part));
  model.columns.push_back(std::make_shared<const PartColumns>(std::move(columns)));
}

LinearModel LinearisedDay::keeping(const LinearModel& model,
                                   const std::function<bool(const EffectPart&)>& stays) const {
  LinearModel fewer = geometryAlone();
  for (std::size_t k = 0; k < model.parts.size(); ++k) {
    if (!stays(model.parts[k])) continue;
    addDirections(*model.columns[k], fewer);
    fewer.penalty += model.parts[k].penalty;
    fewer.parts.push_back(model.parts[k]);
    fewer.columns.push_back(model.columns[k]);
  }
  return fewer;
}

double LinearisedDay::designEffect(const Eigen::VectorXd& residual) const {
  double together = 0.0, apart = 0.0;
  for (std::size_t k = 0; k < postures_.size(); ++k) {
    const auto own = residual.segment(first_row_[k], equations_[k].residual.size());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index row = 0; row < own.size(); row += 3) sum += own.segment<3>(row);
    together += sum.squaredNorm();
    apart += own.squaredNorm();
  }
  return apart > 0.0 ? std::max(1.0, together / apart) : 1.0;
}

namespace {

/// Normal equations of some rows.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;

  void operator+=(const Normal& other) { matrix += other.matrix, right += other.right; }
};

Normal sumOf(const std::vector<Normal>& normals) {
  Normal all = normals.front();
  for (std::size_t k = 1; k < normals.size(); ++k) all += normals[k];
  return all;
}

/// What the others of each fold find.
std::vector<Eigen::VectorXd> solvedByOthers(const std::vector<Normal>& folds, const Normal& all) {
  constexpr double kDamping = 1e-9;  // of what the whole day sees: a fold that cannot see a direction leaves it
  std::vector<Eigen::VectorXd> sizes;
  for (const Normal& fold : folds) {
    Eigen::MatrixXd others = all.matrix - fold.matrix;
    others.diagonal() += kDamping * all.matrix.diagonal();
    sizes.push_back(solveSymmetric(others, Eigen::VectorXd(all.right - fold.right)));
  }
  return sizes;
}

}  // namespace

Eigen::MatrixXd LinearisedDay::allColumns(const LinearModel& model, Eigen::Index from, Eigen::Index rows) const {
  Eigen::MatrixXd columns(rows, basis_.cols() + model.directions.cols());
  columns.leftCols(basis_.cols()) = basis_.middleRows(from, rows);
  if (model.directions.cols() > 0)  // of a matrix without columns Eigen moves a null pointer
    columns.rightCols(model.directions.cols()) = model.directions.middleRows(from, rows);
  return columns;
}

void LinearisedDay::addStations(const LinearModel& model, Eigen::MatrixXd& matrix, Eigen::VectorXd& right) const {
  const Eigen::Index rows = residual_.size() - rows_of_postures_;
  if (rows == 0) return;
  const Eigen::MatrixXd columns = allColumns(model, rows_of_postures_, rows);
  matrix.noalias() += columns.transpose() * columns;
  right.noalias() += columns.transpose() * residual_.tail(rows);
}

std::vector<LinearisedDay::Run> LinearisedDay::runsOf(const std::vector<int>& fold) const {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < postures_.size();) {
    std::size_t end = k + 1;
    while (end < postures_.size() && fold[end] == fold[k]) ++end;
    const Eigen::Index from = first_row_[k];
    runs.push_back({k, end, from, first_row_[end - 1] + equations_[end - 1].residual.size() - from, fold[k]});
    k = end;
  }
  return runs;
}

template <class Use>
double LinearisedDay::holdOut(const LinearModel& model, int folds, const std::vector<int>& fold, const Use& use) const {
  const Eigen::Index width = basis_.cols() + model.directions.cols();
  std::vector<Normal> normals(static_cast<std::size_t>(folds),
                              {Eigen::MatrixXd::Zero(width, width), Eigen::VectorXd::Zero(width)});
  const std::vector<Run> runs = runsOf(fold);
  for (const Run& run : runs) {
    const Eigen::MatrixXd columns = allColumns(model, run.row, run.rows);
    Normal& normal = normals[static_cast<std::size_t>(run.fold)];
    normal.matrix.noalias() += columns.transpose() * columns;
    normal.right.noalias() += columns.transpose() * residual_.segment(run.row, run.rows);
  }
  Normal all = sumOf(normals);
  addStations(model, all.matrix, all.right);
  const std::vector<Eigen::VectorXd> sizes = solvedByOthers(normals, all);
  for (const Run& run : runs) {
    const Eigen::VectorXd left = residual_.segment(run.row, run.rows) -
                                 allColumns(model, run.row, run.rows) * sizes[static_cast<std::size_t>(run.fold)];
    for (std::size_t p = run.first; p < run.end; ++p)
      use(p, left.segment(first_row_[p] - run.row, equations_[p].residual.size()));
  }
  const Eigen::Index of_stations = residual_.size() - rows_of_postures_;
  if (of_stations == 0) return 0.0;
  const Eigen::MatrixXd columns = allColumns(model, rows_of_postures_, of_stations);
  double squares = 0.0;
  for (const Eigen::VectorXd& found : sizes) squares += (residual_.tail(of_stations) - columns * found).squaredNorm();
  return squares / static_cast<double>(sizes.size());
}

double LinearisedDay::heldOut(const LinearModel& model) const {
  double sum = 0.0;
  // A model that needs a station far from where the nests have it does not predict that.
  const double of_stations = holdOut(model, options_.inner_folds, inner_fold_,
                                     [&](std::size_t, const auto& residual) { sum += residual.squaredNorm(); });
  return sum + of_stations;
}

double LinearisedDay::plainSquares(std::size_t p, const Eigen::Ref<const Eigen::VectorXd>& residual) const {
  double square = 0.0;
  for (std::size_t r = 0; r < equations_[p].whitening.size(); ++r) {
    // The whitening is lower triangular.
    const Eigen::Vector3d plain = equations_[p].whitening[r].triangularView<Eigen::Lower>().solve(
        Eigen::Vector3d(residual.segment<3>(3 * static_cast<Eigen::Index>(r))));
    square += plain.squaredNorm();
  }
  return square;
}

std::vector<double> LinearisedDay::heldOutByPosture(const LinearModel& model) const {
  std::vector<double> squares;
  holdOut(model, options_.outer_folds, outer_fold_,
          [&](std::size_t p, const auto& residual) { squares.push_back(plainSquares(p, residual)); });
  return squares;
}

std::vector<double> LinearisedDay::heldOutByDivision(const LinearModel& model, int others) const {
  std::vector<Run> runs = runsOf(outer_fold_);
  std::vector<Normal> normals;
  for (const Run& run : runs) {
    const Eigen::MatrixXd columns = allColumns(model, run.row, run.rows);
    normals.push_back({columns.transpose() * columns, columns.transpose() * residual_.segment(run.row, run.rows)});
  }
  Normal all = sumOf(normals);
  addStations(model, all.matrix, all.right);
  const auto folds = static_cast<std::size_t>(options_.outer_folds);
  const Normal none{Eigen::MatrixXd::Zero(all.matrix.rows(), all.matrix.cols()),
                    Eigen::VectorXd::Zero(all.right.size())};
  std::vector<double> sums;
  constexpr std::uint64_t kSeed = 1;
  numerics::SubsetDraws draws(runs.size(), runs.size(), kSeed);
  for (int division = 0; division <= others; ++division) {
    if (division > 0) {
      const std::span<const std::uint32_t> order = draws.next();
      for (std::size_t k = 0; k < runs.size(); ++k) runs[order[k]].fold = static_cast<int>(k % folds);
    }
    std::vector<Normal> by_fold(folds, none);
    for (std::size_t k = 0; k < runs.size(); ++k) by_fold[static_cast<std::size_t>(runs[k].fold)] += normals[k];
    const std::vector<Eigen::VectorXd> sizes = solvedByOthers(by_fold, all);
    double sum = 0.0;
    for (const Run& run : runs) {
      const Eigen::VectorXd& found = sizes[static_cast<std::size_t>(run.fold)];
      Eigen::VectorXd left =
          residual_.segment(run.row, run.rows) - basis_.middleRows(run.row, run.rows) * found.head(basis_.cols());
      if (model.directions.cols() > 0)
        left -= model.directions.middleRows(run.row, run.rows) * found.tail(model.directions.cols());
      for (std::size_t p = run.first; p < run.end; ++p)
        sum += plainSquares(p, left.segment(first_row_[p] - run.row, equations_[p].residual.size()));
    }
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace stiffscope::calibration
