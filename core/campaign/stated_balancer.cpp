#include "core/campaign/stated_balancer.h"

#include <fmt/format.h>
#include <algorithm>
#include <stdexcept>

#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/robot/balancer.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::campaign {

namespace {

/// A number from `least` to `most` in the unit of its name, in SI.
double within(const io::XmlNode& node, const std::string& attribute, double least, double most, double unit) {
  const double value = node.number(attribute);
  if (!(value >= least && value <= most))
    node.refuse(attribute, node.requiredAttribute(attribute), fmt::format("expected {:g} to {:g}", least, most));
  return value * unit;
}

template <class Value>
Value eitherOf(const io::XmlNode& node, const std::string& attribute, const std::string& first, Value if_first,
               const std::string& second, Value if_second) {
  const std::string value = node.requiredAttribute(attribute);
  if (value == first) return if_first;
  if (value == second) return if_second;
  node.refuse(attribute, value,
              fmt::format("expected {} or {}{}", first, second, io::nearestNameHint(value, {first, second})));
}

constexpr double kShortest = 1.0, kLongest = 20'000.0;  // mm; beyond the largest arms

// No balancer of an arm is stronger than the arm is heavy by a factor of ten.
robot::SpringLaw readSpringLaw(const io::XmlNode& node) {
  constexpr double kStiffest = 1e7, kStrongest = 1e6;  // N/m and N
  return {within(node, "rate_n_per_m", 0.0, kStiffest, 1.0), within(node, "tension_n", -kStrongest, kStrongest, 1.0),
          within(node, "length_mm", kShortest, kLongest, io::kMillimetre)};
}

robot::GasLaw readGasLaw(const io::XmlNode& node) {
  constexpr double kMostBar = 1000.0, kLeastArea = 0.01, kMostArea = 10'000.0, kLeastVolume = 0.001,
                   kMostVolume = 1000.0;
  robot::GasLaw law;
  law.pressure_pa = within(node, "pressure_bar", 0.0, kMostBar, io::kBar);
  law.area_m2 = within(node, "area_cm2", kLeastArea, kMostArea, io::kSquareCentimetre);
  law.volume_m3 = within(node, "volume_l", kLeastVolume, kMostVolume, io::kLitre);
  law.length_m = within(node, "length_mm", kShortest, kLongest, io::kMillimetre);
  constexpr double kAdiabatic = 2.0;  // above that of any gas at the pressures of cylinders
  if (node.has("exponent")) law.exponent = within(node, "exponent", 1.0, kAdiabatic, 1.0);
  law.pushes = eitherOf(node, "acts", "pull", false, "push", true);
  return law;
}

Eigen::Vector3d endOf(const io::XmlNode& node, const std::string& attribute) {
  const Eigen::Vector3d end = node.vector(attribute);
  if (end.cwiseAbs().maxCoeff() > kLongest)
    node.refuse(attribute, node.requiredAttribute(attribute), "expected mm, each from -20000 to 20000");
  return end * io::kMillimetre;
}

void readStroke(const io::XmlNode& node, robot::Balancer& balancer) {
  if (node.has("shortest_mm")) balancer.shortest_m = within(node, "shortest_mm", kShortest, kLongest, io::kMillimetre);
  if (node.has("longest_mm")) balancer.longest_m = within(node, "longest_mm", kShortest, kLongest, io::kMillimetre);
  if (balancer.shortest_m && balancer.longest_m && *balancer.longest_m <= *balancer.shortest_m)
    node.refuse("longest_mm", node.requiredAttribute("longest_mm"), "expected more than shortest_mm");
  const auto* gas = std::get_if<robot::GasLaw>(&balancer.law);
  const std::optional<double>& emptied = gas != nullptr && gas->pushes ? balancer.shortest_m : balancer.longest_m;
  if (gas == nullptr || !emptied) return;
  const double left = gas->volume_m3 - gas->area_m2 * std::abs(*emptied - gas->length_m);
  const bool shrinks = gas->pushes ? *emptied < gas->length_m : *emptied > gas->length_m;
  if (shrinks && left <= 0.0)
    node.refuse("volume_l", node.requiredAttribute("volume_l"),
                "expected more than area_cm2 times the stroke from length_mm: no gas would be left at its end");
}

const robot::LinkFrame& linkNamed(const StatedBalancer& stated, std::size_t end, const robot::Robot& robot) {
  const std::string& name = stated.links[end];
  const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                  [&](const robot::LinkFrame& link) { return link.name == name; });
  if (found != robot.links.end()) return *found;
  std::vector<std::string> known;
  for (const robot::LinkFrame& link : robot.links) known.push_back(link.name);
  throw io::InputError({stated.file, stated.line, end == 0 ? "from_link" : "to_link"}, name,
                       "expected a link of the robot, on its chain or fixed to it" + io::nearestNameHint(name, known));
}

}  // namespace

StatedBalancer readBalancer(const io::XmlNode& node, std::vector<std::string>& warnings) {
  std::vector<std::string> known{"kind",  "from_link", "from_mm",     "to_link",
                                 "to_mm", "length_mm", "shortest_mm", "longest_mm"};
  const bool gas = eitherOf(node, "kind", "spring", false, "gas", true);
  const std::vector<std::string> own =
      gas ? std::vector<std::string>{"pressure_bar", "area_cm2", "volume_l", "acts", "exponent"}
          : std::vector<std::string>{"rate_n_per_m", "tension_n"};
  known.insert(known.end(), own.begin(), own.end());
  io::warnOfUnknown(node, known, {}, warnings);
  StatedBalancer stated;
  if (gas) {
    stated.balancer.law = readGasLaw(node);
  } else {
    stated.balancer.law = readSpringLaw(node);
  }
  stated.links = {node.requiredName("from_link"), node.requiredName("to_link")};
  stated.balancer.from.in_base_at_zero = endOf(node, "from_mm");
  stated.balancer.to.in_base_at_zero = endOf(node, "to_mm");
  readStroke(node, stated.balancer);
  stated.file = node.file();
  stated.line = node.line();
  return stated;
}

void placeBalancers(const std::vector<StatedBalancer>& stated, robot::Robot& robot) {
  for (const StatedBalancer& one : stated) {
    robot::Balancer balancer = one.balancer;
    const std::array<robot::BalancerEnd*, 2> ends{&balancer.from, &balancer.to};
    for (std::size_t end = 0; end < 2; ++end) {
      const robot::LinkFrame& link = linkNamed(one, end, robot);
      ends[end]->body = link.body;
      ends[end]->in_base_at_zero = link.base_from_link_at_zero * ends[end]->in_base_at_zero;
    }
    if (balancer.from.body == balancer.to.body)
      throw io::InputError({one.file, one.line, "to_link"}, one.links[1],
                           "expected a link that a joint moves against " + one.links[0]);
    constexpr double kApart = 1e-3;  // m
    const double apart = (balancer.to.in_base_at_zero - balancer.from.in_base_at_zero).norm();
    if (apart < kApart)
      throw io::InputError({one.file, one.line, "to_mm"},
                           fmt::format("{:.3f} mm from from_mm", apart / io::kMillimetre),
                           "expected ends that are apart: with all joints at zero these coincide");
    robot.balancers.push_back(std::move(balancer));
  }
}

namespace {

/// One balancer in the rows of one table.
template <class Row>
void checkBalancer(const Campaign& campaign, const std::optional<Table<Row>>& table, std::size_t number,
                   std::vector<std::string>& warnings) {
  if (!table) return;
  const robot::Balancer& balancer = campaign.robot.balancers[number];
  robot::Balancer by_law = balancer, by_stroke = balancer;
  by_law.shortest_m = by_law.longest_m = std::nullopt;
  constexpr double kMargin = 0.01;  // m: sheets round, and arms differ from their URDF by millimetres
  if (by_stroke.shortest_m) *by_stroke.shortest_m -= kMargin;
  if (by_stroke.longest_m) *by_stroke.longest_m += kMargin;
  const Row* first = nullptr;
  std::size_t rows = 0;
  double first_length = 0.0;
  const auto place = [&](const Row& row) {
    return io::InputPlace{(campaign.folder / table->file).string(), row.line,
                          fmt::format("q1_deg..q{}_deg", campaign.robot.joints())};
  };
  const auto shownLength = [&](double length) {
    return fmt::format("balancer {} of {:.1f} mm", number + 1, length / io::kMillimetre);
  };
  const JointVector* last = nullptr;
  double length = 0.0;
  for (const Row& row : table->rows) {
    if (last == nullptr || *last != row.q) length = lengthAt(balancer, robot::postureAt(campaign.robot, row.q));
    last = &row.q;
    if (!withinStroke(by_law, length))
      throw io::InputError(place(row), shownLength(length),
                           "expected angles at which its ends are apart and its gas has a volume: see the balancer's "
                           "ends, acts, area_cm2 and volume_l in campaign.xml");
    if (withinStroke(by_stroke, length)) continue;
    if (rows++ == 0) first = &row, first_length = length;
  }
  if (first == nullptr) return;
  const auto limit = [](const std::optional<double>& end, const char* open) {
    return end ? fmt::format("{:.1f}", *end / io::kMillimetre) : std::string(open);
  };
  warnings.push_back(io::inputMessage(
      place(*first), shownLength(first_length),
      fmt::format("more than 10 mm outside its stroke ({} to {} mm): its ends or its stroke in campaign.xml are not "
                  "those of this arm; rows like this: {}",
                  limit(balancer.shortest_m, "0"), limit(balancer.longest_m, "any"), rows)));
}

}  // namespace

void checkBalancers(const Campaign& campaign, std::vector<std::string>& warnings) {
  if (campaign.robot.balancers.empty()) return;
  for (std::size_t i = 0; i < campaign.robot.balancers.size(); ++i) {
    checkBalancer(campaign, campaign.circle_sweeps, i, warnings);
    checkBalancer(campaign, campaign.wrist_sweep, i, warnings);
    checkBalancer(campaign, campaign.states, i, warnings);
  }
  const robot::GravityLoad weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base,
                                                       campaign.robot, Eigen::Isometry3d::Identity());
  if (weight.links_known) return;
  warnings.push_back(io::inputMessage(
      {(campaign.folder / "campaign.xml").string(), 0, "balancer"}, "",
      "the URDF states no mass of some body beyond joint 2: the arm's sag is not known, with or without a balancer"));
}

const robot::LinkFrame& linkOf(const robot::BalancerEnd& end, const robot::Robot& robot) {
  const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                  [&](const robot::LinkFrame& link) { return link.body == end.body; });
  if (found == robot.links.end())
    throw std::runtime_error(fmt::format("the campaign cannot be written: balancer: no link of body {}", end.body));
  return *found;
}

}  // namespace stiffscope::campaign
