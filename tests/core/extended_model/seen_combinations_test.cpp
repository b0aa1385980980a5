#include "core/extended_model/hidden_effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/metrology/simulated_points.h"

namespace stiffscope {
namespace seen_combinations_test {

using extended_model::HiddenParameter;
using extended_model::SeenCombination;

identification::StiffnessEstimate estimateOf(const JointVector& compliance) {
  identification::StiffnessEstimate estimate(6);
  estimate.compliance = compliance;
  estimate.identifiable.assign(6, true);
  return estimate;
}

TEST(SeenCombinations, TheForearmsTwistIsNamedWithTheJointThatItHidesIn) {
  // Only c_4 + 0.8 theta = 3 is known, to 0.01; theta is fitted as 0.5 and free. Joint 2 depends on theta as little as
  // it scatters, joint 3 on both parameters alike.
  Noise noise(5);
  constexpr int kDraws = 4000;
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(6, kDraws), off(2, kDraws);
  for (int d = 0; d < kDraws; ++d) {
    const Eigen::Vector3d draw = noise.normal3();
    off(0, d) = 0.3 * draw.x(), off(1, d) = 0.3 * draw.y();
    moved(3, d) = -0.8 * off(0, d) + 0.01 * draw.z();
    moved(1, d) = -0.01 * off(0, d);
    moved(2, d) = off(0, d) + off(1, d);
  }
  JointVector compliance = JointVector::Ones(6);
  compliance[3] = 2.6;
  JointMatrix own = JointMatrix::Identity(6, 6) * 1e-4;
  const std::vector<HiddenParameter> parameters{{effects::Effect::link_compliance, "1/GJ of link 3", "1/Nm2", 0.5},
                                                {effects::Effect::link_compliance, "1/EI of link 3", "1/Nm2", 0.0}};
  const std::vector<SeenCombination> seen =
      extended_model::seenCombinations(parameters, moved, off, own, estimateOf(compliance));
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].joint, 3);
  EXPECT_EQ(seen[0].parameter.name, "1/GJ of link 3");
  // Slope by 4000 draws: 0.01 / 0.3 / sqrt(4000), three times that.
  EXPECT_NEAR(seen[0].ratio, 0.8, 2e-3);
  EXPECT_NEAR(seen[0].value, 3.0, 1e-3);
  EXPECT_NEAR(seen[0].sd, std::sqrt(2e-4), 0.05 * std::sqrt(2e-4));  // 0.01 of the draws, 0.01 of the rest
  // A joint that the loads do not turn has none.
  identification::StiffnessEstimate blind = estimateOf(compliance);
  blind.identifiable[3] = false;
  EXPECT_TRUE(extended_model::seenCombinations(parameters, moved, off, own, blind).empty());
  // Nor has one whose scatter is not known.
  own(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(extended_model::seenCombinations(parameters, moved, off, own, estimateOf(compliance)).empty());
}

}  // namespace seen_combinations_test
}  // namespace stiffscope
