#include "core/diagnosis/fit.h"

#include <gtest/gtest.h>
#include "core/diagnosis/geometry_columns.h"
#include "tests/fixtures/extended_day.h"

// The relinearised fit of a bilinear effect against Ceres on the nonlinear problem.

namespace stiffscope {
namespace joint_fit_test {

extended_model::EffectFit fitOf(const simulation::SimulationSpec& spec, const char* word) {
  const campaign::Campaign campaign = simulation::simulate(spec);
  return extended_model::fitEffects(campaign, extended_model::requestedEffects({word}, campaign));
}

/// Furthest of the correction from `expected`, in the standard uncertainties of the fit.
double furthest(const extended_model::EffectFit& effects, const Eigen::Vector3d& found,
                const Eigen::Vector3d& expected) {
  const Eigen::VectorXd sd = effects.covariance.diagonal().cwiseSqrt();
  return (found - expected).cwiseQuotient(sd.head<3>()).cwiseAbs().maxCoeff();
}

TEST(JointFit, ComesBackFromAfarToWhereRelinearisingSettled) {
  simulation::SimulationSpec spec = springsAlone(8);
  spec.load_cell->place_error = {0.05, -0.03, 0.06};
  const extended_model::EffectFit effects = fitOf(spec, "load_point_error");
  const diagnosis::GapFit& fit = effects.fit;
  ASSERT_EQ(effects.free.size(), 3u);
  const Eigen::Vector3d settled = fit.set.effects(effects.free);
  // Started from half the load point and springs a fifth too soft.
  diagnosis::FittedSet set = fit.set;
  set.effects *= 0.5;
  Eigen::VectorXd nuisances = fit.nuisances;
  nuisances.head<6>() *= 1.2;
  diagnosis::GeometryColumns by_geometry;
  const auto found = diagnosis::fitJointly(*effects.input, fit.state, fit.data->layout, set, nuisances, by_geometry);
  ASSERT_TRUE(found);
  ASSERT_GT(furthest(effects, set.effects(effects.free), settled), 10.0) << "not far";
  EXPECT_LT(furthest(effects, found->state.corrections.load_point, settled), 0.1);
}

TEST(JointFit, SetsWithoutABilinearEffectAreLeftAlone) {
  simulation::SimulationSpec spec = springsAlone(8);
  spec.machine.joints[2].bearing = 4e6;
  const extended_model::EffectFit effects = fitOf(spec, "bearing_tilt:3");
  const diagnosis::GapFit& fit = effects.fit;
  diagnosis::GeometryColumns by_geometry;
  EXPECT_FALSE(diagnosis::fitJointly(*effects.input, fit.state, fit.data->layout, fit.set, fit.nuisances, by_geometry));
}

}  // namespace joint_fit_test
}  // namespace stiffscope
