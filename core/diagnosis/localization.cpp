#include "core/diagnosis/localization.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "core/diagnosis/diagnosis_input.h"
#include "core/diagnosis/held_out.h"
#include "core/numerics/distributions.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::diagnosis {

namespace {

Eigen::VectorXd stiffnessesIn(const LinearSystem& data, const std::vector<double>& weights) {
  const Eigen::MatrixXd normal = sumOf(data, weights);
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(data.layout.end);
  const Eigen::Index joints = data.layout.joints();
  parameters.head(joints) =
      leastSquaresSolution(normal.topLeftCorner(joints, joints), normal.col(data.layout.end).head(joints));
  return parameters;
}

}  // namespace

std::optional<GapAsMeasured> gapAsMeasured(const preparation::PreparedCampaign& prepared, const SystemInput& input,
                                           const GapFit& fit, const Eigen::VectorXd& after,
                                           const std::vector<Eigen::VectorXd>& after_without) {
  const DiagnosisInput raw = diagnosisInput(preparation::asMeasured(prepared));
  if (!raw.reason.empty()) return std::nullopt;
  const SystemInput as_read{
      raw.campaign, raw.noise.noise, input.force_sigma, input.moment_sigma, input.models, false, false, {}};
  const LinearSystem data = linearSystem(as_read, raw.state, {});
  const std::size_t postures = data.postures.size();
  const Eigen::VectorXd parameters = stiffnessesIn(data, std::vector<double>(postures, 1.0));
  GapAsMeasured gap;
  std::map<int, HeldOut> left;
  double rows = 0.0, rests = 0.0, deflection = 0.0, position = 0.0;
  for (std::size_t p = 0; p < postures; ++p) {
    const GapPosture& posture = data.postures[p];
    const double squares = leftIn(posture, {parameters, parameters}, posture, parameters).deflection_before;
    const auto count = static_cast<double>(posture.right.size());
    const Eigen::VectorXd others = stiffnessesIn(data, numerics::leaveOneOut(postures, p));
    left[posture.pose].deflection_before = leftIn(posture, {others, others}, posture, others).deflection_before;
    deflection += squares;
    rows += count;
    gap.by_posture.rows.push_back(
        {prepared.campaign.pose_ids[static_cast<std::size_t>(posture.pose)], std::sqrt(squares / count)});
  }
  gap.at_points = gapAtPoints(data, parameters, *fit.data, after);
  for (const SystemRows& one : loadingRows(raw.campaign, raw.state.geometry, raw.state.at, {})) {
    left[one.pose].position_before = one.position.squaredNorm();
    position += left[one.pose].position_before;
    rests += static_cast<double>(one.position.size());
  }
  if (rows > 0.0) gap.deflection = std::sqrt(deflection / rows);
  if (rests > 0.0) gap.position = std::sqrt(position / rests);
  for (std::size_t p = 0; p < fit.data->postures.size(); ++p) {
    const GapPosture& posture = fit.data->postures[p];
    HeldOut one = left[posture.pose];
    const HeldOut now = leftIn(posture, {after_without[p], after_without[p]}, posture, after_without[p]);
    one.deflection_after = now.deflection_after;
    one.position_after = now.position_after;
    gap.left.push_back(one);
  }
  return gap;
}

namespace {

/// Squares, summed over the postures, and how many coordinates they are of.
struct GapSquares {
  Gap sum;
  double count = 0.0;

  Gap rms() const {
    if (count == 0.0) return {};
    const auto root = [&](double squares) { return std::sqrt(squares / count); };
    return {root(sum.before), root(sum.noise), root(sum.after), root(sum.deflection)};
  }
};

template <class Add>
Gap summed(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit, const Eigen::VectorXd& after,
           const Add& add) {
  GapSquares squares;
  for (std::size_t p = 0; p < fit.data->postures.size(); ++p) {
    const GapPosture& posture = fit.data->postures[p];
    add(leftIn(alone.data->postures[p], before, posture, after), posture, squares);
  }
  return squares.rms();
}

}  // namespace

Gap deflectionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit,
                  const Eigen::VectorXd& after) {
  return summed(alone, before, fit, after, [](const HeldOut& left, const GapPosture& posture, GapSquares& squares) {
    const Eigen::Index rows = posture.right.size() - posture.position_rows;
    squares.sum.before += left.deflection_before;
    squares.sum.after += left.deflection_after;
    squares.sum.noise += noiseSquares(posture);
    squares.sum.deflection += posture.right.tail(rows).squaredNorm();
    squares.count += static_cast<double>(rows);
  });
}

Gap positionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit, const Eigen::VectorXd& after) {
  return summed(alone, before, fit, after, [](const HeldOut& left, const GapPosture& posture, GapSquares& squares) {
    squares.sum.before += left.position_before;
    squares.sum.after += left.position_after;
    squares.sum.noise += posture.noiseSquares(0, posture.position_rows);
    squares.count += static_cast<double>(posture.position_rows);
  });
}

PositionsLeft positionsLeft(const GapFit& fit, const Gap& positions) {
  const auto apart = [](double larger, double smaller) {
    return std::sqrt(std::max(0.0, larger * larger - smaller * smaller));
  };
  constexpr double kStates = 2.0, kShareOfRemoved = 0.1;
  return {apart(positions.after, positions.noise),
          std::max(kStates * fit.data->state_noise, kShareOfRemoved * apart(positions.before, positions.after))};
}

namespace {

/// What is left of one reflector in one state, and the covariance of its reading noise.
struct LeftOver {
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();  ///< with the same reflector in another state of the posture
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  const effects::ArmState* state = nullptr;
  int target = 0;
  Eigen::Vector3d read_from = campaign::kStationOfTracker;  ///< where the instrument stood, R0
};

std::vector<LeftOver> leftOvers(const LinearSystem& data, const Eigen::VectorXd& parameters, bool deflection) {
  std::vector<LeftOver> all;
  for (const GapPosture& posture : data.postures) {
    const Eigen::VectorXd left = posture.right - posture.columns * parameters;
    const Eigen::Index per_state = posture.states.front().rows();
    const std::size_t first = deflection ? 1 : 0, last = deflection ? posture.states.size() : 1;
    if (!deflection && posture.position_rows == 0) continue;
    for (std::size_t s = first; s < last; ++s) {
      const Eigen::Index at = deflection ? posture.position_rows + static_cast<Eigen::Index>(s - 1) * per_state : 0;
      for (std::size_t t = 0; t < posture.states[s].points.size(); ++t) {
        const Eigen::Index row = at + 3 * static_cast<Eigen::Index>(t);
        const Eigen::Matrix3d across = deflection && posture.noise_across.size() > 0
                                           ? Eigen::Matrix3d(posture.noise_across.block<3, 3>(row - at, row - at))
                                           : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
        all.push_back({left.segment<3>(row), posture.noise.block<3, 3>(row, row - at), across,
                       posture.states[s].points[t], &posture.states[s], posture.states[s].targets[t],
                       posture.read_from.empty() ? campaign::kStationOfTracker : posture.read_from[t].from});
      }
    }
  }
  return all;
}

/// Squares along some directions, collected under a name. The states of a posture share their unloaded readings: the
/// variance of a sum of x^T F x over them is 2 tr(F_k S_kl F_l S_lk) over all pairs of states.
struct Sum {
  double squares = 0.0, noise = 0.0, variance = 0.0, count = 0.0;
  int pose = -1;                                                   ///< whose states were added last
  std::vector<std::pair<int, Eigen::Matrix3Xd>> directions_added;  ///< of its states before, with the reflector
  std::vector<Eigen::MatrixXd> forms_added;

  void add(const LeftOver& one, const Eigen::Matrix3Xd& directions) {
    const Eigen::MatrixXd noise_here = propagated(directions.transpose(), one.noise);
    squares += (directions.transpose() * one.left).squaredNorm();
    noise += noise_here.trace();
    variance += 2.0 * (noise_here * noise_here).trace();
    count += static_cast<double>(directions.cols());
    beginPosture(one.state->pose);
    for (const auto& [target, before] : directions_added) {
      if (target == one.target) variance += 4.0 * (directions.transpose() * one.across * before).squaredNorm();
    }
    directions_added.emplace_back(one.target, directions);
  }

  void beginPosture(int next) {
    if (next == pose) return;
    pose = next;
    directions_added.clear();
    forms_added.clear();
  }

  /// Of the part of a state's `left` that `form`, a symmetric matrix, takes of it: left^T form left. `across`: the
  /// covariance with other states of the posture; empty without.
  void addPart(int of_pose, const Eigen::VectorXd& left, const Eigen::MatrixXd& form, const Eigen::MatrixXd& covariance,
               const Eigen::MatrixXd& across) {
    const Eigen::MatrixXd noise_here = form * covariance;
    squares += left.dot(form * left);
    noise += noise_here.trace();
    variance += 2.0 * noise_here.cwiseProduct(noise_here.transpose()).sum();
    count += form.trace();
    beginPosture(of_pose);
    for (const Eigen::MatrixXd& before : forms_added)
      variance += 4.0 * (form * across).cwiseProduct((before * across.transpose()).transpose()).sum();
    forms_added.push_back(form);
  }

  /// The squares are a sum of weighed chi-square variables: nearly one of the same mean and variance (Satterthwaite).
  double deviate() const {
    if (!(variance > 0.0) || !(noise > 0.0)) return 0.0;
    return numerics::chiSquareDeviate(2.0 * squares * noise / variance, 2.0 * noise * noise / variance);
  }
};

WhereRow rowOf(const std::string& name, const Sum& sum, double whole) {
  WhereRow row;
  row.name = name;
  if (sum.count > 0.0) row.rms = std::sqrt(sum.squares / sum.count), row.noise = std::sqrt(sum.noise / sum.count);
  row.share = whole > 0.0 ? sum.squares / whole : 0.0;
  row.significance = sum.deviate();
  return row;
}

double wholeOf(const std::vector<LeftOver>& all) {
  double whole = 0.0;
  for (const LeftOver& one : all) whole += one.left.squaredNorm();
  return whole;
}

/// One row a name, in the order of `names`; `place(one)` is the index of the name, negative to leave out.
template <class Place>
WhereTable tableBy(const std::string& by, const std::vector<std::string>& names, const std::vector<LeftOver>& all,
                   const Place& place) {
  std::vector<Sum> sums(names.size());
  for (const LeftOver& one : all) {
    const int at = place(one);
    if (at >= 0) sums[static_cast<std::size_t>(at)].add(one, Eigen::Matrix3d::Identity());
  }
  WhereTable table{by, {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (sums[i].count > 0.0) table.rows.push_back(rowOf(names[i], sums[i], wholeOf(all)));
  }
  return table;
}

/// One row a direction; `axes(one)` has them as columns of the frame at hand.
template <class Axes>
WhereTable tableAlong(const std::string& by, const std::vector<std::string>& names, const std::vector<LeftOver>& all,
                      const Axes& axes) {
  std::vector<Sum> sums(names.size());
  for (const LeftOver& one : all) {
    const Eigen::Matrix3d frame = axes(one);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const bool last = k + 1 == names.size();
      const Eigen::Index from = static_cast<Eigen::Index>(k), count = last ? 3 - from : 1;
      sums[k].add(one, frame.middleCols(from, count));
    }
  }
  WhereTable table{by, {}};
  for (std::size_t k = 0; k < names.size(); ++k) table.rows.push_back(rowOf(names[k], sums[k], wholeOf(all)));
  return table;
}

Eigen::Matrix3d beamAxes(const GapFit& fit, const SystemInput& input, const LeftOver& one) {
  const Eigen::Isometry3d from_points = fit.state.geometry.r0_from_loading.value_or(fit.state.at.r0_from_base_link);
  const Eigen::Vector3d station = one.read_from.allFinite() ? one.read_from : from_points * input.noise.station;
  const Eigen::Vector3d along = (one.point - station).normalized();
  Eigen::Matrix3d axes;
  axes.col(0) = along;
  axes.col(1) = along.unitOrthogonal();
  axes.col(2) = along.cross(axes.col(1));
  return axes;
}

std::vector<WhereTable> commonTables(const SystemInput& input, const GapFit& fit, const std::vector<LeftOver>& all) {
  std::vector<WhereTable> tables;
  std::vector<std::string> reflectors;
  for (const campaign::Target& target : input.campaign.targets) reflectors.push_back(target.id);
  tables.push_back(tableBy("reflector", reflectors, all, [](const LeftOver& one) { return one.target; }));
  tables.push_back(tableAlong("base axes", {"x0", "y0", "z0"}, all,
                              [](const LeftOver&) { return Eigen::Matrix3d(Eigen::Matrix3d::Identity()); }));
  tables.push_back(tableAlong("flange axes", {"x", "y", "z"}, all,
                              [](const LeftOver& one) { return Eigen::Matrix3d(one.state->flange.linear()); }));
  tables.push_back(tableAlong("tracker's beam", {"along", "across"}, all,
                              [&](const LeftOver& one) { return beamAxes(fit, input, one); }));
  tables.push_back(
      tableBy("posture", input.campaign.pose_ids, all, [](const LeftOver& one) { return one.state->pose; }));
  return tables;
}

/// For every subset of the columns an orthonormal basis of what they span: that of the subset without its last column,
/// and one vector more, zero where the column brings nothing new.
std::vector<Eigen::VectorXd> addedDirections(const Eigen::MatrixXd& columns) {
  std::vector<Eigen::VectorXd> added(std::size_t{1} << columns.cols());
  for (std::size_t subset = 1; subset < added.size(); ++subset) {
    const auto last = static_cast<Eigen::Index>(std::bit_width(subset)) - 1;
    const double whole = columns.col(last).norm();
    Eigen::VectorXd rest = columns.col(last);
    for (int again = 0; again < 2; ++again) {  // twice, for rounding
      for (std::size_t inner = std::bit_floor(subset) ^ subset; inner != 0; inner ^= std::bit_floor(inner))
        rest -= added[inner].dot(rest) * added[inner];
    }
    constexpr double kNothingNew = 1e-6;
    const bool new_one = rest.norm() > kNothingNew * whole;
    added[subset] = new_one ? Eigen::VectorXd(rest.normalized()) : Eigen::VectorXd(Eigen::VectorXd::Zero(rest.size()));
  }
  return added;
}

/// Share of all orders of n joints in which just the joints of a subset of this size stand before a given one:
/// before! (n - 1 - before)! / n!, the inverse of n times a binomial coefficient.
double shareOfOrders(int before, int joints) {
  double coefficient = 1.0;
  for (int k = 1; k <= before; ++k) coefficient = coefficient * (joints - k) / k;
  return 1.0 / (joints * coefficient);
}

/// By joint the form Q_j with y^T Q_j y = what joint j adds to the squares of y that the joints before it explain, mean
/// over all orders of the joints.
std::vector<Eigen::MatrixXd> partsByJoint(const Eigen::MatrixXd& columns) {
  const std::vector<Eigen::VectorXd> added = addedDirections(columns);
  const auto joints = static_cast<std::size_t>(columns.cols());
  std::vector<Eigen::MatrixXd> parts(joints, Eigen::MatrixXd::Zero(columns.rows(), columns.rows()));
  // Q_j is a sum of projections P_S with shares; each direction is in the P_S of all subsets that begin like its own.
  for (std::size_t subset = 1; subset < added.size(); ++subset) {
    Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(columns.rows(), columns.rows());
    for (std::size_t inner = subset; inner != 0; inner ^= std::bit_floor(inner))
      projection += added[inner] * added[inner].transpose();
    const int size = std::popcount(subset);
    for (std::size_t joint = 0; joint < joints; ++joint) {
      const bool with_it = ((subset >> joint) & 1U) != 0;
      parts[joint] += (with_it ? shareOfOrders(size - 1, static_cast<int>(joints))
                               : -shareOfOrders(size, static_cast<int>(joints))) *
                      projection;
    }
  }
  return parts;
}

/// What angles of the joints in each state would explain of that state. What two joints could both explain is shared
/// out, so that the parts add up to what all explain together (Shapley; Lindeman, Merenda and Gold).
WhereTable byJoint(const GapFit& fit, const Eigen::VectorXd& parameters, const std::vector<LeftOver>& all) {
  const auto joints = static_cast<std::size_t>(fit.data->layout.joints());
  std::vector<Sum> sums(joints);
  for (const GapPosture& posture : fit.data->postures) {
    const Eigen::VectorXd left = posture.right - posture.columns * parameters;
    const Eigen::Index per_state = posture.states.front().rows();
    for (std::size_t s = 1; s < posture.states.size(); ++s) {
      const Eigen::Index at = posture.position_rows + static_cast<Eigen::Index>(s - 1) * per_state;
      const auto parts =
          partsByJoint(effects::byEachJoint(posture.states[s], JointVector::Ones(fit.data->layout.joints())));
      for (std::size_t joint = 0; joint < joints; ++joint)
        sums[joint].addPart(posture.pose, left.segment(at, per_state), parts[joint],
                            posture.noise.middleRows(at, per_state), posture.noise_across);
    }
  }
  WhereTable table{"joint", {}};
  table.overlaps = true;
  for (std::size_t joint = 0; joint < joints; ++joint) {
    table.rows.push_back(rowOf(fmt::format("joint {}", joint + 1), sums[joint], wholeOf(all)));
    table.explained += table.rows.back().share;
  }
  return table;
}

}  // namespace

std::vector<WhereTable> whereDeflection(const SystemInput& input, const GapFit& fit,
                                        const Eigen::VectorXd& parameters) {
  const std::vector<LeftOver> all = leftOvers(*fit.data, parameters, true);
  std::vector<WhereTable> tables = commonTables(input, fit, all);
  tables.insert(tables.begin(), byJoint(fit, parameters, all));
  int last_step = 0;
  for (const LeftOver& one : all) last_step = std::max(last_step, one.state->step);
  std::vector<std::string> steps;
  for (int step = 0; step <= last_step; ++step) {
    bool unloads = false;
    for (const LeftOver& one : all) unloads |= one.state->step == step && !one.state->loaded;
    steps.push_back(fmt::format("step {}{}", step, unloads ? " (return to zero)" : ""));
  }
  tables.push_back(tableBy("load step", steps, all, [](const LeftOver& one) { return one.state->step; }));
  const effects::LinearizationPoint& at = fit.state.at;
  tables.push_back(tableBy("time", {"first quarter", "second quarter", "third quarter", "last quarter"}, all,
                           [&](const LeftOver& one) {
                             if (!std::isfinite(one.state->time_s)) return -1;
                             const double share = (one.state->time_s - at.first_time) / at.time_span;
                             return std::clamp(static_cast<int>(4.0 * share), 0, 3);
                           }));
  return tables;
}

std::vector<WhereTable> wherePosition(const SystemInput& input, const GapFit& fit, const Eigen::VectorXd& parameters) {
  const std::vector<LeftOver> all = leftOvers(*fit.data, parameters, false);
  if (all.empty()) return {};
  return commonTables(input, fit, all);
}

std::vector<PointGap> gapAtPoints(const LinearSystem& data_before, const Eigen::VectorXd& before,
                                  const LinearSystem& data_after, const Eigen::VectorXd& after) {
  using State = std::pair<int, int>;  // pose, step
  std::map<State, std::vector<LeftOver>> left_after;
  for (const LeftOver& one : leftOvers(data_after, after, true))
    left_after[{one.state->pose, one.state->step}].push_back(one);
  std::map<int, std::map<int, std::vector<LeftOver>>> left_before;  // by pose and step
  for (const LeftOver& one : leftOvers(data_before, before, true))
    left_before[one.state->pose][one.state->step].push_back(one);
  std::vector<PointGap> gaps;
  for (const auto& [pose, steps] : left_before) {
    const auto most = std::max_element(
        steps.begin(), steps.end(), [](const auto& a, const auto& b) { return wholeOf(a.second) < wholeOf(b.second); });
    const auto same = left_after.find({pose, most->first});
    if (same == left_after.end()) continue;
    for (const LeftOver& one : most->second) {
      const auto other = std::find_if(same->second.begin(), same->second.end(),
                                      [&one](const LeftOver& two) { return two.target == one.target; });
      if (other != same->second.end()) gaps.push_back({pose, one.target, one.point, one.left, other->left});
    }
  }
  return gaps;
}

}  // namespace stiffscope::diagnosis
