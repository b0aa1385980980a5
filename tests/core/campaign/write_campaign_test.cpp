#include "core/campaign/write_campaign.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include "core/campaign/read_campaign.h"
#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace write_campaign_test {

// Half of the last decimal written: 0.0001 mm, 0.00001 deg, 0.001 N, 0.0001 Nm, and the rounding of doubles.
constexpr double kPoint = 0.5001e-7;
constexpr double kAngle = 0.5001e-5 * 3.14159265358979 / 180.0;
constexpr double kForce = 0.5001e-3;
constexpr double kMoment = 0.5001e-4;
// Twelve digits of values below one.
constexpr double kAttribute = 1e-11;

template <class Row, class Compare>
void expectSameRows(const std::optional<campaign::Table<Row>>& a, const std::optional<campaign::Table<Row>>& b,
                    Compare compare) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->frame, b->frame);
  ASSERT_EQ(a->rows.size(), b->rows.size());
  for (std::size_t i = 0; i < a->rows.size(); ++i) compare(a->rows[i], b->rows[i]);
}

void expectClose(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance);
}

void expectSameTables(const campaign::Campaign& a, const campaign::Campaign& b) {
  const auto sameSweep = [](const auto& x, const auto& y) {
    EXPECT_EQ(std::pair(x.index, x.target), std::pair(y.index, y.target));
    EXPECT_EQ(std::isnan(x.time_s), std::isnan(y.time_s));
    expectClose(x.q, y.q, kAngle);
    expectClose(x.point, y.point, kPoint);
  };
  expectSameRows(a.circle_sweeps, b.circle_sweeps,
                 [&](const campaign::CircleReading& x, const campaign::CircleReading& y) {
                   EXPECT_EQ(x.axis, y.axis);
                   sameSweep(x, y);
                 });
  expectSameRows(a.wrist_sweep, b.wrist_sweep, sameSweep);
  EXPECT_EQ(a.repeat_ids, b.repeat_ids);
  expectSameRows(a.loading, b.loading, [](const campaign::LoadingReading& x, const campaign::LoadingReading& y) {
    EXPECT_EQ(std::tuple(x.pose, x.step, x.repeat, x.target), std::tuple(y.pose, y.step, y.repeat, y.target));
    EXPECT_NEAR(x.time_s, y.time_s, 0.05001);
    expectClose(x.point, y.point, kPoint);
  });
  expectSameRows(a.states, b.states, [](const campaign::State& x, const campaign::State& y) {
    EXPECT_EQ(std::pair(x.pose, x.step), std::pair(y.pose, y.step));
    expectClose(x.q, y.q, kAngle);
    expectClose(x.wrench_in_cell.head<3>(), y.wrench_in_cell.head<3>(), kForce);
    expectClose(x.wrench_in_cell.tail<3>(), y.wrench_in_cell.tail<3>(), kMoment);
  });
  expectSameRows(a.displacements, b.displacements,
                 [](const campaign::Displacement& x, const campaign::Displacement& y) {
                   EXPECT_EQ(std::tuple(x.pose, x.step, x.target), std::tuple(y.pose, y.step, y.target));
                   expectClose(x.displacement, y.displacement, kPoint);
                 });
  expectSameRows(a.nests, b.nests, [](const campaign::NestReading& x, const campaign::NestReading& y) {
    EXPECT_EQ(x.nest, y.nest);
    expectClose(x.point, y.point, kPoint);
  });
}

void expectSameBalancers(const std::vector<robot::Balancer>& a, const std::vector<robot::Balancer>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::tie(a[i].from.body, a[i].to.body), std::tie(b[i].from.body, b[i].to.body));
    expectClose(a[i].from.in_base_at_zero, b[i].from.in_base_at_zero, kAttribute);
    expectClose(a[i].to.in_base_at_zero, b[i].to.in_base_at_zero, kAttribute);
    EXPECT_NEAR(a[i].shortest_m.value_or(0), b[i].shortest_m.value_or(0), kAttribute);
    EXPECT_NEAR(a[i].longest_m.value_or(0), b[i].longest_m.value_or(0), kAttribute);
    ASSERT_EQ(a[i].law.index(), b[i].law.index());
    if (const auto* spring = std::get_if<robot::SpringLaw>(&a[i].law)) {
      const auto& other = std::get<robot::SpringLaw>(b[i].law);
      EXPECT_NEAR(spring->rate_n_per_m, other.rate_n_per_m, kAttribute * spring->rate_n_per_m);
      EXPECT_NEAR(spring->tension_n, other.tension_n, kAttribute * std::abs(spring->tension_n));
      EXPECT_NEAR(spring->length_m, other.length_m, kAttribute);
      continue;
    }
    const auto &gas = std::get<robot::GasLaw>(a[i].law), &other = std::get<robot::GasLaw>(b[i].law);
    EXPECT_NEAR(gas.pressure_pa, other.pressure_pa, kAttribute * gas.pressure_pa);
    EXPECT_NEAR(gas.area_m2, other.area_m2, kAttribute * gas.area_m2);
    EXPECT_NEAR(gas.volume_m3, other.volume_m3, kAttribute * gas.volume_m3);
    EXPECT_NEAR(gas.length_m, other.length_m, kAttribute);
    EXPECT_EQ(std::tie(gas.exponent, gas.pushes), std::tie(other.exponent, other.pushes));
  }
}

void expectSame(const campaign::Campaign& a, const campaign::Campaign& b) {
  EXPECT_EQ(std::tie(a.name, a.date, a.base_link, a.flange_link, a.pose_ids, a.nest_ids),
            std::tie(b.name, b.date, b.base_link, b.flange_link, b.pose_ids, b.nest_ids));
  EXPECT_EQ(a.texts.laboratory, b.texts.laboratory);
  EXPECT_EQ(a.texts.operator_name, b.texts.operator_name);
  EXPECT_EQ(a.double_encoder, b.double_encoder);
  EXPECT_EQ(a.double_encoder_joints, b.double_encoder_joints);
  EXPECT_EQ(a.gravity_in_base, b.gravity_in_base);
  ASSERT_EQ(a.tracker.has_value(), b.tracker.has_value());
  if (a.tracker) {
    EXPECT_EQ(a.tracker->model, b.tracker->model);
    EXPECT_NEAR(a.tracker->range_fixed, b.tracker->range_fixed, kAttribute * 1e-6);
    EXPECT_NEAR(a.tracker->angle_per_m, b.tracker->angle_per_m, kAttribute * 1e-6);
    expectClose(a.tracker->station, b.tracker->station, kAttribute);
  }
  ASSERT_EQ(a.targets.size(), b.targets.size());
  for (std::size_t i = 0; i < a.targets.size(); ++i) {
    EXPECT_EQ(a.targets[i].id, b.targets[i].id);
    ASSERT_EQ(a.targets[i].position_in_flange.has_value(), b.targets[i].position_in_flange.has_value());
    if (!a.targets[i].position_in_flange) continue;
    expectClose(*a.targets[i].position_in_flange, *b.targets[i].position_in_flange, kAttribute);
  }
  ASSERT_EQ(a.load_cell.has_value(), b.load_cell.has_value());
  if (a.load_cell) {
    EXPECT_EQ(a.load_cell->parent, b.load_cell->parent);
    EXPECT_EQ(a.load_cell->axes_link, b.load_cell->axes_link);
    EXPECT_TRUE(a.load_cell->parent_from_cell.isApprox(b.load_cell->parent_from_cell, kAttribute));
    EXPECT_EQ(a.load_cell->force_sigma, b.load_cell->force_sigma);
  }
  ASSERT_EQ(a.tool.has_value(), b.tool.has_value());
  if (a.tool) expectClose(a.tool->com_in_flange, b.tool->com_in_flange, kAttribute);
  ASSERT_EQ(a.known_stiffness.size(), b.known_stiffness.size());
  for (std::size_t i = 0; i < a.known_stiffness.size(); ++i) {
    EXPECT_EQ(std::tie(a.known_stiffness[i].joint, a.known_stiffness[i].source),
              std::tie(b.known_stiffness[i].joint, b.known_stiffness[i].source));
    EXPECT_EQ(a.known_stiffness[i].stiffness, b.known_stiffness[i].stiffness);
    EXPECT_EQ(a.known_stiffness[i].sd, b.known_stiffness[i].sd);
  }
  expectSameBalancers(a.robot.balancers, b.robot.balancers);
  expectSameTables(a, b);
}

void expectRoundTrip(const campaign::Campaign& campaign, const std::filesystem::path& urdf) {
  const TemporaryFolder first, second;
  campaign::writeCampaign(campaign, urdf, first.path() / "new" / "folder");
  const campaign::CampaignReading reading = campaign::readCampaign(first.path() / "new" / "folder");
  EXPECT_TRUE(reading.warnings.empty());
  expectSame(campaign, reading.campaign);
  // What was rounded once stays as it is: writing again gives the same bytes.
  campaign::writeCampaign(reading.campaign, first.path() / "new" / "folder" / "robot.urdf", second.path());
  const auto again = campaign::readCampaign(second.path()).campaign.inputs;
  ASSERT_EQ(reading.campaign.inputs.size(), again.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(reading.campaign.inputs[i].name, again[i].name);
    EXPECT_EQ(reading.campaign.inputs[i].sha256, again[i].sha256) << again[i].name;
  }
}

TEST(WriteCampaign, ReadsBackAsItWas) {
  const SmallCampaign files;
  expectRoundTrip(campaign::readCampaign(files.folder()).campaign, files.folder() / "robot.urdf");
}

TEST(WriteCampaign, ReadsBackBalancersAsTheyWere) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.robot.balancers = {
      {robot::SpringLaw{41234.5, -6789.0, 0.8125}, {1, {-0.31, 0.05, 0.52}}, {2, {0.32, 0.11, 1.23}}, 0.05, 4.5},
      {robot::GasLaw{143.5e5, 17.3e-4, 16.1e-3, 0.912, 1.25, true},
       {2, {0.3, 0.1, 1.2}},
       {0, {-0.4, 0.1, 0.3}},
       {},
       {}}};
  expectRoundTrip(campaign, files.folder() / "robot.urdf");
}

TEST(WriteCampaign, ReadsBackSevenJointsAsTheyWere) {
  const SmallCampaign files(7);
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  ASSERT_EQ(campaign.robot.joints(), 7);
  expectRoundTrip(campaign, files.folder() / "robot.urdf");
  campaign.known_stiffness = {{6, 1e4, 2e2, "maker"}};
  campaign.joint_readings = {{6, -1.0, 0.5, 5}};
  campaign.states->rows[0].extras().commanded = campaign.states->rows[0].q;
  campaign.states->rows[1].extras().motor_side[6] = campaign.states->rows[1].q[6] + 0.001;
  expectRoundTrip(campaign, files.folder() / "robot.urdf");

  const TemporaryFolder folder;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path());
  const campaign::Campaign read = campaign::readCampaign(folder.path()).campaign;
  ASSERT_EQ(read.joint_readings.size(), 1u);
  EXPECT_EQ(read.joint_readings[0].joint, 6);
  EXPECT_NEAR(read.states->rows[0].extras().commanded[6], campaign.states->rows[0].q[6],
              2 * kAngle);  // two figures are rounded
  EXPECT_NEAR(read.states->rows[1].extras().motor_side[6], campaign.states->rows[1].extras().motor_side[6], 2 * kAngle);
  EXPECT_TRUE(std::isnan(read.states->rows[1].extras().motor_side[5]) &&
              std::isnan(read.states->rows[0].extras().motor_side[6]));
  std::ifstream states(folder.path() / "states.csv");
  std::string header;
  std::getline(states, header);
  EXPECT_TRUE(header.starts_with("pose,step,time_s,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,q7_deg,fx_n,")) << header;
  EXPECT_NE(header.find(",c7_deg"), std::string::npos) << header;
  EXPECT_NE(header.find("m7_deg"), std::string::npos) << header;
}

TEST(WriteCampaign, KeepsTheDigitsThatWereRead) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.loading->rows[0].point = {2.296337348, -2.416230526, -0.4425};
  const TemporaryFolder folder;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path() / "read", {},
                          campaign::WrittenDigits::as_read);
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path() / "format");
  const std::string read = io::readTextFile(folder.path() / "read" / "loading.csv", 1 << 20),
                    format = io::readTextFile(folder.path() / "format" / "loading.csv", 1 << 20);
  EXPECT_NE(read.find("2296.337348,-2416.230526,-442.5000\n"), std::string::npos) << read;
  EXPECT_NE(format.find("2296.3373,-2416.2305,-442.5000\n"), std::string::npos) << format;
}

TEST(WriteCampaign, WritesNamesAndTextsThatNeedCare) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.name = "a <b> & \"c\"";
  campaign.known_stiffness = {{0, 5.6e6, 2e5, "maker <a> & \"b\""}};
  campaign.texts.laboratory = "M\xC3\xBCller & S\xC3\xB6hne <lab>";
  campaign.targets[0].id = "P,10 \"left\"";
  campaign.pose_ids[0] = "pose, 1; A";
  campaign.gravity_in_base = {0, 9.8, 0};
  campaign.tracker->station = {1.5, -2.25, 0.0000001};
  campaign.load_cell->axes_link = "base";
  campaign.load_cell->parent_from_cell.linear().setIdentity();
  campaign.nests->frame = campaign::PointFrame::base_link;
  campaign.nests->rows[0].point.x() = -1e-12;
  expectRoundTrip(campaign, files.folder() / "robot.urdf");
}

TEST(WriteCampaign, WritesTheControllersFiguresAgain) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.joint_readings = {{2, -1.0, 1.5, 1}, {4, 1.0, -0.5, -1}};
  campaign.controller_model = campaign::ControllerModel::nominal;
  campaign.states->rows[0].extras().commanded = campaign.states->rows[0].q;
  expectRoundTrip(campaign, files.folder() / "robot.urdf");
  const TemporaryFolder folder;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path() / "new");
  const campaign::Campaign read = campaign::readCampaign(folder.path() / "new").campaign;
  ASSERT_EQ(read.joint_readings.size(), 2u);
  EXPECT_EQ(read.joint_readings[0].plus, 1);
  EXPECT_EQ(read.controller_model, campaign::ControllerModel::nominal);
  expectClose(read.states->rows[0].extras().commanded, campaign.states->rows[0].q,
              kAngle * 3);  // three figures are rounded
}

TEST(WriteCampaign, WritesRepeatsByTheirNames) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.repeat_ids = {"second", "02"};
  std::vector<campaign::LoadingReading>& rows = campaign.loading->rows;
  ASSERT_GE(rows.size(), 3u);
  rows[0].repeat = 7;
  rows[1].repeat = campaign::repeatByName(0);
  rows[2].repeat = campaign::repeatByName(1);
  const TemporaryFolder folder;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path() / "new");
  const campaign::Campaign read = campaign::readCampaign(folder.path() / "new").campaign;
  EXPECT_EQ(read.repeat_ids, campaign.repeat_ids);
  expectSameTables(read, campaign);
  // None is named where a row names none.
  rows.resize(1);
  rows[0].repeat = campaign::kNoRepeat;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path() / "none");
  EXPECT_EQ(campaign::readCampaign(folder.path() / "none").campaign.loading->rows[0].repeat, campaign::kNoRepeat);
}

TEST(WriteCampaign, SecondEncodersAreWrittenWhereTheyAreAndBlankWhereNot) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  const double motor = campaign.states->rows[0].q[2] + 0.001;
  campaign.states->rows[0].extras().motor_side[2] = motor;
  campaign.states->rows[1].extras().commanded[5] = -1.5;
  campaign.states->rows[1].extras().temperature_c = 21.25;
  const TemporaryFolder folder;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", folder.path() / "new");
  const campaign::CampaignReading reading = campaign::readCampaign(folder.path() / "new");
  EXPECT_TRUE(reading.warnings.empty());
  const std::vector<campaign::State>& rows = reading.campaign.states->rows;
  EXPECT_NEAR(rows[0].extras().motor_side[2], motor, kAngle);
  EXPECT_TRUE(std::isnan(rows[0].extras().commanded[5]) && std::isnan(rows[0].extras().temperature_c));
  EXPECT_NEAR(rows[1].extras().commanded[5], -1.5, kAngle);
  EXPECT_EQ(rows[1].extras().temperature_c, 21.25);
  EXPECT_TRUE(std::isnan(rows[1].extras().motor_side[2]) && std::isnan(rows[0].extras().motor_side[0]));
  expectRoundTrip(reading.campaign, files.folder() / "robot.urdf");
}

TEST(WriteCampaign, KeepsWhatIsDeclaredUncertain) {
  const SmallCampaign files;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.mass_sigma = 0.03;
  campaign.tracker->scale_sigma = 2e-6;
  campaign.load_cell->gain_sigma = 0.005;
  campaign.load_cell->angle_sigma = 0.004;
  campaign.load_cell->point_sigma = 0.0015;
  const TemporaryFolder out;
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", out.path());
  const campaign::CampaignReading reading = campaign::readCampaign(out.path());
  EXPECT_TRUE(reading.warnings.empty());
  EXPECT_NEAR(reading.campaign.mass_sigma, 0.03, kAttribute);
  EXPECT_NEAR(reading.campaign.tracker->scale_sigma, 2e-6, kAttribute);
  EXPECT_NEAR(reading.campaign.load_cell->gain_sigma, 0.005, kAttribute);
  EXPECT_NEAR(reading.campaign.load_cell->angle_sigma, 0.004, kAttribute);
  EXPECT_NEAR(reading.campaign.load_cell->point_sigma, 0.0015, kAttribute);
}

TEST(WriteCampaign, WritesTheUnitsAndDecimalsOfTheFormat) {
  const SmallCampaign files;
  const TemporaryFolder out;
  campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
  campaign.nests->rows[0].point.x() = -1e-12;  // rounds to zero, which has no sign
  campaign::writeCampaign(campaign, files.folder() / "robot.urdf", out.path());
  std::string header, row;
  std::ifstream nests(out.path() / "nests.csv");
  std::getline(nests, header);
  std::getline(nests, row);
  EXPECT_EQ(header, "time_s,nest,x_mm,y_mm,z_mm");
  EXPECT_EQ(row, "0.0,N1,0.0000,-241.6309,-1209.9495");
  std::ifstream states(out.path() / "states.csv");
  std::getline(states, header);
  std::getline(states, row);
  EXPECT_EQ(row,
            "A,0,1076.0,7.93121,26.73967,3.67551,-72.14435,26.25065,104.19286,-0.312,-0.039,0.265,-0.5150,0.3150,"
            "-0.4410");
}

TEST(WriteCampaign, RefusesWhatTheFormatCannotHold) {
  const SmallCampaign files;
  const TemporaryFolder out;
  const auto why = [&](auto change) -> std::string {
    campaign::Campaign campaign = campaign::readCampaign(files.folder()).campaign;
    change(campaign);
    try {
      campaign::writeCampaign(campaign, files.folder() / "robot.urdf", out.path());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why([](campaign::Campaign& c) { c.nests->rows[0].time_s = campaign::kNoTime; }),
            "the campaign cannot be written: time_s: a value is not finite");
  EXPECT_EQ(why([](campaign::Campaign& c) { c.nests->rows[0].nest = 7; }),
            "the campaign cannot be written: nest: index 7 has no name");
  EXPECT_EQ(why([](campaign::Campaign& c) { c.pose_ids[0] = "A\nB"; }),
            "the campaign cannot be written: pose: a name has a control character");
  EXPECT_EQ(why([](campaign::Campaign& c) { c.circle_sweeps->rows[0].index = ""; }),
            "the campaign cannot be written: index: a name is empty");
}

TEST(WriteCampaign, ReadsBackThePracticeAndRealCampaigns) {
  const std::filesystem::path shared(STIFFSCOPE_SHARED_DIR);
  if (!std::filesystem::exists(shared / "practice")) GTEST_SKIP() << "no practice campaigns beside the checkout";
  for (const char* name : {"practice/01", "real/fanuc-r2000ic-cable", "real/fanuc-r2000ic-sweeps"}) {
    expectRoundTrip(campaign::readCampaign(shared / name).campaign, shared / name / "robot.urdf");
  }
}

}  // namespace write_campaign_test
}  // namespace stiffscope
