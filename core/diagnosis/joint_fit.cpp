#include "core/diagnosis/fit.h"

#include <ceres/ceres.h>
#include <Eigen/Dense>
#include <vector>

#include "core/frames/arm_parameters.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::diagnosis {

namespace {

/// Parameters of one model in a vector of all effects' parameters.
Eigen::VectorXd ownOf(const SystemInput& input, const GapLayout& layout, const Eigen::VectorXd& effects,
                      std::size_t m) {
  return effects.segment(layout.model_at[m] - layout.effects, static_cast<Eigen::Index>(input.models[m].parameters()));
}

}  // namespace

bool becomesPart(const effects::EffectModel& model) { return model.movesArm() || isBilinear(model); }

bool isBilinear(const effects::EffectModel& model) { return model.correct != nullptr; }

ContainedEffects correct(const SystemInput& input, const GapLayout& layout, const FittedSet& set,
                         const Eigen::VectorXd& nuisances, SystemState& state) {
  const JointVector before = state.at.compliance;
  state.at.compliance = nuisances.head(layout.joints()).cwiseMax(0.0);
  state.geometry.compliance = state.at.compliance;
  if (!state.geometry.weight.links_known) state.geometry.compliance.setZero();
  const Eigen::VectorXd steps = nuisances.segment(layout.geometry, layout.weights - layout.geometry);
  if (input.absolute) {
    const frames::LoadingGeometry there = frames::moved(state.geometry, steps, state.at.epoch_centre);
    state.r0_from_sweeps =
        metrology::motionAbout(state.at.epoch_centre,
                               steps.segment<6>(frames::ArmParameters(state.geometry.arm.axes()).baseAt())) *
        state.r0_from_sweeps;
    state.geometry = there;
  }
  state.corrections = {};
  state.at.compensator.resize(0);
  ContainedEffects contained{Eigen::VectorXd::Zero(set.effects.size()), Eigen::VectorXd::Zero(set.effects.size())};
  state.at.present.clear();
  for (const ChosenModel& one : set.models) {
    const effects::EffectModel& model = input.models[one.model];
    Eigen::VectorXd own = ownOf(input, layout, set.effects, one.model);
    const Eigen::Index at = layout.model_at[one.model] - layout.effects;
    if (model.correct) model.correct(before, state.at, state.corrections, own);
    if (model.settle) model.settle(state.at, own);
    if (model.movesArm()) state.at.present.push_back({&model, own});
    if (becomesPart(model)) contained.in_positions.segment(at, own.size()) = own;
    if (isBilinear(model)) contained.in_deflections.segment(at, own.size()) = own;
  }
  return contained;
}

namespace {

using Eigen::Index;

/// The unknowns: all nuisances, then the set's own parameters.
struct Unknowns {
  std::vector<Index> at;      ///< of each in the layout
  std::vector<double> prior;  ///< 1 / bound^2 of an effect's parameter; 0 of a nuisance
  std::vector<bool> positive;
};

Unknowns unknownsOf(const SystemInput& input, const GapLayout& layout, const FittedSet& set) {
  Unknowns unknowns;
  const auto add = [&](Index at, double prior, bool positive) {
    unknowns.at.push_back(at);
    unknowns.prior.push_back(prior);
    unknowns.positive.push_back(positive);
  };
  for (Index i = 0; i < layout.effects; ++i) add(i, 0.0, false);
  for (const ChosenModel& one : set.models) {
    const effects::EffectModel& model = input.models[one.model];
    std::vector<bool> chosen(model.parts.size(), false);
    for (const std::size_t part : one.parts) chosen[part] = true;
    Index at = layout.model_at[one.model];
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      for (const double most : model.parts[p].most) {
        if (chosen[p]) add(at, 1.0 / (most * most), model.parts[p].positive);
        ++at;
      }
    }
  }
  return unknowns;
}

/// R with R^T R = N for a positive semidefinite N whose rows differ by many decades.
Eigen::MatrixXd rootOf(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd size = normal.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd even = size.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; });
  const SymmetricEigen eigen = symmetricEigen(even.asDiagonal() * normal * even.asDiagonal());
  const Eigen::VectorXd roots = eigen.values.cwiseMax(0.0).cwiseSqrt();
  return roots.asDiagonal() * eigen.vectors.transpose() * size.asDiagonal();
}

class GapCost : public ceres::CostFunction {
 public:
  GapCost(const SystemInput& input, const SystemState& from, const GapLayout& layout, const FittedSet& set,
          GeometryColumns& by_geometry)
      : input_(input),
        from_(from),
        layout_(layout),
        set_(set),
        by_geometry_(by_geometry),
        unknowns_(unknownsOf(input, layout, set)) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns_.at.size()));
    set_num_residuals(static_cast<int>(unknowns_.at.size()) + 1);
  }

  const Unknowns& unknowns() const { return unknowns_; }

  /// Moves to x; `there` becomes x as the equations made there have it: what was a step is done, sizes are
  /// whole.
  JointlyFitted moveTo(const double* x, Eigen::VectorXd& there) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(layout_.end);
    for (std::size_t i = 0; i < unknowns_.at.size(); ++i) all[unknowns_.at[i]] = x[i];
    FittedSet set = set_;
    set.effects = all.tail(layout_.end - layout_.effects);
    JointlyFitted moved{from_, {}};
    moved.contained = correct(input_, layout_, set, all.head(layout_.effects), moved.state);
    if (input_.absolute) all.segment(layout_.geometry, layout_.weights - layout_.geometry).setZero();
    for (const ChosenModel& one : set.models) {
      const Index at = layout_.model_at[one.model];
      const auto size = static_cast<Index>(input_.models[one.model].parameters());
      if (becomesPart(input_.models[one.model]))
        all.segment(at, size) = moved.contained.in_positions.segment(at - layout_.effects, size);
    }
    there = all(unknowns_.at);
    return moved;
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Index count = num_residuals() - 1;
    const Eigen::Map<const Eigen::VectorXd> x(parameters[0], count);
    // A trial is asked for again, with its Jacobian, once it is taken.
    if (last_x_.size() == 0 || x != last_x_) {
      if (!makeAt(parameters[0])) return false;
      last_x_ = x;
    }
    Eigen::Map<Eigen::VectorXd>(residuals, count + 1) = residual_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[0], count + 1, count) = jacobian_;
    }
    return true;
  }

 private:
  bool makeAt(const double* x) const {
    Eigen::VectorXd there;
    const JointlyFitted moved = moveTo(x, there);
    const LinearSystem data = linearSystem(input_, moved.state, moved.contained, by_geometry_);
    std::vector<Index> kept = unknowns_.at;
    kept.push_back(layout_.end);
    Eigen::MatrixXd normal = sumOf(data, std::vector<double>(data.postures.size(), 1.0))(kept, kept);
    for (Index i = 0; i < there.size(); ++i) normal(i, i) += unknowns_.prior[static_cast<std::size_t>(i)];
    if (!normal.allFinite()) return false;
    const Eigen::MatrixXd root = rootOf(normal);
    residual_ = root.rightCols<1>() - root.leftCols(there.size()) * there;
    jacobian_ = -root.leftCols(there.size());
    return true;
  }

  const SystemInput& input_;
  const SystemState& from_;
  const GapLayout& layout_;
  const FittedSet& set_;
  GeometryColumns& by_geometry_;
  Unknowns unknowns_;
  mutable Eigen::VectorXd last_x_, residual_;
  mutable Eigen::MatrixXd jacobian_;
};

}  // namespace

std::optional<JointlyFitted> fitJointly(const SystemInput& input, const SystemState& from, const GapLayout& layout,
                                        const FittedSet& set, const Eigen::VectorXd& nuisances,
                                        GeometryColumns& by_geometry) {
  bool bilinear = false;
  for (const ChosenModel& one : set.models) {
    // Friction and play bend in corners, where a trust region shrinks to nothing.
    if (input.models[one.model].settle) return std::nullopt;
    bilinear = bilinear || isBilinear(input.models[one.model]);
  }
  if (!bilinear) return std::nullopt;
  GapCost cost(input, from, layout, set, by_geometry);
  const Unknowns& unknowns = cost.unknowns();
  Eigen::VectorXd all(layout.end);
  all << nuisances, set.effects;
  Eigen::VectorXd x = all(unknowns.at);

  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, x.data());
  for (std::size_t i = 0; i < unknowns.at.size(); ++i) {
    if (unknowns.positive[i]) problem.SetParameterLowerBound(x.data(), static_cast<int>(i), 0.0);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 4;
  options.function_tolerance = 1e-4;  // of chi2: far below what a verdict turns on
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || summary.num_successful_steps == 0) return std::nullopt;
  return cost.moveTo(x.data(), all);
}

}  // namespace stiffscope::diagnosis
