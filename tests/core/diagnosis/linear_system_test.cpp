#include "core/diagnosis/linear_system.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>
#include "core/diagnosis/geometry_columns.h"
#include "core/diagnosis/localization.h"
#include "core/diagnosis/projection.h"
#include "core/frames/arm_parameters.h"
#include "tests/fixtures/extended_day.h"

namespace stiffscope {
namespace linear_system_test {

// Weighing anew is what making the equations anew with other variances comes to, to the last bit.
TEST(LinearSystem, IsWeighedAgainAsItIsMadeAgain) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(8));
  const extended_model::EffectFit effects =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"bearing_tilt:3"}, campaign));
  const diagnosis::SystemInput& input = *effects.input;
  diagnosis::SystemState state = effects.fit.state;
  ASSERT_TRUE(input.absolute && input.sweeps);
  diagnosis::LinearSystem data = diagnosis::linearSystem(input, state, {}, diagnosis::Weighed::again);
  const std::vector<double> ones(data.postures.size(), 1.0);
  const Eigen::MatrixXd before = diagnosis::sumOf(data, ones);
  state.position_inflation *= 1.7;
  state.sweep_inflation *= 2.5;
  state.model_error += 1e-5;
  diagnosis::weighAgain(input, state, data);
  const diagnosis::LinearSystem made = diagnosis::linearSystem(input, state, {});
  EXPECT_EQ(diagnosis::sumOf(data, ones), diagnosis::sumOf(made, ones));
  EXPECT_NE(diagnosis::sumOf(data, ones), before);
  EXPECT_EQ(data.sweep_rows, made.sweep_rows);
  EXPECT_EQ(data.state_noise, made.state_noise);
  EXPECT_EQ(data.as_read.rows.size(), 0);
}

/// Columns of the geometry are kept where equations were made already: they are those that would be made anew, to the
/// last bit, and of another place its own.
TEST(LinearSystem, TheGeometrysColumnsAreOfThePlaceItself) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(8));
  const extended_model::EffectFit effects =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"bearing_tilt:3"}, campaign));
  const diagnosis::SystemInput& input = *effects.input;
  const diagnosis::SystemState& start = effects.fit.state;
  ASSERT_TRUE(input.absolute && input.sweeps);
  const auto expectSame = [](const diagnosis::LinearSystem& one, const diagnosis::LinearSystem& other) {
    EXPECT_EQ(one.sweeps, other.sweeps);
    ASSERT_EQ(one.postures.size(), other.postures.size());
    for (std::size_t p = 0; p < one.postures.size(); ++p) {
      EXPECT_EQ(one.postures[p].columns, other.postures[p].columns);
      EXPECT_EQ(one.postures[p].right, other.postures[p].right);
    }
  };
  diagnosis::GeometryColumns kept;
  const diagnosis::LinearSystem first = diagnosis::linearSystem(input, start, {}, kept);
  expectSame(first, diagnosis::linearSystem(input, start, {}));
  diagnosis::SystemState moved = start, softer = start;
  const Eigen::Index steps = first.layout.weights - first.layout.geometry;
  moved.geometry = frames::moved(start.geometry, Eigen::VectorXd::Constant(steps, 1e-6), start.at.epoch_centre);
  softer.at.compliance *= 1.001;
  const std::vector<const diagnosis::SystemState*> places{&moved, &softer, &moved, &start};
  for (const diagnosis::SystemState* const other : places) {
    const diagnosis::LinearSystem made = diagnosis::linearSystem(input, *other, {}, kept);
    expectSame(made, diagnosis::linearSystem(input, *other, {}));
    EXPECT_EQ(made.postures.front().columns == first.postures.front().columns, other == &start);
  }
}

/// All postures but one, of several at a time: what they have in common is added once.
TEST(LinearSystem, SumsOfSeveralWeightsAreThoseOfEach) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(8));
  const extended_model::EffectFit effects =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"bearing_tilt:3"}, campaign));
  const diagnosis::LinearSystem& data = *effects.fit.data;
  const std::size_t postures = data.postures.size();
  ASSERT_GE(postures, 8u);
  std::vector<std::vector<double>> weights;
  for (std::size_t p = 0; p < 3; ++p) {
    weights.emplace_back(postures, 1.0);
    weights.back()[p] = 0.0;
  }
  weights.emplace_back(postures, 1.0);
  weights.back()[0] = 2.0;
  weights.back()[5] = 0.0;
  const std::vector<Eigen::MatrixXd> sums = diagnosis::sumsOf(data, weights);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    Eigen::MatrixXd sum = data.sweeps;
    for (std::size_t p = 0; p < postures; ++p) data.postures[p].normal.addTo(weights[k][p], sum);
    sum.triangularView<Eigen::StrictlyUpper>() = sum.transpose();
    EXPECT_LT((sums[k] - sum).cwiseAbs().maxCoeff(), 1e-12 * sum.cwiseAbs().maxCoeff()) << k;
  }
}

/// Repeats differ from reflector to reflector and from state to state: each mean has the noise of its own.
TEST(LinearSystem, EachMeanHasTheNoiseOfItsOwnReadings) {
  campaign::Campaign campaign = simulation::simulate(springsAlone(8));
  const extended_model::EffectFit effects =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"bearing_tilt:3"}, campaign));
  const auto left = [](const campaign::LoadingReading& row) {
    const int kept = row.target == 0 ? 3 : (row.step == 0 ? 1 : 2);
    return row.repeat <= kept;
  };
  std::erase_if(campaign.loading->rows, [&](const campaign::LoadingReading& row) { return !left(row); });
  const auto readings = [&](int pose, int step, int target) {
    return std::count_if(campaign.loading->rows.begin(), campaign.loading->rows.end(),
                         [&](const auto& row) { return row.pose == pose && row.step == step && row.target == target; });
  };
  diagnosis::SystemInput input{campaign, effects.input->noise, 0.0, 0.0, effects.input->models, true, false, {}};
  const diagnosis::LinearSystem data = diagnosis::linearSystem(input, effects.fit.state, {});
  const diagnosis::GapPosture& posture = data.postures[2];
  ASSERT_GE(posture.states.size(), 3u);
  ASSERT_NE(readings(posture.pose, 0, 0), readings(posture.pose, 0, 1));
  for (int t = 0; t < 3; ++t) {
    const Eigen::Matrix3d rest = posture.noise.block<3, 3>(3 * t, 3 * t);
    EXPECT_LT((posture.noise_across.block<3, 3>(3 * t, 3 * t) - rest).norm(), 1e-9 * rest.norm());
    const Eigen::Matrix3d one = rest * static_cast<double>(readings(posture.pose, 0, t));
    for (std::size_t s = 1; s < posture.states.size(); ++s) {
      const Eigen::Index at = posture.position_rows + 9 * static_cast<Eigen::Index>(s - 1) + 3 * t;
      const Eigen::Matrix3d expected =
          rest + one / static_cast<double>(readings(posture.pose, posture.states[s].step, t));
      EXPECT_LT((posture.noise.block<3, 3>(at, 3 * t) - expected).norm(), 1e-9 * expected.norm()) << t << ", " << s;
    }
  }
}

/// "sd above" of the tables that say where a gap is: of noise alone it is a standard normal number, though the states
/// of a posture share their unloaded readings.
TEST(WhereDeflection, OfNoiseAloneIsAsOftenAboveAsANormalNumber) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(8));
  extended_model::EffectFit effects =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"bearing_tilt:3"}, campaign));
  const diagnosis::SystemInput& input = *effects.input;
  diagnosis::GapFit fit = effects.fit;
  const auto data = std::make_shared<diagnosis::LinearSystem>(diagnosis::linearSystem(input, fit.state, {}));
  fit.data = data;
  std::vector<Eigen::MatrixXd> roots;
  for (const diagnosis::GapPosture& posture : fit.data->postures) {
    ASSERT_GE(posture.states.size(), 3u);
    const Eigen::Index size = posture.right.size() - posture.position_rows, each = posture.noise.cols();
    Eigen::MatrixXd covariance(size, size);
    for (Eigen::Index row = 0; row < size; row += each) {
      for (Eigen::Index column = 0; column < size; column += each)
        covariance.block(row, column, each, each) =
            row == column ? posture.noise.middleRows(posture.position_rows + row, each) : posture.noise_across;
    }
    roots.emplace_back(covariance.llt().matrixL());
  }
  std::mt19937_64 random(17);
  std::normal_distribution<double> standard;
  std::map<std::string, std::vector<double>> deviates;
  constexpr int kDraws = 400;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(fit.data->layout.end);
  for (int draw = 0; draw < kDraws; ++draw) {
    for (std::size_t p = 0; p < roots.size(); ++p) {
      Eigen::VectorXd normal(roots[p].rows());
      for (double& x : normal) x = standard(random);
      data->postures[p].right.tail(normal.size()) = roots[p] * normal;
    }
    for (const diagnosis::WhereTable& table : diagnosis::whereDeflection(input, fit, none)) {
      for (const diagnosis::WhereRow& row : table.rows) {
        if (table.by == "reflector" || table.by == "joint") deviates[row.name].push_back(row.significance);
      }
    }
  }
  EXPECT_EQ(deviates.size(), 9u);
  for (const auto& [name, values] : deviates) {
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    // Of 400 draws the root of the mean square scatters by 3.5 %.
    EXPECT_NEAR(std::sqrt(squares / values.size()), 1.0, 0.13) << name;
  }
}

}  // namespace linear_system_test
}  // namespace stiffscope
