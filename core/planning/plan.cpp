#include "core/planning/plan.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/posture_stiffness.h"
#include "core/io/input_error.h"
#include "core/planning/design.h"
#include "core/robot/wrench.h"

namespace stiffscope::planning {

namespace {

/// The method whose geometry the plan takes.
const identification::MethodResult* referenceOf(const identification::Identification* identified) {
  if (identified == nullptr) return nullptr;
  for (const identification::Method method :
       {identification::Method::decoupled_partial_pose, identification::Method::partial_pose,
        identification::Method::complete_pose}) {
    if (identified->of(method).available) return &identified->of(method);
  }
  return nullptr;
}

identification::CaseEquations equationsOf(const PlanningArm& arm, const Candidate& candidate) {
  const identification::LoadCase& load_case = candidate.load_case;
  const JointVector torque = robot::jointTorque(load_case.axes, load_case.wrench);
  const Eigen::Isometry3d flange =
      robot::flangeAt(arm.geometry.arm, identification::unloadedPosture(arm.geometry.arm, load_case));
  identification::CaseEquations equations;
  equations.matrix.resize(static_cast<Eigen::Index>(3 * arm.targets_in_flange.size()), torque.size());
  for (std::size_t k = 0; k < arm.targets_in_flange.size(); ++k) {
    equations.matrix.middleRows<3>(static_cast<Eigen::Index>(3 * k)) =
        identification::pointRows(load_case.axes, flange * arm.targets_in_flange[k], torque);
  }
  equations.right = Eigen::VectorXd::Zero(equations.matrix.rows());
  return equations;
}

class Planner {
 public:
  Planner(const campaign::Campaign& campaign, const identification::Identification* identified,
          const PlanOptions& options)
      : campaign_(campaign),
        identified_(identified),
        reference_(referenceOf(identified)),
        options_(options),
        problem_(campaign.robot.joints()) {}

  Plan run() {
    checkOptions();
    plan_.arm = planningArm(campaign_, identified_, options_.inputs);
    plan_.asked = options_.postures;
    if (reference_ != nullptr) plan_.compliance = reference_->estimate.compliance;
    CandidateDraw draw = drawCandidates(plan_.arm, options_.rules, options_.candidates, options_.seed);
    plan_.candidates = static_cast<int>(draw.kept.size()), plan_.drawn = draw.drawn;
    candidates_ = std::move(draw.kept);
    judge();
    if (!plan_.usable) return std::move(plan_);
    pose();
    choose();
    return std::move(plan_);
  }

 private:
  void checkOptions() const {
    const auto refuse = [](const char* option, int value, const char* expected) {
      throw io::InputError({option}, std::to_string(value), expected);
    };
    if (options_.postures < 1) {
      refuse(options_.augment ? "--add" : "--postures", options_.postures, "expected 1 or more postures");
    }
    if (options_.candidates < options_.postures) {
      refuse("--candidates", options_.candidates, "expected at least as many candidates as postures");
    }
    if (options_.augment && (identified_ == nullptr || reference_ == nullptr || identified_->cases.empty())) {
      throw io::InputError({"--add"}, "", "no measured postures that identify: --postures plans the day before");
    }
  }

  /// Which joints the candidates (with what is measured) would show.
  void judge() {
    std::vector<identification::LoadCase> cases;
    std::vector<identification::CaseEquations> equations;
    for (const Candidate& one : candidates_) {
      cases.push_back(one.load_case);
      equations.push_back(equationsOf(plan_.arm, one));
    }
    if (options_.augment) {
      cases.insert(cases.end(), identified_->cases.begin(), identified_->cases.end());
      equations.insert(equations.end(), reference_->target_rows.begin(), reference_->target_rows.end());
    }
    const identification::Identifiability judged =
        identification::evaluateIdentifiability(plan_.arm.geometry, cases, plan_.arm.cell, equations);
    plan_.unknown = judged.mask();
    for (const auto& joint : judged.joints) plan_.not_seen.push_back(joint.reason);
    plan_.usable = std::any_of(plan_.unknown.begin(), plan_.unknown.end(), [](bool one) { return one; });
    if (!plan_.usable) plan_.reason = Remark(RemarkId::no_joint_seen);
  }

  /// The problem for the exchange: information, what is measured, which are alike.
  void pose() {
    const std::size_t n = candidates_.size();
    problem_.unknown = plan_.unknown;
    problem_.barred.assign(n, 0);
    problem_.excludes.assign(n, std::vector<char>(n, 0));
    for (std::size_t a = 0; a < n; ++a) {
      problem_.information.push_back(candidates_[a].information);
      for (std::size_t b = 0; b < a; ++b) {
        const bool same = alike(plan_.arm, candidates_[a], candidates_[b], options_.least_separation);
        problem_.excludes[a][b] = problem_.excludes[b][a] = same;
      }
    }
    if (!options_.augment) return;
    plan_.measured = static_cast<int>(identified_->cases.size());
    for (std::size_t i = 0; i < identified_->cases.size(); ++i)
      addMeasured(identified_->cases[i], reference_->target_rows[i]);
    if (options_.inputs.effects) loosenBy(options_.inputs.effects.covariance[methodOf(reference_)]);
    plan_.sd_measured = standardDeviations(problem_.known, plan_.unknown);
  }

  void addMeasured(const identification::LoadCase& load_case, const identification::CaseEquations& rows) {
    for (std::size_t k = 0; k < load_case.targets.size(); ++k) {
      const PointJacobian own = rows.matrix.middleRows<3>(static_cast<Eigen::Index>(3 * k));
      problem_.known +=
          own.transpose() * plan_.arm.displacementCovariance(load_case.targets[k].unloaded).llt().solve(own);
    }
    Candidate measured(load_case.q, load_case.wrench.force.normalized());
    for (std::size_t a = 0; a < candidates_.size(); ++a) {
      if (alike(plan_.arm, candidates_[a], measured, options_.least_separation)) problem_.barred[a] = 1;
    }
    measured_.push_back(std::move(measured));
  }

  std::size_t methodOf(const identification::MethodResult* method) const {
    return static_cast<std::size_t>(method - identified_->methods.data());
  }

  /// What is measured, with the covariance that the model's effects bring to the compliances: all postures share it.
  void loosenBy(const JointMatrix& covariance) {
    std::vector<Eigen::Index> joints;
    for (Eigen::Index j = 0; j < problem_.known.rows(); ++j) {
      if (plan_.unknown[static_cast<std::size_t>(j)] && problem_.known(j, j) > 0.0) joints.push_back(j);
    }
    const Eigen::MatrixXd known = problem_.known(joints, joints), more = covariance(joints, joints);
    // (N^-1 + C)^-1 = N (I + C N)^-1
    const Eigen::MatrixXd both = Eigen::MatrixXd::Identity(known.rows(), known.cols()) + more * known;
    const Eigen::MatrixXd loose = known * both.partialPivLu().inverse();
    problem_.known.setZero();
    problem_.known(joints, joints) = 0.5 * (loose + loose.transpose());
  }

  std::string freeId(int& number) const {
    const auto& used = campaign_.pose_ids;
    std::string id;
    do {
      id = fmt::format("plan{}", ++number);
    } while (options_.augment && std::find(used.begin(), used.end(), id) != used.end());
    return id;
  }

  void choose() {
    ExchangeOptions exchange;
    exchange.seed = options_.seed;
    Design design = exchangeDesign(problem_, options_.postures, exchange);
    const int count = static_cast<int>(design.chosen.size());
    plan_.random_same = randomPostures(problem_, count, options_.random_sets, options_.seed + 1);
    plan_.random_double = randomPostures(problem_, 2 * count, options_.random_sets, options_.seed + 1);
    if (options_.criterion == PlanCriterion::balanced && allFinite(plan_.random_same.sd)) {
      problem_.reference = plan_.random_same.sd;
      exchange.from = design.chosen;
      design = exchangeDesign(problem_, options_.postures, exchange);
    }
    std::vector<Candidate> chosen;
    for (const std::size_t one : design.chosen) chosen.push_back(candidates_[one]);
    RefineOptions refine;
    refine.least_separation = options_.least_separation;
    refine.reference = problem_.reference;
    refineDesign(plan_.arm, options_.rules, problem_.known, plan_.unknown, measured_, refine, chosen);
    DesignProblem order = problem_;  // once more, for the order
    order.information.clear(), order.excludes.clear(), order.barred.clear();
    order.reference.reset();
    exchange.from.clear();
    for (const Candidate& one : chosen) order.information.push_back(one.information);
    const Design last = exchangeDesign(order, count, exchange);
    plan_.log_determinant = last.log_determinant;
    for (RandomPostures* random : {&plan_.random_same, &plan_.random_double}) compareWith(*random);
    std::vector<Candidate> ordered;
    for (const std::size_t one : last.chosen) ordered.push_back(chosen[one]);
    describe(ordered);
  }

  bool allFinite(const JointVector& sd) const {
    for (std::size_t j = 0; j < plan_.unknown.size(); ++j) {
      if (plan_.unknown[j] && !std::isfinite(sd[static_cast<Eigen::Index>(j)])) return false;
    }
    return true;
  }

  void compareWith(RandomPostures& random) const {
    const auto unknowns = std::count(plan_.unknown.begin(), plan_.unknown.end(), true);
    random.efficiency = std::exp((plan_.log_determinant - random.log_determinant) / static_cast<double>(unknowns));
  }

  void describe(const std::vector<Candidate>& chosen) {
    JointMatrix sum = problem_.known;
    double before = logDeterminant(sum, plan_.unknown);
    int number = 0;
    for (const Candidate& one : chosen) {
      PlannedPosture posture(freeId(number), one);
      posture.reading = expectedReading(plan_.arm, posture.candidate);
      posture.pull_in_base = plan_.arm.geometry.r0_from_base_link.linear().transpose() * posture.candidate.direction;
      const robot::ArmPosture at = identification::unloadedPosture(plan_.arm.geometry.arm, posture.candidate.load_case);
      const Eigen::Vector3d flange = robot::flangeAt(plan_.arm.geometry.arm, at).translation();
      posture.dexterity =
          identification::postureConditioning(robot::jacobianAt(plan_.arm.geometry.arm, at, flange), 1.0).dexterity;
      if (plan_.arm.station) posture.tracker_distance = (flange - *plan_.arm.station).norm();
      sum += one.information;
      const double after = logDeterminant(sum, plan_.unknown);
      posture.log_det_gain = std::isfinite(before) ? after - before : std::numeric_limits<double>::infinity();
      posture.sd = standardDeviations(sum, plan_.unknown);
      before = after;
      plan_.postures.push_back(std::move(posture));
    }
  }

  const campaign::Campaign& campaign_;
  const identification::Identification* identified_;
  const identification::MethodResult* reference_;
  const PlanOptions& options_;
  std::vector<Candidate> candidates_, measured_;
  DesignProblem problem_;
  Plan plan_;
};

}  // namespace

Plan planCampaign(const campaign::Campaign& campaign, const identification::Identification* identified,
                  const PlanOptions& options) {
  return Planner(campaign, identified, options).run();
}

}  // namespace stiffscope::planning
