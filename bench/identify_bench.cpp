#include <benchmark/benchmark.h>

#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <map>
#include <random>
#include <stdexcept>

#include "bench/shared_data.h"
#include "core/diagnosis/diagnose.h"
#include "core/frames/frames.h"
#include "core/identification/identify.h"
#include "core/identification/load_case.h"
#include "core/identification/method_solution.h"
#include "core/numerics/resampling.h"
#include "core/robot/kinematics.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"

// What is computed from a campaign, at 19, 190 and 1,900 postures of the sample's machine: frames, each method and all
// three with their uncertainties, all subsets, the diagnosis. Beside them KDL's Jacobian, whose numbers are checked
// against ours, and, by subsets_by_numpy.py on the same equations, all subsets.

namespace {

using namespace stiffscope;

simulation::SimulationSpec spec() {
  return simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
}

const campaign::Campaign& campaign(int postures) {
  static std::map<int, campaign::Campaign> made;
  const auto found = made.find(postures);
  if (found != made.end()) return found->second;
  simulation::SimulationSpec one = spec();
  one.posture_draw->count = postures;
  return made.emplace(postures, simulation::simulate(one)).first->second;
}

void sizes(benchmark::internal::Benchmark* one) { one->Arg(19)->Arg(190)->Arg(1900)->Unit(benchmark::kMillisecond); }

void Frames(benchmark::State& state) {
  const campaign::Campaign& read = campaign(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(identification::solvedFrames(read));
}
BENCHMARK(Frames)->Apply(sizes)->MeasureProcessCPUTime();

/// Complete, Partial and Decoupled Partial Pose with uncertainties, and one subset in place of all.
void ThreeMethods(benchmark::State& state) {
  const campaign::Campaign& read = campaign(static_cast<int>(state.range(0)));
  identification::IdentifyOptions options;
  options.subsets.most_all = 0;
  options.subsets.sample = 1;
  for (auto _ : state) benchmark::DoNotOptimize(identification::identify(read, options));
}
BENCHMARK(ThreeMethods)->Apply(sizes)->MeasureProcessCPUTime();

/// One method from the readings on, in the frames that are settled before: load cases, equations, compliances and their
/// uncertainty by scatter, K_c neglected. Partial Pose without its calibration, which stands apart.
void method(benchmark::State& state, identification::Method which) {
  const campaign::Campaign& read = campaign(static_cast<int>(state.range(0)));
  const std::vector<int> steps{identification::chosenStep(read, {})};
  const identification::SolvedFrames settled = identification::solveFrames(read, steps, {});
  const frames::LoadingGeometry& geometry = settled.arm.geometry;
  const double length = identification::characteristicLength(settled.arm.cases, settled.frames.tcp_in_flange).length;
  const robot::JointMask unknown =
      identification::evaluateIdentifiability(geometry, settled.arm.cases, *read.load_cell,
                                              identification::reflectorEquations(settled.arm))
          .mask();
  const identification::MethodSolution how{which, settled.frames.tcp_in_flange, length, unknown, &*read.tracker};
  for (auto _ : state) {
    identification::LoadedArm arm = identification::loadedArm(read, geometry, settled.frames.wrist, steps);
    benchmark::DoNotOptimize(how.solvedEstimate(arm, false));
  }
}
void CompletePose(benchmark::State& state) { method(state, identification::Method::complete_pose); }
BENCHMARK(CompletePose)->Apply(sizes)->MeasureProcessCPUTime();
void PartialPose(benchmark::State& state) { method(state, identification::Method::partial_pose); }
BENCHMARK(PartialPose)->Apply(sizes)->MeasureProcessCPUTime();
void DecoupledPartialPose(benchmark::State& state) { method(state, identification::Method::decoupled_partial_pose); }
BENCHMARK(DecoupledPartialPose)->Apply(sizes)->MeasureProcessCPUTime();

/// Partial Pose's geometry on the unloaded positions.
void Calibration(benchmark::State& state) {
  const campaign::Campaign& read = campaign(static_cast<int>(state.range(0)));
  const identification::SolvedFrames settled =
      identification::solveFrames(read, {identification::chosenStep(read, {})}, {});
  for (auto _ : state) benchmark::DoNotOptimize(frames::calibrateGeometry(read, settled.arm.geometry));
}
BENCHMARK(Calibration)->Apply(sizes)->MeasureProcessCPUTime();

std::vector<identification::CaseEquations> drawnEquations(int n) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<identification::CaseEquations> equations;
  for (int p = 0; p < n; ++p) {
    equations.push_back({Eigen::MatrixXd::NullaryExpr(9, 6, [&] { return normal(random); }),
                         Eigen::VectorXd::NullaryExpr(9, [&] { return normal(random); }), p});
  }
  return equations;
}

identification::SubsetStudy allSubsets(const std::vector<identification::CaseEquations>& equations) {
  identification::SubsetMethod method;
  method.unknown.assign(static_cast<std::size_t>(equations.front().matrix.cols()), true);
  for (const identification::CaseEquations& one : equations)
    method.normal.push_back(identification::normalEquations(one));
  identification::SubsetOptions options;
  options.size = static_cast<int>(equations.size()) / 2;
  return identification::studySubsets(method, options);
}

/// All subsets of half of 10, 14 and 18 postures: 252, 3,432 and 48,620.
void AllSubsets(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const std::vector<identification::CaseEquations> equations = drawnEquations(n);
  for (auto _ : state) benchmark::DoNotOptimize(allSubsets(equations));
  state.counters["per_subset"] =
      benchmark::Counter(static_cast<double>(numerics::subsetCount(n, n / 2)),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(AllSubsets)->Arg(10)->Arg(14)->Arg(18)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void Diagnosis(benchmark::State& state) {
  const campaign::Campaign& read = campaign(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(diagnosis::diagnose(read));
}
BENCHMARK(Diagnosis)->Apply(sizes)->MeasureProcessCPUTime()->Iterations(1)->Repetitions(1);

std::vector<JointVector> drawnPostures(Eigen::Index joints, std::int64_t count) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> angle(-2.0, 2.0);
  std::vector<JointVector> postures;
  for (std::int64_t i = 0; i < count; ++i)
    postures.push_back(JointVector::NullaryExpr(joints, [&] { return angle(random); }));
  return postures;
}

Jacobian ownJacobian(const robot::Robot& robot, const JointVector& q) {
  const robot::ArmPosture posture = robot::postureAt(robot, q);
  return robot::jacobianAt(robot, posture, robot::flangeAt(robot, posture).translation());
}

/// The same arm for KDL: a joint about each axis where it stands at zero, the flange behind the last.
KDL::Chain kdlChain(const robot::Robot& robot) {
  KDL::Chain chain;
  for (std::size_t i = 0; i < robot.axes_in_base_at_zero.size(); ++i) {
    const metrology::Line& axis = robot.axes_in_base_at_zero[i];
    const KDL::Vector point(axis.point.x(), axis.point.y(), axis.point.z());
    const KDL::Vector direction(axis.direction.x(), axis.direction.y(), axis.direction.z());
    const Eigen::Vector3d flange = robot.base_from_flange_at_zero.translation();
    const KDL::Vector tip = i + 1 == robot.axes_in_base_at_zero.size() ? KDL::Vector(flange.x(), flange.y(), flange.z())
                                                                       : KDL::Vector::Zero();
    chain.addSegment(KDL::Segment(KDL::Joint("joint", point, direction, KDL::Joint::RotAxis), KDL::Frame(tip)));
  }
  return chain;
}

void Jacobian(benchmark::State& state) {
  const robot::Robot robot = spec().nominal;
  const auto postures = drawnPostures(robot.joints(), state.range(0));
  for (auto _ : state) {
    for (const JointVector& q : postures) benchmark::DoNotOptimize(ownJacobian(robot, q));
  }
}
BENCHMARK(Jacobian)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

void JacobianByKdl(benchmark::State& state) {
  const robot::Robot robot = spec().nominal;
  const auto postures = drawnPostures(robot.joints(), state.range(0));
  KDL::Chain chain = kdlChain(robot);
  KDL::ChainJntToJacSolver solver(chain);
  KDL::JntArray angles(static_cast<unsigned int>(robot.joints()));
  KDL::Jacobian jacobian(static_cast<unsigned int>(robot.joints()));
  double apart = 0.0;
  for (const JointVector& q : postures) {
    angles.data = q;
    solver.JntToJac(angles, jacobian);
    apart = std::max(apart, (jacobian.data - ownJacobian(robot, q)).cwiseAbs().maxCoeff());
  }
  // Metres and pure numbers of size one to three: a hundred roundings.
  if (!(apart < 1e-12)) state.SkipWithError("KDL and stiffscope disagree");
  for (auto _ : state) {
    for (const JointVector& q : postures) {
      angles.data = q;
      solver.JntToJac(angles, jacobian);
      benchmark::DoNotOptimize(jacobian.data.data());
    }
  }
  state.counters["largest_difference"] = apart;
}
BENCHMARK(JacobianByKdl)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

/// Rows [A b] of every posture as AllSubsets_N.equations, and the mean compliances over the subsets as .mean.
void writeSubsets(const std::filesystem::path& folder) {
  for (const int n : {10, 14, 18}) {
    const std::string name = "AllSubsets_" + std::to_string(n);
    const std::vector<identification::CaseEquations> equations = drawnEquations(n);
    std::vector<double> rows;
    for (const identification::CaseEquations& one : equations) {
      for (Eigen::Index row = 0; row < one.right.size(); ++row) {
        for (Eigen::Index column = 0; column < one.matrix.cols(); ++column) rows.push_back(one.matrix(row, column));
        rows.push_back(one.right[row]);
      }
    }
    const identification::SubsetStudy study = allSubsets(equations);
    JointVector mean = JointVector::Zero(equations.front().matrix.cols());
    for (const JointVector& one : study.compliances) mean += one / static_cast<double>(study.compliances.size());
    bench::writeDoubles(folder / (name + ".equations"), rows);
    bench::writeDoubles(folder / (name + ".mean"), {mean.begin(), mean.end()});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (const auto folder = bench::dataFolder(argc, argv)) writeSubsets(*folder);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
