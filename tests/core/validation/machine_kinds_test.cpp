#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include "core/extended_model/extend_model.h"
#include "core/identification/estimate.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "core/validation/machine_kinds.h"

namespace stiffscope {

namespace fs = std::filesystem;
using validation::MachineKind;

namespace machine_kinds_test {

validation::MachineDraw drawn(MachineKind kind, std::uint64_t seed) {
  const fs::path folder = fs::temp_directory_path() / "stiffscope_machine_kinds" /
                          (std::string(validation::nameOf(kind)) + std::to_string(seed));
  fs::create_directories(folder);
  return validation::drawMachineOfKind(kind, seed, "case", folder / "robot.urdf");
}

struct Held {
  int intervals = 0, hold = 0;
};

/// Of clean days of that kind: whether the intervals that the supported model states hold the drawn springs. The
/// simulator minimises elastic energy and knows nothing of the identification's Jacobians.
Held heldOn(MachineKind kind, int joints, bool wrist_meets) {
  Held held;
  for (const std::uint64_t seed : {31, 32, 33}) {
    const validation::MachineDraw draw = drawn(kind, seed);
    EXPECT_EQ(draw.spec.machine.joints.size(), static_cast<std::size_t>(joints));
    const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(draw.spec));
    EXPECT_EQ(prepared.campaign.robot.joints(), joints);
    const extended_model::ExtendedModel model = extended_model::supportedModel(prepared, prepared.campaign, {});
    // Where the wrist's axes do not meet the day's loads decide.
    if (wrist_meets) EXPECT_TRUE(model.without.of(identification::Method::decoupled_partial_pose).available) << seed;
    for (const identification::Method which :
         {identification::Method::complete_pose, identification::Method::partial_pose}) {
      EXPECT_TRUE(model.with.of(which).available) << seed;
      const identification::StiffnessEstimate& found = model.with.of(which).estimate;
      EXPECT_EQ(found.joints(), joints);
      for (int j = 0; j < found.joints(); ++j) {
        if (!found.identifiable[static_cast<std::size_t>(j)]) continue;
        ++held.intervals;
        const double truth = 1.0 / *draw.spec.machine.joints[static_cast<std::size_t>(j)].torsion;
        if (identification::complianceInterval(found, j).holds(truth)) ++held.hold;
      }
    }
  }
  return held;
}

TEST(MachineKinds, AreNamed) {
  for (std::size_t k = 0; k < validation::kMachineKindNames.size(); ++k) {
    EXPECT_EQ(validation::machineKindOf(validation::kMachineKindNames[k]), static_cast<MachineKind>(k));
  }
  EXPECT_FALSE(validation::machineKindOf("scara"));
}

// Of the thirty to forty intervals four may miss; the two methods see the same noise.
TEST(MachineKinds, SevenAxesAreIdentified) {
  const Held held = heldOn(MachineKind::seven_axis, 7, true);
  EXPECT_GE(held.intervals, 36);
  EXPECT_GE(held.hold, held.intervals - 4);
}

TEST(MachineKinds, AnOffsetWristIsIdentified) {
  const Held held = heldOn(MachineKind::offset_wrist, 6, false);
  EXPECT_GE(held.intervals, 30);
  EXPECT_GE(held.hold, held.intervals - 4);
}

TEST(MachineKinds, FiveAxesAreIdentified) {
  const Held held = heldOn(MachineKind::palletiser, 5, true);
  EXPECT_GE(held.intervals, 24);
  EXPECT_GE(held.hold, held.intervals - 4);
}

TEST(MachineKinds, AParallelogramIsIdentified) {
  const Held held = heldOn(MachineKind::parallelogram, 6, true);
  EXPECT_GE(held.intervals, 30);
  EXPECT_GE(held.hold, held.intervals - 4);
}

// Joint 2 turns axis 2 and the rods': what their errors have in common is not known, so nothing is stated of links
// there.
TEST(MachineKinds, LinksBetweenAxesThatOneJointTurnsHaveNoUncertainty) {
  const validation::MachineDraw draw = drawn(MachineKind::parallelogram, 34);
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(draw.spec));
  const frames::Links links = identification::identify(prepared.campaign).frames.links;
  ASSERT_EQ(links.size(), 6u);
  for (std::size_t i = 0; i < links.size(); ++i) EXPECT_EQ(links[i].distance_sd.has_value(), i >= 3) << i;
}

TEST(MachineKinds, AnArmOnARailIsIdentified) {
  const Held held = heldOn(MachineKind::rail, 6, true);
  EXPECT_GE(held.intervals, 30);
  EXPECT_GE(held.hold, held.intervals - 4);
}

}  // namespace machine_kinds_test

}  // namespace stiffscope
