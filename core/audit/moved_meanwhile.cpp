#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/audit/limits.h"
#include "core/audit/position_fit.h"
#include "core/frames/arm_parameters.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::audit {

namespace {

/// Postures in the order in which they were read: by the times of their states where all have one, else by the rows.
struct Course {
  std::vector<int> poses;
  std::vector<double> gone;  ///< of the time from the first posture to the last, or of the postures
};

Course courseOf(const campaign::Campaign& campaign, const frames::AbsoluteRows& rows) {
  std::map<int, double> times;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0 && std::isfinite(state.time_s)) times.emplace(state.pose, state.time_s);
  }
  Course course{rows.poses, {}};
  const bool timed =
      std::all_of(course.poses.begin(), course.poses.end(), [&](int pose) { return times.contains(pose); });
  if (timed) {
    std::stable_sort(course.poses.begin(), course.poses.end(), [&](int a, int b) { return times.at(a) < times.at(b); });
  }
  const double first = timed ? times.at(course.poses.front()) : 0.0;
  const double whole = timed ? times.at(course.poses.back()) - first : static_cast<double>(course.poses.size() - 1);
  for (std::size_t at = 0; at < course.poses.size(); ++at) {
    const double here = timed ? times.at(course.poses[at]) - first : static_cast<double>(at);
    course.gone.push_back(whole > 0.0 ? here / whole : 0.0);
  }
  return course;
}

/// One rigid body that may have moved between two postures, and how each position follows its motion.
class MovableBody {
 public:
  MovableBody(MovedMeanwhile::Body body, const frames::AbsoluteRows& rows, const frames::LoadingGeometry& geometry)
      : body_(body), places_(rows.axes), geometry_(geometry) {
    int seen = 0;
    for (const auto& target : geometry.targets_at_zero) {
      if (target) middle_ += *target, ++seen;
    }
    if (seen > 0) middle_ /= seen;
  }

  MovedMeanwhile::Body body() const { return body_; }

  /// 3 x 6: by a rotation vector and a displacement.
  Eigen::Matrix<double, 3, 6> columns(const frames::AbsoluteRow& row) const {
    if (body_ == MovedMeanwhile::Body::station) return -row.jacobian.middleCols<6>(places_.baseAt());
    const auto target = static_cast<std::size_t>(row.target);
    return -row.jacobian.middleCols<3>(places_.targetAt(target)) *
           metrology::pointByFrameError(*geometry_.targets_at_zero[target] - middle_);
  }

 private:
  MovedMeanwhile::Body body_;
  frames::ArmParameters places_;
  const frames::LoadingGeometry& geometry_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
};

/// Where in the course a body moved, or whether it went steadily, how, and by how much that lowers chi2.
struct Move {
  const MovableBody* body = nullptr;
  bool steady = false;
  std::size_t from = 0;
  Vector6d motion = Vector6d::Zero();
  double fall = 0.0;
};

/// Sums over the later postures from which a motion follows that all of them share, beside the common fit.
struct Later {
  Eigen::MatrixXd cross;              ///< J^T W E
  Matrix6d own = Matrix6d::Zero();    ///< E^T W E
  Vector6d right = Vector6d::Zero();  ///< E^T W r

  explicit Later(Eigen::Index parameters) : cross(Eigen::MatrixXd::Zero(parameters, 6)) {}

  void add(const frames::AbsoluteRow& row, const Eigen::Matrix<double, 3, 6>& columns, double weight) {
    const Eigen::Matrix<double, 3, 6> weighted = weight * row.weight * columns;
    cross.noalias() += row.jacobian.transpose() * weighted;
    own.noalias() += columns.transpose() * weighted;
    right.noalias() += weighted.transpose() * row.residual;
  }

  /// The motion with everything else of the fit free (Schur complement), and the fall of chi2. `inverse` and
  /// `parameters`: of the fit without it.
  Move solve(const Eigen::MatrixXd& inverse, const Eigen::VectorXd& parameters) const {
    const Eigen::MatrixXd normal = own - cross.transpose() * (inverse * cross);
    const Eigen::VectorXd left = right - cross.transpose() * parameters;
    Move move;
    move.motion = leastSquaresSolution(normal, left);
    move.fall = move.motion.dot(left);
    return move;
  }
};

/// Three postures each side, so that one or two whose angles are stale make no step.
constexpr std::size_t kLeastOnOneSide = 3;

/// The one motion, of any of the bodies, that lowers chi2 most: between two postures, or steady.
Move likeliestMove(const frames::AbsoluteRows& rows, const Course& course, const PostureWeights& weights,
                   const std::vector<MovableBody>& bodies) {
  const PositionNormal normal = sumUp(rows, weights);
  const Eigen::MatrixXd inverse =
      solveSymmetric(normal.matrix, Eigen::MatrixXd::Identity(normal.matrix.rows(), normal.matrix.cols()));
  const Eigen::VectorXd parameters = inverse * normal.right;
  std::vector<std::vector<const frames::AbsoluteRow*>> by_pose(weights.size());
  for (const frames::AbsoluteRow& row : rows.rows) by_pose[static_cast<std::size_t>(row.pose)].push_back(&row);
  const std::size_t postures = course.poses.size(), last = postures - kLeastOnOneSide;
  Move best;
  const auto consider = [&](const Later& later, const MovableBody& body, bool steady, std::size_t from) {
    Move move = later.solve(inverse, parameters);
    if (move.fall <= best.fall) return;
    best = move;
    best.body = &body;
    best.steady = steady;
    best.from = from;
  };
  for (const MovableBody& body : bodies) {
    const bool may_drift = body.body() == MovedMeanwhile::Body::station;
    Later later(rows.parameters), steady(rows.parameters);
    for (std::size_t at = postures; at-- > 0;) {
      const auto pose = static_cast<std::size_t>(course.poses[at]);
      for (const frames::AbsoluteRow* row : by_pose[pose]) {
        if (weights[pose] == 0.0) continue;
        const Eigen::Matrix<double, 3, 6> columns = body.columns(*row);
        later.add(*row, columns, weights[pose]);
        if (may_drift) steady.add(*row, course.gone[at] * columns, weights[pose]);
      }
      if (at >= kLeastOnOneSide && at <= last) consider(later, body, false, at);
    }
    if (may_drift) consider(steady, body, true, 0);
  }
  return best;
}

/// Takes a motion off the postures, or puts it back (`times` -1).
void takeOff(const Move& move, const Course& course, double times, frames::AbsoluteRows& rows) {
  std::vector<double> share(static_cast<std::size_t>(*std::max_element(rows.poses.begin(), rows.poses.end())) + 1, 0.0);
  for (std::size_t at = move.from; at < course.poses.size(); ++at)
    share[static_cast<std::size_t>(course.poses[at])] = times * (move.steady ? course.gone[at] : 1.0);
  for (frames::AbsoluteRow& row : rows.rows) {
    const double here = share[static_cast<std::size_t>(row.pose)];
    if (here != 0.0) row.residual -= here * (move.body->columns(row) * move.motion);
  }
}

/// What is left of the positions where postures with weight 0 have stale angles.
struct Left {
  double chi2 = 0.0, dof = 0.0;
  std::size_t stale = 0;

  Left(const frames::AbsoluteRows& rows, const PostureWeights& weights) {
    const PositionNormal normal = sumUp(rows, weights);
    chi2 = leastSquares(normal);
    dof = std::max(1.0, static_cast<double>(normal.rows - 6 - 3 * rows.targets));
    for (const int pose : rows.poses) stale += weights[static_cast<std::size_t>(pose)] == 0.0 ? 1 : 0;
  }

  /// BIC with `numbers` more, by `misfit` as the variance of a reading.
  double criterion(double misfit, double numbers, double rows) const {
    constexpr double kOfPosture = 6.0;
    return chi2 / misfit + (kOfPosture * static_cast<double>(stale) + numbers) * std::log(rows);
  }
};

/// A motion with the postures that have stale angles beside it.
struct Explanation {
  Move move;
  PostureWeights weights;
  Left left;
};

using WeightsOf = std::function<PostureWeights(const frames::AbsoluteRows&)>;

/// The likeliest motion as seen with `start`, settled with the postures that stand apart once it is off.
std::optional<Explanation> explanationFrom(const PostureWeights& start, const Course& course,
                                           const std::vector<MovableBody>& bodies, const WeightsOf& weights_of,
                                           frames::AbsoluteRows& rows) {
  Move move = likeliestMove(rows, course, start, bodies);
  if (move.body == nullptr) return std::nullopt;
  takeOff(move, course, 1.0, rows);
  const PostureWeights weights = weights_of(rows);
  takeOff(move, course, -1.0, rows);
  move = likeliestMove(rows, course, weights, bodies);
  if (move.body == nullptr) return std::nullopt;
  takeOff(move, course, 1.0, rows);
  Explanation found{move, weights, Left(rows, weights)};
  takeOff(move, course, -1.0, rows);
  return found;
}

/// What was found, and how it goes among the postures in which it was looked for.
struct Found {
  Explanation explanation;
  double by_chance = 0.0;  ///< of its displacement, m
  double explained = 0.0;
};

std::optional<Found> findMove(const Course& course, const std::vector<MovableBody>& bodies, const WeightsOf& weights_of,
                              frames::AbsoluteRows& rows) {
  // Far below a check's level: what is looked for stands a hundred times above chance.
  const double level = 1e-2 * preparation::kLevel / static_cast<double>(bodies.size() * course.poses.size());
  const double limit = numerics::chiSquareLimit(level, 6.0);
  if (likeliestMove(rows, course, equalWeights(rows), bodies).fall <= limit) return std::nullopt;
  const Left without(rows, weights_of(rows));
  double misfit = without.chi2 / without.dof;
  // A knock beside a posture with wildly stale angles shows only with that weighted down, one that most postures come
  // after only without.
  std::vector<Explanation> found;
  for (const PostureWeights& start : {equalWeights(rows), robustFit(rows).weights}) {
    std::optional<Explanation> one = explanationFrom(start, course, bodies, weights_of, rows);
    if (!one) continue;
    misfit = std::min(misfit, one->left.chi2 / one->left.dof);
    found.push_back(std::move(*one));
  }
  if (found.empty()) return std::nullopt;
  misfit = std::max(1.0, misfit);
  constexpr double kNumbers = 7.0;  // the motion's six, and where
  const double count = 3.0 * static_cast<double>(rows.rows.size());
  const auto worth = [&](const Explanation& one) { return one.left.criterion(misfit, kNumbers, count); };
  Explanation& best = *std::min_element(
      found.begin(), found.end(), [&](const Explanation& a, const Explanation& b) { return worth(a) < worth(b); });
  if (worth(best) >= without.criterion(misfit, 0.0, count)) return std::nullopt;
  const double before = Left(rows, best.weights).chi2, fall = before - best.left.chi2;
  const double own_misfit = std::max(1.0, best.left.chi2 / best.left.dof);
  if (fall <= own_misfit * limit || fall < kExplains * before) return std::nullopt;
  const double chance = best.move.motion.tail<3>().norm() * std::sqrt(own_misfit * limit / fall);
  return Found{std::move(best), chance, fall / before};
}

/// Postures of a long day in which a motion is looked for.
constexpr std::size_t kMostPostures = 300;

/// Every n-th posture of a longer course, and their rows.
Course thinned(const Course& course) {
  const std::size_t stride = 1 + (course.poses.size() - 1) / kMostPostures;
  Course few;
  for (std::size_t at = 0; at < course.poses.size(); at += stride) {
    few.poses.push_back(course.poses[at]);
    few.gone.push_back(course.gone[at]);
  }
  return few;
}

frames::AbsoluteRows rowsOf(const Course& course, const frames::AbsoluteRows& all) {
  std::vector<bool> kept(equalWeights(all).size(), false);
  for (const int pose : course.poses) kept[static_cast<std::size_t>(pose)] = true;
  frames::AbsoluteRows own;
  own.centre = all.centre;
  own.targets = all.targets, own.axes = all.axes, own.joints = all.joints, own.parameters = all.parameters;
  own.prior = all.prior;
  for (const frames::AbsoluteRow& row : all.rows) {
    if (kept[static_cast<std::size_t>(row.pose)]) own.rows.push_back(row);
  }
  for (const int pose : all.poses) {
    if (kept[static_cast<std::size_t>(pose)]) own.poses.push_back(pose);
  }
  return own;
}

/// The first posture that the motion moved among all, from the two of a thinned course between which it came: where the
/// readings before are best left as they are and those after with the motion off, by the common fit.
std::size_t placeAmongAll(const Move& move, const Course& few, const Course& all, const Eigen::VectorXd& parameters,
                          const frames::AbsoluteRows& rows) {
  const auto at = [&](int pose) {
    return static_cast<std::size_t>(std::find(all.poses.begin(), all.poses.end(), pose) - all.poses.begin());
  };
  const std::size_t first = at(few.poses[move.from - 1]) + 1, last = at(few.poses[move.from]);
  std::map<int, double> better;  // with the motion off
  for (std::size_t i = first; i < last; ++i) better[all.poses[i]] = 0.0;
  for (const frames::AbsoluteRow& row : rows.rows) {
    const auto own = better.find(row.pose);
    if (own == better.end()) continue;
    const Eigen::Vector3d as_read = row.residual - row.jacobian * parameters;
    const Eigen::Vector3d off = as_read - move.body->columns(row) * move.motion;
    own->second += as_read.dot(row.weight * as_read) - off.dot(row.weight * off);
  }
  std::size_t best = last;
  double sum = 0.0, most = 0.0;
  for (std::size_t i = last; i-- > first;) {
    sum += better.at(all.poses[i]);
    if (sum > most) most = sum, best = i;
  }
  return best;
}

}  // namespace

std::vector<MovedMeanwhile> takeOffMoves(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                         const std::vector<campaign::StatePoints>& states,
                                         const std::function<PostureWeights(const frames::AbsoluteRows&)>& weights_of,
                                         frames::AbsoluteRows& rows) {
  std::vector<MovedMeanwhile> moves;
  if (rows.poses.size() < 2 * kLeastOnOneSide) return moves;
  const Course all = courseOf(campaign, rows), few = thinned(all);
  frames::AbsoluteRows seen = rowsOf(few, rows);
  const std::vector<MovableBody> bodies{{MovedMeanwhile::Body::station, rows, geometry},
                                        {MovedMeanwhile::Body::tool, rows, geometry}};
  constexpr std::size_t kMost = 3;
  while (moves.size() < kMost) {
    const std::optional<Found> found = findMove(few, bodies, weights_of, seen);
    if (!found) break;
    Move move = found->explanation.move;
    takeOff(move, few, 1.0, seen);
    if (!move.steady) {
      const PositionNormal normal = sumUp(seen, found->explanation.weights);
      move.from = placeAmongAll(move, few, all, solveSymmetric(normal.matrix, normal.right), rows);
    }
    takeOff(move, all, 1.0, rows);
    MovedMeanwhile one;
    one.body = move.body->body();
    one.steady = move.steady;
    one.pose = move.steady ? all.poses.back() : all.poses[move.from];
    one.motion = move.motion;
    one.by_chance = found->by_chance;
    one.explained = found->explained;
    for (const campaign::StatePoints& state : states) {
      if (state.pose != one.pose || state.step != 0) continue;
      for (const campaign::ReflectorMean& mean : state.reflectors)
        one.line = one.line == 0 ? mean.line : std::min(one.line, mean.line);
    }
    moves.push_back(one);
  }
  return moves;
}

}  // namespace stiffscope::audit
