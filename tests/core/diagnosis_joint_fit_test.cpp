#include "core/diagnosis/joint_fit.h"

#include <gtest/gtest.h>

#include "core/diagnosis/gap_fit.h"
#include "tests/core/improved_day.h"

// The relinearised fit of a bilinear effect against Ceres on the nonlinear problem.

namespace stiffscope {
namespace {

EffectFit fitOf(const SimulationSpec& spec, const char* word) {
  const Campaign campaign = simulate(spec);
  return fitEffects(campaign, wantedEffects({word}, campaign));
}

/// Furthest of the correction from `expected`, in the standard uncertainties of the fit.
double furthest(const EffectFit& effects, const Eigen::Vector3d& found, const Eigen::Vector3d& expected) {
  const Eigen::VectorXd sd = effects.covariance.diagonal().cwiseSqrt();
  return (found - expected).cwiseQuotient(sd.head<3>()).cwiseAbs().maxCoeff();
}

TEST(JointFit, ComesBackFromAfarToWhereRelinearisingSettled) {
  SimulationSpec spec = springsAlone(8);
  spec.load_cell->place_error = {0.05, -0.03, 0.06};
  const EffectFit effects = fitOf(spec, "load_point_error");
  const GapFit& fit = effects.fit;
  ASSERT_EQ(effects.free.size(), 3u);
  const Eigen::Vector3d settled = fit.set.effects(effects.free);
  // Started from half the load point and springs a fifth too soft.
  FittedSet set = fit.set;
  set.effects *= 0.5;
  Eigen::VectorXd nuisances = fit.nuisances;
  nuisances.head<6>() *= 1.2;
  const auto found = fitJointly(*effects.input, fit.state, fit.data.layout, set, nuisances);
  ASSERT_TRUE(found);
  ASSERT_GT(furthest(effects, set.effects(effects.free), settled), 10.0) << "not far";
  EXPECT_LT(furthest(effects, found->state.corrections.load_point, settled), 0.1);
}

TEST(JointFit, SetsWithoutABilinearEffectAreLeftAlone) {
  SimulationSpec spec = springsAlone(8);
  spec.machine.joints[2].bearing = 4e6;
  const EffectFit effects = fitOf(spec, "bearing_tilt:3");
  const GapFit& fit = effects.fit;
  EXPECT_FALSE(fitJointly(*effects.input, fit.state, fit.data.layout, fit.set, fit.nuisances));
}

}  // namespace
}  // namespace stiffscope
