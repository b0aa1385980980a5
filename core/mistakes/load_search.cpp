#include "core/mistakes/load_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/campaign/row_names.h"
#include "core/io/units.h"
#include "core/mistakes/arm_mistakes.h"
#include "core/mistakes/remarks.h"
#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"
#include "core/robot/kinematics.h"

namespace stiffscope::mistakes {

namespace {

constexpr double kHangs = 0.06;       // rad, rms: a load that hangs, with a cell that is turned by 3 deg in its mount
constexpr double kDoesNot = 0.25;     // rad: 15 deg, more than a cell is ever turned by in its mount
constexpr double kLeavesMuch = 0.04;  // share that springs leave: more than noise and geometry alone
constexpr double kOnePoint = 0.03, kNoPoint = 0.1;  // share of the moments that one point of the tool leaves
constexpr double kWorse = 1.1;                      // as chance makes of two that are alike
constexpr double kLoadsAsWell = 1.15;

struct LoadTrial {
  LoadMistake mistake;
  SpringFit fit;
};

class LoadSearcher {
 public:
  LoadSearcher(const campaign::Campaign& campaign, const ReadingsOfDay& day, const NominalFit& arm)
      : campaign_(campaign), day_(day), arm_(arm), loads_(day, arm), declared_(asDeclared(*campaign.load_cell)) {}

  LoadSearch run() {
    if (!loads_.enough()) return std::move(found_);
    if (!forcesStandOut(campaign_)) {
      if (addTare()) found_.done = true;
      return std::move(found_);
    }
    found_.done = true;
    found_.fit = loads_.fit(declared_);
    found_.contradicts = found_.fit.left > kContradicts;
    const std::vector<LoadMistake> table = loadMistakes(campaign_);
    std::vector<LoadTrial> trials = tried(table);
    addGravityTurn(trials);
    keepMending(trials);
    if (trials.empty()) {
      if (addTare()) return std::move(found_);
      if (searchRepeatedWrenches() || searchRepeatedSteps()) return std::move(found_);
      trials = triedPoint();
      keepMending(trials);
    }
    if (!trials.empty()) point_leaves_ = trials.front().fit.left;
    if (trials.empty() || trials.front().mistake.id == "cell_point") {
      searchPostures(table);
      if (found_.cures.empty()) searchSteps();
      if (found_.cures.empty()) searchExchangedSteps({});
      if (!found_.cures.empty()) return std::move(found_);
    }
    if (trials.empty() && isSuspicious()) {
      trials = tried(pairsOf(table));
      keepMending(trials);
    }
    if (trials.empty() && isSuspicious()) {
      trials = triedTurn();
      keepMending(trials);
    }
    if (trials.empty()) {
      if (std::optional<Suspected> reversed = gravityReversed(day_, found_.fit)) {
        found_.cures.push_back(std::move(*reversed));
        return std::move(found_);
      }
    }
    if (trials.empty()) {
      found_.cures = unitsByScatter(campaign_, day_, loads_, found_.fit, table);
      return std::move(found_);
    }
    // Of all states, and not of some: believed where it does as well.
    if (std::any_of(trials.begin(), trials.end(), shiftsSteps) &&
        searchExchangedSteps({}, kLoadsAsWell * trials.front().fit.left + 0.005))
      return std::move(found_);
    report(trials);
    return std::move(found_);
  }

 private:
  std::vector<LoadTrial> tried(const std::vector<LoadMistake>& table) const {
    std::vector<LoadTrial> trials(table.size());
    numerics::onAllCores(table.size(), [&](std::size_t i) { trials[i] = {table[i], loads_.fit(table[i].meant)}; });
    return trials;
  }

  bool addTare() {
    std::optional<Suspected> weight = weightNotTared(campaign_, day_);
    if (weight) found_.cures.push_back(std::move(*weight));
    return weight.has_value();
  }

  bool isSuspicious() const { return found_.fit.left > 0.3 || found_.fit.along_lever > kNoPoint; }

  /// The turn that makes forces pull down, where none of the right angles does.
  void addGravityTurn(std::vector<LoadTrial>& trials) const {
    const std::optional<Eigen::Matrix3d> turn = loads_.turnToGravity(declared_);
    if (!turn || found_.fit.off_gravity < kDoesNot) return;
    constexpr double kAlike = 3.0 * io::kDegree;
    for (const LoadTrial& trial : trials) {
      const Eigen::Matrix3d apart = trial.mistake.meant.on_force.transpose() * *turn;
      if (trial.mistake.id == "cell_axes" && trial.mistake.meant.on_force.determinant() > 0.0 &&
          Eigen::AngleAxisd(apart).angle() < kAlike)
        return;
    }
    LoadMistake mistake = turnedCell(campaign_, *turn);
    mistake.things = 2;
    trials.push_back({mistake, loads_.fit(mistake.meant)});
  }

  std::vector<LoadTrial> triedPoint() const {
    constexpr double kLeastMove = 0.25;  // m: nearer, it may be a mount that was measured badly (load_point_error)
    constexpr double kLeast = 0.15;
    if (found_.fit.left < kLeast) return {};
    const Eigen::Vector3d at = loads_.bestPoint(declared_);
    if ((at - declared_.parent_from_cell.translation()).norm() < kLeastMove) return {};
    return tried({movedCell(campaign_, at)});
  }

  /// A turn that is none of the right angles, of a load that does not hang: from the declared one, and from those right
  /// angles that come nearest.
  std::vector<LoadTrial> triedTurn() const {
    if (declared_.axes_link) return {};
    constexpr double kLeastTurn = 10.0 * io::kDegree;  // nearer, the cell may be turned in its mount
    std::vector<LoadTrial> starts;
    for (const SignedPermutation& one : signedPermutations()) {
      if (!one.proper()) continue;
      CellReading meant = declared_;
      meant.on_force = meant.on_moment = one.map;
      starts.push_back({turnedCell(campaign_, one.map), loads_.fit(meant)});
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const LoadTrial& a, const LoadTrial& b) { return a.fit.left < b.fit.left; });
    constexpr std::size_t kNearest = 4;
    std::vector<LoadMistake> turns;
    for (std::size_t i = 0; i < std::min(kNearest, starts.size()); ++i) {
      const Eigen::Matrix3d turn = loads_.bestTurn(starts[i].mistake.meant);
      if (Eigen::AngleAxisd(turn).angle() < kLeastTurn) continue;
      turns.push_back(turnedCell(campaign_, turn));
    }
    std::vector<LoadTrial> trials = tried(turns);
    // They meet in one turn: the best of them.
    std::stable_sort(trials.begin(), trials.end(),
                     [](const LoadTrial& a, const LoadTrial& b) { return a.fit.left < b.fit.left; });
    if (trials.size() > 1) trials.resize(1);
    return trials;
  }

  /// Signs or turns with a unit, an order or another turn.
  static std::vector<LoadMistake> pairsOf(const std::vector<LoadMistake>& table) {
    std::vector<LoadMistake> pairs;
    for (const LoadMistake& first : table) {
      if (first.id != "wrench_sign" || first.things > 2) continue;
      for (const LoadMistake& second : table) {
        if (second.id == "wrench_sign" || second.things > 2) continue;
        LoadMistake both = second;
        both.things += first.things;
        both.meant.on_force = second.meant.on_force * first.meant.on_force;
        both.meant.on_moment = second.meant.on_moment * first.meant.on_moment;
        both.remedy = Remark(RemarkId::both, std::vector<Remark>{second.remedy, first.remedy, first.where});
        pairs.push_back(std::move(both));
      }
    }
    return pairs;
  }

  bool getsWorse(const SpringFit& fit) const {
    const SpringFit& as_read = found_.fit;
    return fit.left > kWorse * as_read.left + 0.01 || fit.along_lever > std::max(kNoPoint, 1.5 * as_read.along_lever) ||
           (as_read.off_gravity < kHangs && fit.off_gravity > kHangs);
  }

  bool mends(const LoadTrial& trial) const {
    const SpringFit &as_read = found_.fit, &fit = trial.fit;
    if (getsWorse(fit)) return false;
    return (as_read.off_gravity > kDoesNot && fit.off_gravity < kHangs) ||
           (as_read.left > (trial.mistake.mends > 0.9 ? 0.0 : kLeavesMuch) &&
            fit.left < trial.mistake.mends * as_read.left) ||
           (as_read.along_lever > kNoPoint && fit.along_lever < kOnePoint);
  }

  void keepMending(std::vector<LoadTrial>& trials) const {
    std::erase_if(trials, [&](const LoadTrial& trial) { return !mends(trial); });
    if (trials.empty()) return;
    // A load that hangs in all states does not by chance.
    const auto hangs = [](const LoadTrial& trial) { return trial.fit.off_gravity < kHangs; };
    if (std::any_of(trials.begin(), trials.end(), hangs))
      std::erase_if(trials, [&](const LoadTrial& trial) { return !hangs(trial); });
    const auto onePoint = [](const LoadTrial& trial) { return trial.fit.along_lever < kOnePoint; };
    if (std::any_of(trials.begin(), trials.end(), onePoint))
      std::erase_if(trials, [&](const LoadTrial& trial) { return !onePoint(trial); });
    double best = INFINITY;
    for (const LoadTrial& trial : trials) best = std::min(best, trial.fit.left);
    std::erase_if(trials, [&](const LoadTrial& trial) { return trial.fit.left > kLoadsAsWell * best + 0.005; });
    std::stable_sort(trials.begin(), trials.end(), [](const LoadTrial& a, const LoadTrial& b) {
      return std::pair(a.mistake.things, a.fit.left) < std::pair(b.mistake.things, b.fit.left);
    });
    std::erase_if(trials, [&](const LoadTrial& trial) { return trial.mistake.things > trials.front().mistake.things; });
  }

  void report(const std::vector<LoadTrial>& trials) {
    for (const LoadTrial& trial : trials) {
      const bool by_gravity = found_.fit.off_gravity > kDoesNot && trial.fit.off_gravity < kHangs;
      const double before = by_gravity ? found_.fit.off_gravity : found_.fit.left,
                   after = by_gravity ? trial.fit.off_gravity : trial.fit.left;
      found_.cures.push_back({trial.mistake.id, trial.mistake.where, trial.mistake.remedy,
                              Remark(by_gravity ? RemarkId::off_gravity : RemarkId::loads_left, before, after), before,
                              after});
    }
  }

  // One posture apart from the others, or two.

  void searchPostures(const std::vector<LoadMistake>& table) {
    const std::vector<double>& left = found_.fit.pose_left;
    const double usual = numerics::upperMedian(left);
    const bool hangs = numerics::upperMedian(found_.fit.pose_off_gravity) < kHangs;
    constexpr double kApart = 4.0, kLeast = 0.5;
    std::vector<std::size_t> apart;
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (left[k] > std::max(kLeast, kApart * usual) || (hangs && found_.fit.pose_off_gravity[k] > kDoesNot))
        apart.push_back(k);
    }
    constexpr std::size_t kMost = 4;
    if (apart.empty() || apart.size() > kMost) return;
    for (std::size_t a = 0; a < apart.size(); ++a) {
      for (std::size_t b = a + 1; b < apart.size(); ++b) {
        const int pose = loads_.poses()[apart[a]], other = loads_.poses()[apart[b]];
        const SpringFit fit = loads_.fitExchanged(declared_, pose, other);
        if (!mendsPosture(fit, apart[a]) || !mendsPosture(fit, apart[b])) continue;
        found_.cures.push_back({"row_order", whereOf(pose),
                                Remark(RemarkId::wrenches_exchanged, nameOf(pose), nameOf(other)),
                                Remark(RemarkId::loads_left, left[apart[a]], fit.pose_left[apart[a]]), left[apart[a]],
                                fit.pose_left[apart[a]]});
        return;
      }
    }
    for (const std::size_t at : apart) {
      const std::size_t before = found_.cures.size();
      searchPosture(table, at);
      if (found_.cures.size() == before) searchExchangedSteps(loads_.poses()[at]);
    }
  }

  bool mendsPosture(const SpringFit& fit, std::size_t at) const {
    constexpr double kLeft = 0.3;
    const double before = found_.fit.pose_off_gravity[at], after = fit.pose_off_gravity[at];
    const bool by_gravity = before > kDoesNot && after < kHangs;
    if (before < kHangs && after > kHangs) return false;
    // A thousandfold load at one posture bends the springs to it alone.
    if (fit.left > std::min(point_leaves_, kWorse * found_.fit.left)) return false;
    // A posture of a small load moves by what springs are not; a moment that then has another lever was right before.
    const SpringFit& as_read = found_.fit;
    if (fit.along_lever > std::max(kNoPoint, kWorse * as_read.along_lever) ||
        fit.pose_along_lever[at] > std::max(kNoPoint, kWorse * as_read.pose_along_lever[at]))
      return false;
    return fit.pose_left[at] < (by_gravity ? kWorse : kLeft) * found_.fit.pose_left[at];
  }

  std::string nameOf(int pose) const { return campaign::poseName(campaign_, pose); }

  Remark whereOf(int pose) const {
    for (const campaign::State& row : campaign_.states->rows) {
      if (row.pose == pose && row.step != 0)
        return Remark(RemarkId::at_pose_in, nameOf(pose), std::string("fx_n to mz_nm"),
                      campaign::rowName(campaign_.states->file, row.line));
    }
    return Remark(RemarkId::in_files, std::vector<std::string>{campaign_.states->file});
  }

  void searchPosture(const std::vector<LoadMistake>& table, std::size_t at) {
    const int pose = loads_.poses()[at];
    struct AtPosture {
      const LoadMistake* mistake;
      double left, off_gravity, along_lever;
    };
    std::vector<AtPosture> mending;
    for (const LoadMistake& mistake : table) {
      if (!mistake.of_one_posture) continue;
      const SpringFit fit = loads_.fitAtPose(declared_, pose, mistake.meant);
      if (mendsPosture(fit, at))
        mending.push_back({&mistake, fit.pose_left[at], fit.pose_off_gravity[at], fit.pose_along_lever[at]});
    }
    if (mending.empty()) return;
    const auto only = [&](const auto& good) {
      if (std::any_of(mending.begin(), mending.end(), good))
        std::erase_if(mending, [&](const AtPosture& one) { return !good(one); });
    };
    if (numerics::upperMedian(found_.fit.pose_off_gravity) < kHangs)
      only([](const AtPosture& one) { return one.off_gravity < kHangs; });
    only([](const AtPosture& one) { return one.along_lever < kNoPoint; });
    double best = INFINITY;
    for (const AtPosture& one : mending) best = std::min(best, one.left);
    std::erase_if(mending, [&](const AtPosture& one) { return one.left > kLoadsAsWell * best + 0.005; });
    int least = mending.front().mistake->things;
    for (const AtPosture& one : mending) least = std::min(least, one.mistake->things);
    for (const AtPosture& one : mending) {
      if (one.mistake->things > least) continue;
      found_.cures.push_back({one.mistake->id, whereOf(pose), one.mistake->remedy,
                              Remark(RemarkId::loads_left, found_.fit.pose_left[at], one.left),
                              found_.fit.pose_left[at], one.left});
    }
  }

  /// Share that the springs leave of a posture, none of one that is not among the loads.
  double leftAt(int pose) const {
    const auto at = std::find(loads_.poses().begin(), loads_.poses().end(), pose);
    return at == loads_.poses().end() ? 0.0
                                      : found_.fit.pose_left[static_cast<std::size_t>(at - loads_.poses().begin())];
  }

  /// Wrenches of a posture that are those of another, in all steps.
  bool searchRepeatedWrenches() {
    const std::optional<std::pair<int, int>> poses = posesOfEqualWrenches(campaign_);
    if (!poses) return false;
    // The later of two is the one that was not updated, unless the springs say otherwise.
    const auto [earlier, later] = *poses;
    const bool of_later = leftAt(later) >= leftAt(earlier);
    const int stale = of_later ? later : earlier, own = of_later ? earlier : later;
    found_.cures.push_back({"row_order", whereOf(stale),
                            Remark(RemarkId::wrenches_repeated, nameOf(stale), nameOf(own)),
                            Remark(RemarkId::loads_left, leftAt(stale), leftAt(own)), leftAt(stale), leftAt(own)});
    return true;
  }

  // Load steps: of one the wrenches of another, two exchanged, or one apart from the others.

  bool searchRepeatedSteps() {
    const std::optional<RepeatedSteps> repeated = stepsOfEqualWrenches(campaign_);
    if (!repeated) return false;
    std::vector<std::string> poses;
    for (const int pose : repeated->poses) poses.push_back(nameOf(pose));
    const double before = leftAt(repeated->poses.front()), others = numerics::upperMedian(found_.fit.pose_left);
    found_.cures.push_back({"row_order", whereOf(repeated->poses.front()),
                            Remark(RemarkId::steps_repeated, poses, repeated->step, repeated->own),
                            Remark(RemarkId::loads_left, before, others), before, others});
    return true;
  }

  /// Mends an exchange in part: one of the two wrenches where it belongs, and states at the end left out.
  static bool shiftsSteps(const LoadTrial& trial) {
    return trial.mistake.meant.row == WrenchRow::previous_step || trial.mistake.meant.row == WrenchRow::next_step;
  }

  /// `below`: what the exchange has to leave less than. Whether one does.
  bool searchExchangedSteps(std::optional<int> pose, double below = INFINITY) {
    constexpr double kLeast = 0.3, kMends = 0.5;
    std::size_t at = 0;
    if (pose) {
      at = static_cast<std::size_t>(std::find(loads_.poses().begin(), loads_.poses().end(), *pose) -
                                    loads_.poses().begin());
    } else if (found_.fit.left < kLeast) {
      return false;
    }
    std::vector<int> steps{0};
    for (const LoadedReading& row : day_.loaded) {
      if (std::find(steps.begin(), steps.end(), row.step) == steps.end()) steps.push_back(row.step);
    }
    const auto leftOf = [&](const SpringFit& fit) { return pose ? fit.pose_left[at] : fit.left; };
    const double before = leftOf(found_.fit);
    double best = std::min(kMends * before, below);
    std::optional<Suspected> cure;
    constexpr std::size_t kMostSteps = 8;
    if (steps.size() > kMostSteps) return false;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      for (std::size_t k = i + 1; k < steps.size(); ++k) {
        const int a = std::min(steps[i], steps[k]), b = std::max(steps[i], steps[k]);
        for (const bool of_points : {false, true}) {
          // Of two loaded steps points and wrenches say the same, and the wrenches are fewer.
          if (of_points != (a == 0)) continue;
          const LoadsOfDay exchanged(withStepsExchanged(day_, a, b, of_points, pose), arm_);
          const SpringFit fit = exchanged.fit(declared_);
          if (leftOf(fit) >= best || fit.pose_left.size() != found_.fit.pose_left.size()) continue;
          best = leftOf(fit);
          const std::string columns = of_points ? "step" : "fx_n to mz_nm";
          cure = Suspected{
              "row_order",
              pose ? whereOf(*pose)
                   : Remark(RemarkId::in_columns, columns,
                            std::vector<std::string>{of_points && campaign_.loading ? campaign_.loading->file
                                                                                    : campaign_.states->file}),
              Remark(RemarkId::steps_exchanged, a, b, of_points),
              Remark(RemarkId::loads_left, before, best),
              before,
              best};
        }
      }
    }
    if (cure) found_.cures.push_back(std::move(*cure));
    return cure.has_value();
  }

  /// Displacements grow as the load does: a step whose load is written too large moves too little for it.
  void searchSteps() {
    const std::map<int, double>& moves = found_.fit.step_moves;
    constexpr std::size_t kSteps = 3;
    constexpr double kAlike = 1.1, kApart = 1.5, kLeast = 0.1, kMends = 0.5;
    // Less is seen where the others agree better: joints that stiffen or have play put a step four times as far off.
    constexpr double kLittleApart = 1.1, kLeastOfLittle = 0.03, kOfOthers = 5.0;
    if (moves.size() < kSteps || found_.fit.left < kLeastOfLittle) return;
    for (const auto& [step, share] : moves) {
      double least = INFINITY, most = 0.0;
      for (const auto& [other, its] : moves) {
        if (other != step) least = std::min(least, its), most = std::max(most, its);
      }
      if (!(least > 0.0) || !(share > 0.0) || most > kAlike * kAlike * least) continue;
      const double factor = std::sqrt(least * most) / share;  // by which its load is too large
      const double apart = std::max(factor, 1.0 / factor);
      const bool far = apart > kApart && found_.fit.left > kLeast;
      if (!far && (apart < kLittleApart || std::log(apart) < kOfOthers * std::log(most / least))) continue;
      const SpringFit fit = loads_.fitScaled(declared_, step, 1.0 / factor);
      if (fit.left > std::min(kMends * found_.fit.left, point_leaves_)) continue;
      found_.cures.push_back(
          {"step_scale",
           Remark(RemarkId::in_columns, std::string("fx_n to mz_nm"), std::vector<std::string>{campaign_.states->file}),
           Remark(RemarkId::step_scale_off, step, factor), Remark(RemarkId::loads_left, found_.fit.left, fit.left),
           found_.fit.left, fit.left});
      return;
    }
  }

  const campaign::Campaign& campaign_;
  const ReadingsOfDay& day_;
  const NominalFit& arm_;
  LoadsOfDay loads_;
  CellReading declared_;
  double point_leaves_ = INFINITY;  ///< of the displacements, where moving the cell's point mends
  LoadSearch found_;
};

}  // namespace

LoadSearch searchLoads(const campaign::Campaign& campaign, const ReadingsOfDay& day, const NominalFit& arm) {
  if (!campaign.load_cell || !campaign.states || !arm.done) return {};
  return LoadSearcher(campaign, day, arm).run();
}

}  // namespace stiffscope::mistakes
