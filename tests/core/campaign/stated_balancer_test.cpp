#include "core/campaign/stated_balancer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/campaign/read_campaign.h"
#include "core/io/input_error.h"
#include "core/robot/balancer.h"
#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace stated_balancer_test {

constexpr double kRounding = 1e-12;  // conversions of units, of values up to a few metres

std::string gasBalancer(const std::string& of_gas, const std::string& ends =
                                                       "from_link=\"link_1\" from_mm=\"-300 0 100\" "
                                                       "to_link=\"link_2\" to_mm=\"50 0 250\"") {
  return "<balancer kind=\"gas\" " + ends + " " + of_gas + "/><tool mass_kg";
}

const std::string kOfGas = "pressure_bar=\"120\" area_cm2=\"20\" volume_l=\"30\" length_mm=\"900\" acts=\"pull\"";

TEST(StatedBalancer, IsReadInSi) {
  const SmallCampaign files;
  files.alter("campaign.xml", "<tool mass_kg", gasBalancer(kOfGas + " exponent=\"1.1\" longest_mm=\"9000\""));
  files.alter("campaign.xml", "<tool mass_kg",
              "<balancer kind=\"spring\" from_link=\"base\" from_mm=\"0 0 0\" to_link=\"link_2\" to_mm=\"10 20 30\" "
              "rate_n_per_m=\"2e4\" tension_n=\"-500\" length_mm=\"700\"/><tool mass_kg");
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  EXPECT_TRUE(reading.warnings.empty()) << fmt::format("{}", fmt::join(reading.warnings, "\n"));
  const robot::Robot& robot = reading.campaign.robot;
  ASSERT_EQ(robot.balancers.size(), 2u);
  const auto& gas = std::get<robot::GasLaw>(robot.balancers[0].law);
  EXPECT_NEAR(gas.pressure_pa, 120e5, 1e-6);
  EXPECT_NEAR(gas.area_m2, 20e-4, kRounding);
  EXPECT_NEAR(gas.volume_m3, 30e-3, kRounding);
  EXPECT_NEAR(gas.length_m, 0.9, kRounding);
  EXPECT_EQ(gas.exponent, 1.1);
  EXPECT_FALSE(gas.pushes);
  EXPECT_FALSE(robot.balancers[0].shortest_m);
  EXPECT_NEAR(*robot.balancers[0].longest_m, 9.0, kRounding);
  const auto placeOf = [&](const std::string& name) {
    for (const robot::LinkFrame& link : robot.links) {
      if (link.name == name) return link;
    }
    return robot::LinkFrame();
  };
  EXPECT_EQ(robot.balancers[0].from.body, 1);
  EXPECT_EQ(robot.balancers[0].to.body, 2);
  const Eigen::Vector3d expected = placeOf("link_2").base_from_link_at_zero * Eigen::Vector3d(0.05, 0.0, 0.25);
  EXPECT_LT((robot.balancers[0].to.in_base_at_zero - expected).norm(), 1e-12);
  EXPECT_EQ(std::get<robot::SpringLaw>(robot.balancers[1].law).tension_n, -500.0);
  EXPECT_EQ(robot.balancers[1].from.body, 0);
  EXPECT_NEAR(robot::statedLength(robot.balancers[0]), 0.9, kRounding);
  EXPECT_NEAR(robot::tensionAt(robot.balancers[1], robot::statedLength(robot.balancers[1])).force_n, -500.0, kRounding);
}

TEST(StatedBalancer, IsRefusedWhereItCannotBe) {
  const auto with = [](std::string text, const std::string& find, const std::string& replace) {
    const auto at = text.find(find);
    EXPECT_NE(at, std::string::npos) << find;
    return text.replace(at, find.size(), replace);
  };
  const std::string whole = gasBalancer(kOfGas);
  const std::pair<std::string, const char*> cases[] = {
      {with(whole, "kind=\"gas\"", "kind=\"oil\""), "campaign.xml:15: kind: 'oil': expected spring or gas"},
      {with(whole, "link_1", "link_11"), "campaign.xml:15: from_link: 'link_11': expected a link of the robot"},
      {with(whole, "link_2", "link_1"), "to_link: 'link_1': expected a link that a joint moves against link_1"},
      {with(whole, "to_mm=\"50 0 250\"", "to_mm=\"50 0\""), "to_mm: '50 0': expected three numbers"},
      {with(whole, " acts=\"pull\"", ""), "acts: expected this attribute"},
      {with(whole, "pressure_bar=\"120\"", "pressure_bar=\"12000\""), "pressure_bar: '12000': expected 0 to 1000"},
      {with(whole, "area_cm2=\"20\"", "area_cm2=\"0\""), "area_cm2: '0': expected 0.01 to 10000"},
      {with(whole, "acts", "exponent=\"0.5\" acts"), "exponent: '0.5': expected 1 to 2"},
      {with(whole, "acts", "shortest_mm=\"900\" longest_mm=\"800\" acts"),
       "longest_mm: '800': expected more than shortest_mm"},
      // 20 cm2 over 15.1 m are 30.2 l.
      {with(whole, "acts", "longest_mm=\"16000\" acts"),
       "volume_l: '30': expected more than area_cm2 times the stroke from length_mm"},
      {with(with(whole, "volume_l=\"30\"", "volume_l=\"0.01\""), "length_mm=\"900\"", "length_mm=\"10\""),
       "expected angles at which its ends are apart and its gas has a volume"},
      {"<balancer kind=\"spring\" from_link=\"base\" from_mm=\"0 0 0\" to_link=\"link_1\" to_mm=\"0 0 0\" "
       "tension_n=\"1\" length_mm=\"700\"/><tool mass_kg",
       "rate_n_per_m: expected this attribute"}};
  for (const auto& [element, message] : cases) {
    const SmallCampaign files;
    files.alter("campaign.xml", "<tool mass_kg", element);
    try {
      campaign::readCampaign(files.folder());
      ADD_FAILURE() << "read on instead of: " << message;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(StatedBalancer, IsRefusedWhereItsEndsCoincide) {
  const SmallCampaign files;
  const robot::Robot robot = campaign::readCampaign(files.folder()).campaign.robot;
  const auto link = std::find_if(robot.links.begin(), robot.links.end(),
                                 [](const robot::LinkFrame& one) { return one.name == "link_2"; });
  ASSERT_NE(link, robot.links.end());
  const Eigen::Vector3d place = 1e3 * link->base_from_link_at_zero.translation();
  files.alter("campaign.xml", "<tool mass_kg",
              "<balancer kind=\"spring\" from_link=\"base\" from_mm=\"" + std::to_string(place.x()) + " " +
                  std::to_string(place.y()) + " " + std::to_string(place.z()) +
                  "\" to_link=\"link_2\" to_mm=\"0 0 0\" rate_n_per_m=\"1\" tension_n=\"1\" "
                  "length_mm=\"700\"/><tool mass_kg");
  EXPECT_THROW(
      {
        try {
          campaign::readCampaign(files.folder());
        } catch (const io::InputError& error) {
          EXPECT_EQ(error.place().column, "to_mm");
          EXPECT_NE(std::string(error.what()).find("with all joints at zero these coincide"), std::string::npos);
          throw;
        }
      },
      io::InputError);
}

TEST(StatedBalancer, OutsideItsStrokeIsWarnedOf) {
  const SmallCampaign files;
  files.alter("campaign.xml", "<tool mass_kg", gasBalancer(kOfGas + " longest_mm=\"20\""));
  const campaign::CampaignReading reading = campaign::readCampaign(files.folder());
  ASSERT_EQ(reading.warnings.size(), 3u) << fmt::format(
      "{}", fmt::join(reading.warnings, "\n"));  // one a table with joint angles
  EXPECT_NE(reading.warnings[0].find("more than 10 mm outside its stroke (0 to 20.0 mm)"), std::string::npos)
      << fmt::format("{}", fmt::join(reading.warnings, "\n"));
}

}  // namespace stated_balancer_test
}  // namespace stiffscope
