#include "core/robot/read_urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/input/nearest_name.h"
#include "core/input/read_file.h"
#include "core/input/urdf_model.h"

namespace stiffscope {

namespace {

using Chain = std::vector<const UrdfJoint*>;

void requireLink(const UrdfModel& model, const XmlNode& where, const std::string& role,
                 const std::string& name) {
  if (model.hasLink(name)) return;
  where.refuse(role, name, "expected a link of the robot" + nearestNameHint(name, model.linkNames()));
}

// Joints from base to flange, found upwards because each link has one parent but may carry many others.
Chain chainBetween(const UrdfModel& model, const std::string& base, const std::string& flange) {
  requireLink(model, model.robot(), "base_link", base);
  requireLink(model, model.robot(), "flange_link", flange);
  Chain chain;
  for (std::string link = flange; link != base;) {
    const UrdfJoint* joint = model.jointAbove(link);
    if (joint == nullptr) {
      model.robot().refuse(
          "flange_link", flange,
          fmt::format("expected a link beyond '{}'; the way back from it ends at '{}'", base, link));
    }
    if (chain.size() == model.joints().size()) {
      joint->node.refuse("joint", joint->name, "expected a chain without a loop; this joint is part of one");
    }
    requireLink(model, joint->node, "parent", joint->parent);
    chain.push_back(joint);
    link = joint->parent;
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

bool turns(const UrdfJoint& joint) { return joint.type == "revolute" || joint.type == "continuous"; }

void requireSixRevolute(const UrdfModel& model, const Chain& chain, const std::string& base,
                        const std::string& flange) {
  std::vector<std::string> turning;
  for (const UrdfJoint* joint : chain) {
    if (joint->fixed()) continue;
    if (!turns(*joint)) {
      joint->node.refuse("type", joint->type,
                         fmt::format("expected revolute joints between '{}' and '{}'; joint '{}' is not",
                                     base, flange, joint->name));
    }
    if (!joint->node.children("mimic").empty()) {
      joint->node.refuse("mimic", joint->name,
                         "expected six joints with angles of their own; this one follows another joint");
    }
    turning.push_back(joint->name);
  }
  if (turning.size() != 6) {
    model.robot().refuse(
        "joint", "",
        fmt::format("expected six revolute joints between '{}' and '{}'; there are {}{}{}", base, flange,
                    turning.size(), turning.empty() ? "" : ": ", fmt::join(turning, ", ")));
  }
}

JointLimits limitsOf(const UrdfJoint& joint) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (joint.type == "continuous") return {-kInfinity, kInfinity};
  const XmlNode limit = joint.node.requiredChild("limit");
  // URDF gives both a default of 0.
  JointLimits limits;
  if (limit.has("lower")) limits.lower = limit.number("lower");
  if (limit.has("upper")) limits.upper = limit.number("upper");
  if (limits.lower > limits.upper) {
    limit.refuse("lower", fmt::format("{}", limits.lower),
                 fmt::format("expected at most the upper limit of joint '{}', {}", joint.name, limits.upper));
  }
  return limits;
}

void placeChain(const Chain& chain, const std::string& base, Robot& robot) {
  Eigen::Isometry3d base_from_link = Eigen::Isometry3d::Identity();
  std::size_t joints = 0;
  robot.links.push_back({base, 0, base_from_link});
  for (const UrdfJoint* joint : chain) {
    base_from_link = base_from_link * urdfOrigin(joint->node);
    if (turns(*joint)) {
      robot.axes_in_base_at_zero[joints] = {base_from_link.translation(),
                                            (base_from_link.linear() * urdfAxis(joint->node)).normalized()};
      robot.limits[joints] = limitsOf(*joint);
      robot.joint_names[joints] = joint->name;
      ++joints;
    }
    robot.links.push_back({joint->child, static_cast<int>(joints), base_from_link});
  }
  robot.base_from_flange_at_zero = base_from_link;
}

// Appends what fixed joints hang on the links already listed, and on those appended, in either direction:
// a base may be fixed to a world link above it.
void placeAttachedLinks(const UrdfModel& model, Robot& robot) {
  std::set<std::string> placed;
  for (const LinkFrame& frame : robot.links) placed.insert(frame.name);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const LinkFrame carrier = robot.links[i];
    for (const UrdfJoint* joint : model.fixedJointsAt(carrier.name)) {
      const bool below = joint->parent == carrier.name;
      const std::string& other = below ? joint->child : joint->parent;
      if (!placed.insert(other).second) continue;
      requireLink(model, joint->node, below ? "child" : "parent", other);
      const Eigen::Isometry3d step = urdfOrigin(joint->node);
      robot.links.push_back(
          {other, carrier.body, carrier.base_from_link_at_zero * (below ? step : step.inverse())});
    }
  }
}

void addMass(const UrdfModel& model, const LinkFrame& frame, Robot& robot) {
  const auto inertial = model.link(frame.name).child("inertial");
  if (!inertial) return;
  const XmlNode mass = inertial->requiredChild("mass");
  const double mass_kg = mass.number("value");
  if (mass_kg < 0.0) mass.refuse("value", mass.requiredAttribute("value"), "expected a mass of 0 or more");
  if (mass_kg == 0.0) return;
  const Eigen::Vector3d com = frame.base_from_link_at_zero * urdfOrigin(*inertial).translation();
  BodyMass& body = robot.bodies[static_cast<std::size_t>(frame.body)];
  body.com_in_base_at_zero =
      (body.mass_kg * body.com_in_base_at_zero + mass_kg * com) / (body.mass_kg + mass_kg);
  body.mass_kg += mass_kg;
}

}  // namespace

Robot parseUrdf(std::string_view bytes, const std::string& file, const std::string& base_link,
                const std::string& flange_link) {
  const UrdfModel model(file, bytes);
  const Chain chain = chainBetween(model, base_link, flange_link);
  requireSixRevolute(model, chain, base_link, flange_link);
  Robot robot;
  robot.name = model.robot().attribute("name").value_or("");
  placeChain(chain, base_link, robot);
  placeAttachedLinks(model, robot);
  for (const LinkFrame& frame : robot.links) addMass(model, frame, robot);
  return robot;
}

Robot readUrdf(const std::filesystem::path& file, const std::string& base_link,
               const std::string& flange_link) {
  return parseUrdf(readTextFile(file, kLargestXml), file.string(), base_link, flange_link);
}

}  // namespace stiffscope
