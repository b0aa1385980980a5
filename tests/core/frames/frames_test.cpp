#include "core/frames/frames.h"

#include <gtest/gtest.h>
#include "core/campaign/read_campaign.h"
#include "core/frames/base_frame.h"
#include "core/frames/remarks.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/simulated_lab.h"

namespace stiffscope {
namespace frames_test {

using Frame = Eigen::Isometry3d;

struct JointLine {
  Eigen::Vector3d point, direction;
};

JointLine jointLine(const ChainArm& arm, std::size_t joint) {
  const Frame frame = arm.framesAt(arm.noAngles())[joint];
  return {frame.translation(), frame.linear() * arm.axis[joint]};
}

/// Feet of the common perpendicular: p1 + s d1 + m (d1 x d2) = p2 + t d2, three equations for s, m, t.
std::pair<Eigen::Vector3d, Eigen::Vector3d> feet(const JointLine& a, const JointLine& b) {
  Eigen::Matrix3d columns;
  columns << a.direction, a.direction.cross(b.direction), -b.direction;
  const Eigen::Vector3d solution = columns.colPivHouseholderQr().solve(b.point - a.point);
  return {a.point + solution[0] * a.direction, b.point + solution[2] * b.direction};
}

double distanceToLine(const JointLine& line, const Eigen::Vector3d& point) {
  return (point - line.point).cross(line.direction).norm();
}

/// R0 of the actual arm in its base: z along axis 1 upwards, x towards the flange, which stands ahead along
/// +x.
Frame baseFromR0(const ChainArm& arm) {
  const JointLine one = jointLine(arm, 0), two = jointLine(arm, 1);
  Frame frame = Frame::Identity();
  const Eigen::Vector3d z = one.direction;
  const Eigen::Vector3d x = two.direction.cross(z).normalized();  // along +x where axis 2 is along +y
  frame.linear() << x, z.cross(x), z;
  frame.translation() = feet(one, two).first;
  return frame;
}

SimulatedLab labWithErrors() {
  SimulatedLab lab;
  Noise noise(31);
  lab.actual = lab.nominal.disturbed(noise, 1e-3, 1e-3);
  return lab;
}

TEST(MeasuredFrames, AnArmWithGeometryErrorsComesBack) {
  SimulatedLab lab = labWithErrors();
  lab.withoutMasses();
  // The tool sits on the actual flange; its wrist axes do not quite meet, so the wrist sweep is of an arm
  // whose do.
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  const frames::Frames frames = frames::measureFrames(campaign);
  constexpr double kExact = 1e-9;  // m and rad: rounding of 4 m by circle fits over 90 degrees, turned back five times

  ASSERT_TRUE(frames.arm.points_placed);
  const Frame base_from_r0 = baseFromR0(lab.actual);
  const Frame r0_from_tracker = (lab.tracker_from_base * base_from_r0).inverse();
  EXPECT_LT((frames.arm.r0_from_points.matrix() - r0_from_tracker.matrix()).norm(), kExact);

  for (std::size_t j = 0; j < 6; ++j) {
    ASSERT_TRUE(frames.axes[j].measured) << j << reports::words(frames.axes[j].reason);
    const JointLine truth = jointLine(lab.actual, j);
    const metrology::Line& found = frames.arm.arm.axes_in_base_at_zero[j];
    EXPECT_LT((found.direction - base_from_r0.linear().transpose() * truth.direction).norm(), kExact) << j;
    EXPECT_LT(distanceToLine(truth, base_from_r0 * found.point), kExact) << j;
  }
  for (std::size_t j = 0; j < 5; ++j) {
    const JointLine a = jointLine(lab.actual, j), b = jointLine(lab.actual, j + 1);
    const double angle = std::asin(std::min(1.0, a.direction.cross(b.direction).norm()));
    EXPECT_NEAR(frames.links[j].angle, angle, j == 1 ? kExact : 1e-6) << j;  // asin loses half the digits at 90 degrees
    if (j == 1) continue;                                                    // nearly parallel: below
    const auto [on_a, on_b] = feet(a, b);
    EXPECT_NEAR(frames.links[j].distance, (on_a - on_b).norm(), kExact) << j;
    EXPECT_FALSE(frames.links[j].near_parallel);
  }
  // Axes 2 and 3: across axis 2 at the foot on it of the perpendicular with axis 1.
  EXPECT_TRUE(frames.links[1].near_parallel);
  const JointLine two = jointLine(lab.actual, 1), three = jointLine(lab.actual, 2);
  const Eigen::Vector3d at = feet(jointLine(lab.actual, 0), two).second;
  const double along = two.direction.dot(at - three.point) / two.direction.dot(three.direction);
  EXPECT_NEAR(frames.links[1].distance, (three.point + along * three.direction - at).norm(), kExact);
  EXPECT_LT((base_from_r0 * frames.links[1].at_point_in_r0 - at).norm(), kExact);
  EXPECT_NEAR(frames.links[1].nominal_distance, 1.12, 1e-12);
  EXPECT_NEAR(frames.links[0].nominal_distance, 0.41, 1e-12);

  const auto at_zero = lab.actual.framesAt(JointVector::Zero(6));
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(frames.targets_in_r0_at_zero[k]);
    EXPECT_LT((base_from_r0 * *frames.targets_in_r0_at_zero[k] - at_zero[6] * lab.targets_in_flange[k]).norm(), kExact);
  }

  // P_TCP: the flange plane stands 0.3 m from axis 5 along axis 6, as it does nominally; joint 6 points back
  // at the arm.
  const JointLine five = jointLine(lab.actual, 4), six = jointLine(lab.actual, 5);
  const Eigen::Vector3d tcp = feet(five, six).second - 0.3 * six.direction;
  const Frame r0_from_flange = frames.arm.arm.base_from_flange_at_zero;
  EXPECT_LT((base_from_r0 * (r0_from_flange * frames.tcp_in_flange) - tcp).norm(), kExact);
  EXPECT_LT((base_from_r0.linear() * r0_from_flange.linear().col(2) + six.direction).norm(), kExact);
}

TEST(MeasuredFrames, WristCentreAndTableOne) {
  SimulatedLab lab;
  lab.withoutMasses();
  Noise noise(32);
  ChainArm disturbed = lab.nominal.disturbed(noise, 1e-3, 1e-3);
  for (std::size_t j = 0; j < 4; ++j) lab.actual.to_joint[j] = disturbed.to_joint[j];  // the wrist's axes still meet
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  lab.addWristSweep(campaign);
  const frames::Frames frames = frames::measureFrames(campaign);
  ASSERT_TRUE(frames.wrist.measured) << reports::words(frames.wrist.reason);
  const JointVector q = campaign.wrist_sweep->rows.front().q;
  const Frame base_from_r0 = baseFromR0(lab.actual);
  const Eigen::Vector3d centre = lab.actual.framesAt(q)[4].translation();  // joint 5's origin: on all three axes
  constexpr double kExact = 1e-9;
  EXPECT_LT((base_from_r0 * frames.wrist.centre_in_r0 - centre).norm(), kExact);
  EXPECT_LT((base_from_r0 * frames.wrist.nearest_last_axes_in_r0 - centre).norm(), kExact);
  EXPECT_LT(
      (base_from_r0 * frames.wrist.centre_at_zero_in_r0 - lab.actual.framesAt(JointVector::Zero(6))[4].translation())
          .norm(),
      kExact);
  ASSERT_EQ(frames.wrist.misses.size(), 2u);
  for (const frames::WristAxesMiss& miss : frames.wrist.misses) EXPECT_LT(miss.distance, kExact) << miss.first;
  EXPECT_EQ(frames.wrist.misses[0].first, 3);
  ASSERT_EQ(frames.wrist.table.size(), 3u);
  Eigen::Vector3d barycentre = Eigen::Vector3d::Zero();
  JointVector q_arm = q;
  q_arm.tail<3>().setZero();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT(frames.wrist.table[k].offset, kExact);
    EXPECT_EQ(frames.wrist.table[k].readings, 30);
    EXPECT_NEAR(frames.wrist.radii[k], (lab.actual.flangeAt(q) * lab.targets_in_flange[k] - centre).norm(), kExact);
    barycentre += lab.actual.flangeAt(q_arm) * lab.targets_in_flange[k] / 3.0;
  }
  EXPECT_LT((base_from_r0 * frames.wrist.reflector_barycentre_in_r0 - barycentre).norm(), kExact);
}

// The pose of the station that read the wrist's sweep moves all reflectors' spheres alike: it is in the mean of Table I
// as in the common centre.
TEST(MeasuredFrames, TheStationsPoseIsInTheMeanOfTableOne) {
  SimulatedLab lab;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  lab.addWristSweep(campaign);
  const frames::WristCentre alone = frames::measureFrames(campaign).wrist;
  campaign::StationPlace second{"B"};
  second.covariance.bottomRightCorner<3, 3>().diagonal() << 1e-9, 4e-9, 9e-9;
  campaign.stations = {{"A"}, second};
  for (campaign::WristReading& reading : campaign.wrist_sweep->rows) reading.station = 1;
  const frames::WristCentre read = frames::measureFrames(campaign).wrist;
  ASSERT_TRUE(alone.measured && read.measured);
  const Eigen::Matrix3d of_centre = read.covariance - alone.covariance;
  EXPECT_NEAR(of_centre.trace(), 14e-9, 1e-12);
  EXPECT_LT((read.table_mean_covariance - alone.table_mean_covariance - of_centre).norm(), 1e-12);
}

TEST(MeasuredFrames, ArmsOfFiveAndSevenJointsComeBack) {
  for (const ChainArm& chain : {fiveAxisChain(), sevenAxisChain()}) {
    SCOPED_TRACE(chain.joints());
    SimulatedLab lab(chain);
    lab.withoutMasses();
    Noise noise(33);
    const ChainArm disturbed = lab.nominal.disturbed(noise, 1e-3, 1e-3);
    // The wrist's axes still meet: its later frames stay where they are, each on the axis before it.
    const auto joints = static_cast<std::size_t>(chain.joints());
    const auto wrist = static_cast<std::size_t>(robot::wristJointsOf(chain.joints()));
    for (std::size_t j = 0; j <= joints - wrist; ++j) lab.actual.to_joint[j] = disturbed.to_joint[j];
    campaign::Campaign campaign = lab.empty();
    lab.addCircleSweeps(campaign);
    lab.addWristSweep(campaign);
    const frames::Frames frames = frames::measureFrames(campaign);
    constexpr double kExact = 1e-9;  // as above
    ASSERT_TRUE(frames.arm.points_placed);
    const Frame base_from_r0 = baseFromR0(lab.actual);
    const Frame r0_from_tracker = (lab.tracker_from_base * base_from_r0).inverse();
    EXPECT_LT((frames.arm.r0_from_points.matrix() - r0_from_tracker.matrix()).norm(), kExact);
    ASSERT_EQ(frames.axes.size(), joints);
    for (std::size_t j = 0; j < joints; ++j) {
      ASSERT_TRUE(frames.axes[j].measured) << j << reports::words(frames.axes[j].reason);
      const JointLine truth = jointLine(lab.actual, j);
      const metrology::Line& found = frames.arm.arm.axes_in_base_at_zero[j];
      EXPECT_LT((found.direction - base_from_r0.linear().transpose() * truth.direction).norm(), kExact) << j;
      EXPECT_LT(distanceToLine(truth, base_from_r0 * found.point), kExact) << j;
    }
    ASSERT_EQ(frames.links.size(), joints - 1);
    for (std::size_t j = 0; j + 1 < joints; ++j) {
      if (frames.links[j].near_parallel) continue;
      const auto [on_a, on_b] = feet(jointLine(lab.actual, j), jointLine(lab.actual, j + 1));
      EXPECT_NEAR(frames.links[j].distance, (on_a - on_b).norm(), kExact) << j;
    }
    const Frame flange = lab.actual.flangeAt(lab.actual.noAngles());
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((base_from_r0 * *frames.targets_in_r0_at_zero[k] - flange * lab.targets_in_flange[k]).norm(), kExact);

    ASSERT_TRUE(frames.wrist.measured) << reports::words(frames.wrist.reason);
    const JointVector q = campaign.wrist_sweep->rows.front().q;
    const Eigen::Vector3d centre = lab.actual.framesAt(q)[joints - 2].translation();  // of the last joint but one
    EXPECT_LT((base_from_r0 * frames.wrist.centre_in_r0 - centre).norm(), kExact);
    ASSERT_EQ(frames.wrist.misses.size(), wrist - 1);
    EXPECT_EQ(frames.wrist.misses.front().first, static_cast<int>(joints - wrist));
    for (const frames::WristAxesMiss& miss : frames.wrist.misses) EXPECT_LT(miss.distance, kExact);
  }
}

TEST(MeasuredFrames, OwnWeightIsTakenOffByTheRightCompliance) {
  SimulatedLab lab = labWithErrors();
  lab.compliance = exampleCompliance();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  lab.addWristSweep(campaign);
  const Frame base_from_r0 = baseFromR0(lab.actual);
  const Frame r0_from_tracker = (lab.tracker_from_base * base_from_r0).inverse();
  const auto error = [&](const frames::Frames& frames) {
    double worst = (frames.arm.r0_from_points.matrix() - r0_from_tracker.matrix()).cwiseAbs().maxCoeff();
    for (std::size_t j = 0; j < 6; ++j) {
      worst = std::max(
          worst, distanceToLine(jointLine(lab.actual, j), base_from_r0 * frames.arm.arm.axes_in_base_at_zero[j].point));
    }
    const auto at_zero = lab.actual.framesAt(JointVector::Zero(6));
    for (std::size_t k = 0; k < 3; ++k) {
      worst = std::max(
          worst, (base_from_r0 * *frames.targets_in_r0_at_zero[k] - at_zero[6] * lab.targets_in_flange[k]).norm());
    }
    return worst;
  };
  frames::Frames frames = frames::measureFrames(campaign);
  EXPECT_FALSE(frames.sag_removed);
  const double with_sag = error(frames);
  EXPECT_GT(with_sag, 1e-3);  // a ton of arm on springs of 3e6 Nm/rad sags by millimetres
  frames = frames::refineFrames(campaign, frames, lab.compliance);
  EXPECT_TRUE(frames.sag_removed);
  EXPECT_LT(error(frames),
            with_sag / 100.0);  // the sag is that of the arm known to some millimetres in metres
  for (int round = 0; round < 3; ++round) frames = frames::refineFrames(campaign, frames, lab.compliance);
  // Masses keep their place in base_link, and gravity its direction, though the arm's links are a millimetre
  // and a milliradian elsewhere: a thousandth or two each of 5 mm is left.
  EXPECT_LT(error(frames), 3e-5);
}

/// Arms whose joints turn under their own weight by some milliradians, of which nobody knows: 95 % of the distances lie
/// within twice their standard uncertainties. Where the stiffnesses are stated, the sag is off.
TEST(MeasuredFrames, SweepsAloneHaveTheSagInTheirUncertainty) {
  constexpr int kArms = 20;
  Noise noise(61);
  int inside = 0, all = 0;
  for (int k = 0; k < kArms; ++k) {
    SimulatedLab lab = labWithErrors();
    campaign::Campaign campaign = lab.empty();
    lab.addCircleSweeps(campaign);
    const frames::Frames rigid = frames::measureFrames(campaign);
    JointVector torque = JointVector::Zero(6);
    for (const campaign::CircleReading& reading : campaign.circle_sweeps->rows) {
      const robot::ArmPosture posture = robot::postureAt(rigid.arm.arm, reading.q);
      torque = torque.cwiseMax(robot::weightTorque(rigid.arm.arm, posture, rigid.weight).cwiseAbs());
    }
    lab.compliance = JointVector::Zero(6);
    for (int joint = 1; joint < 6; ++joint)
      lab.compliance[joint] = frames::kTurnByOwnWeight * std::abs(noise.normal()) / torque[joint];
    campaign = lab.empty();
    lab.addCircleSweeps(campaign);
    const frames::Frames read = frames::measureFrames(campaign);
    const frames::Frames frames = frames::refineByKnownStiffness(campaign, read);
    EXPECT_FALSE(frames.sag_removed);
    EXPECT_TRUE(frames.sag_in_uncertainty);
    double worst_read = 0.0, worst_known = 0.0;
    for (int joint = 1; joint < 6; ++joint)
      campaign.known_stiffness.push_back({joint, 1.0 / lab.compliance[joint], 0.01 / lab.compliance[joint], "maker"});
    const frames::Frames known = frames::refineByKnownStiffness(campaign, read);
    EXPECT_TRUE(known.sag_removed);
    for (std::size_t i = 0; i < frames.links.size(); ++i) {
      const double is = rigid.links[i].distance, off = std::abs(frames.links[i].distance - is);
      inside += off <= 1.96 * *frames.links[i].distance_sd ? 1 : 0;
      ++all;
      worst_read = std::max(worst_read, std::abs(read.links[i].distance - is));
      worst_known = std::max(worst_known, std::abs(known.links[i].distance - is));
    }
    EXPECT_LT(worst_known, 0.05 * worst_read);
  }
  EXPECT_GE(inside, (9 * all) / 10) << all;
}

TEST(MeasuredFrames, WithTheNominalArmTheSagGoesCompletely) {
  SimulatedLab lab;
  lab.compliance = exampleCompliance();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  frames::Frames frames = frames::measureFrames(campaign);
  for (int round = 0; round < 4; ++round) frames = frames::refineFrames(campaign, frames, lab.compliance);
  const Frame r0_from_tracker = (lab.tracker_from_base * baseFromR0(lab.actual)).inverse();
  // Base leans 0.02 rad in the tracker's frame, not in gravity's: nothing else is unknown. Three sag steps
  // leave 1e-9 rad.
  EXPECT_LT((frames.arm.r0_from_points.matrix() - r0_from_tracker.matrix()).norm(), 2e-8);
}

TEST(MeasuredFrames, AnAxisTurnedBackThroughOneThatIsMissingIsNotMeasured) {
  SimulatedLab lab;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  std::erase_if(campaign.circle_sweeps->rows, [](const campaign::CircleReading& reading) { return reading.axis == 0; });
  const frames::Frames frames = frames::measureFrames(campaign);
  EXPECT_FALSE(frames.arm.points_placed);
  EXPECT_FALSE(frames.axes[0].measured);
  EXPECT_FALSE(frames.axes[1].measured);
  EXPECT_TRUE(frames.axes[1].reason.is(frames::RemarkId::earlier_axis_not_known))
      << reports::words(frames.axes[1].reason);
}

TEST(MeasuredFrames, AWristSweepInAnotherFrameIsNotMixedIn) {
  // Circle sweeps by the tracker, a wrist sweep written in base_link: R0 is only known in the former.
  SimulatedLab lab;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  const frames::Frames alone = frames::measureFrames(campaign);
  lab.addWristSweep(campaign);
  campaign.wrist_sweep->frame = campaign::PointFrame::base_link;
  for (campaign::WristReading& reading : campaign.wrist_sweep->rows) {
    reading.point = lab.tracker_from_base.inverse() * reading.point;
  }
  const frames::Frames frames = frames::measureFrames(campaign);
  EXPECT_FALSE(frames.wrist.measured);
  EXPECT_TRUE(frames.wrist.reason.is(frames::RemarkId::wrist_sweep_in_other_frame))
      << reports::words(frames.wrist.reason);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(*frames.targets_in_r0_at_zero[k], *alone.targets_in_r0_at_zero[k]);
}

TEST(MeasuredFrames, OtherJointsMovingIsSeen) {
  SimulatedLab lab;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  for (campaign::CircleReading& reading : campaign.circle_sweeps->rows) {
    if (reading.axis == 3 && reading.index == "4") reading.q[1] += 1e-3;
  }
  const frames::Frames frames = frames::measureFrames(campaign);
  EXPECT_FALSE(frames.axes[3].measured);
  EXPECT_TRUE(frames.axes[3].reason.is(frames::RemarkId::other_joints_moved));
}

// R0's rule (campaign format, Frames), on arms whose answer is seen on a sketch.

Frame ruleOf(const ChainArm& arm) { return frames::nominalBaseFrame(arm.robot()).base_link_from_r0; }

TEST(R0, OfTheExampleArm) {
  const Frame r0 = ruleOf(exampleChain());
  EXPECT_LT((r0.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((r0.translation() - Eigen::Vector3d(0, 0, 0.94)).norm(), 1e-12);
}

TEST(R0, AxisOnePointingDown) {
  ChainArm arm = exampleChain();
  arm.axis[0] = -arm.axis[0];  // the joint turns the other way: R0 does not care
  EXPECT_LT((ruleOf(arm).matrix() - ruleOf(exampleChain()).matrix()).norm(), 1e-12);
  EXPECT_EQ(frames::nominalBaseFrame(arm.robot()).sense[0], -1.0);
}

TEST(R0, AxisTwoTurningTheOtherWay) {
  ChainArm arm = exampleChain();
  arm.axis[1] = -arm.axis[1];  // x0 towards the flange still makes y0 the same
  EXPECT_LT((ruleOf(arm).matrix() - ruleOf(exampleChain()).matrix()).norm(), 1e-12);
  EXPECT_EQ(frames::nominalBaseFrame(arm.robot()).sense[1], -1.0);
}

TEST(R0, AFlangeWithin50MillimetresOfAxisOne) {
  // The whole arm upright: axis 2 is along y, the flange stands behind axis 1, by 49 mm, then by 51.
  ChainArm arm = exampleChain();
  const double ahead = arm.flangeAt(JointVector::Zero(6)).translation().x();
  arm.to_joint[5].translation().x() -= ahead + 0.049;
  ASSERT_NEAR(arm.flangeAt(JointVector::Zero(6)).translation().x(), -0.049, 1e-12);
  EXPECT_GT(ruleOf(arm).linear()(1, 1), 0.999);  // in the sense of positive axis 2
  arm.to_joint[5].translation().x() -= 0.002;
  EXPECT_LT(ruleOf(arm).linear()(1, 1), -0.999);  // x0 towards the flange, behind: y0 turned round
  arm.to_joint[5].translation().x() += 0.002;
  arm.axis[1] = -arm.axis[1];
  EXPECT_LT(ruleOf(arm).linear()(1, 1), -0.999);  // near again, and axis 2 turns about -y
}

TEST(R0, RulesHoldForMeasuredAxes) {
  // A joint 1 that turns about a downward axis, swept: R0 is that of the same arm turning upwards.
  SimulatedLab up, down;
  up.withoutMasses(), down.withoutMasses();
  down.nominal.axis[0] = down.actual.axis[0] = -Eigen::Vector3d::UnitZ();
  Frame found[2];
  for (SimulatedLab* lab : {&up, &down}) {
    campaign::Campaign campaign = lab->empty();
    lab->addCircleSweeps(campaign);
    found[lab == &down] = frames::measureFrames(campaign).arm.r0_from_points;
  }
  EXPECT_LT((found[0].matrix() - found[1].matrix()).norm(), 1e-9);
}

TEST(MeasuredFrames, AnOffsetWristHasNoCentre) {
  campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  campaign.circle_sweeps.reset();
  campaign.wrist_sweep.reset();
  EXPECT_FALSE(frames::measureFrames(campaign).wrist.offset());
  // Axis 6 along axis 5: both still meet, and not where 4 and 5 do.
  auto& axes = campaign.robot.axes_in_base_at_zero;
  axes[5].point += 0.1 * axes[4].direction;
  const frames::WristCentre wrist = frames::measureFrames(campaign).wrist;
  for (const frames::WristAxesMiss& miss : wrist.misses) EXPECT_LT(miss.distance, 1e-9);
  EXPECT_TRUE(wrist.offset());
  EXPECT_NEAR(wrist.apart, 0.1, 1e-9);
}

TEST(MeasuredFrames, ALastAxisAlongTheFlangePlanePiercesItNowhere) {
  campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  const Frame flange = campaign.robot.base_from_flange_at_zero;
  for (const double turned : {60.0, 85.0, 90.0}) {
    Frame bracket = Frame::Identity();
    bracket.linear() = Eigen::AngleAxisd(turned * io::kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
    bracket.translation() = Eigen::Vector3d(0.0, 0.1, 0.05);
    campaign.robot.base_from_flange_at_zero = flange * bracket;
    const frames::Frames frames = frames::measureFrames(campaign);
    EXPECT_EQ(frames.tcp_at_origin, turned > 80.0) << turned;
    EXPECT_LT(frames.tcp_in_flange.norm(), 0.3) << turned;
    if (frames.tcp_at_origin) EXPECT_TRUE(frames.tcp_in_flange.isZero(0.0)) << turned;
  }
}

TEST(RealSweeps, LinkLengths) {
  const auto folder = std::filesystem::path(STIFFSCOPE_SHARED_DIR) / "real" / "fanuc-r2000ic-sweeps";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the real sweeps are not beside the checkout";
  const frames::Frames frames = frames::measureFrames(campaign::readCampaign(folder).campaign);
  // Real machine, 36 stops: the maker's 312 and 1075 mm, and what three programs make of the readings, within
  // 0.3 mm.
  EXPECT_NEAR(1e3 * frames.links[0].distance, 311.4, 0.3);
  EXPECT_NEAR(1e3 * frames.links[1].distance, 1075.6, 0.3);
  EXPECT_TRUE(frames.links[1].near_parallel);
  for (const frames::LinkGeometry& link : frames.links) {
    ASSERT_TRUE(link.distance_sd && link.angle_sd);
    EXPECT_GT(*link.distance_sd, 0.0);
    EXPECT_GT(*link.angle_sd, 0.0);
    EXPECT_LT(*link.distance_sd, 1e-3);  // m
    EXPECT_LT(*link.angle_sd, 2e-3);     // rad
  }
}

}  // namespace frames_test
}  // namespace stiffscope
