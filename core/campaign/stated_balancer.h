#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/io/xml.h"
#include "core/robot/robot.h"

namespace stiffscope::campaign {

/// A `balancer` of campaign.xml before the URDF is read: its ends are in the axes of their links yet.
struct StatedBalancer {
  robot::Balancer balancer;
  std::array<std::string, 2> links;  ///< of `from` and of `to`
  std::string file;
  std::size_t line = 0;
};

/// Throws InputError for what the format does not allow.
StatedBalancer readBalancer(const io::XmlNode& node, std::vector<std::string>& warnings);

/// Gives the robot its balancers. Throws InputError for a link that it has not, two links that no joint moves against
/// each other, and ends that coincide.
void placeBalancers(const std::vector<StatedBalancer>& stated, robot::Robot& robot);

/// Throws InputError for a row at whose angles a balancer cannot be: its gas has no volume left, or its ends meet.
/// Warns of those outside its stroke, and of balancers of an arm whose masses are not known.
void checkBalancers(const Campaign& campaign, std::vector<std::string>& warnings);

/// The link that an end is written with: the first of its body. Its place is to be divided out of `in_base_at_zero`.
const robot::LinkFrame& linkOf(const robot::BalancerEnd& end, const robot::Robot& robot);

}  // namespace stiffscope::campaign
