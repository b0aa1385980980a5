#include "core/input/urdf_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/nearest_name.h"
#include "core/input/roll_pitch_yaw.h"

namespace stiffscope {

namespace {

// A robot description may hold elements of other programs, which are passed over; one that is nearly a name which is read
// here would be passed over too, and its value with it.
void refuseMisspelt(const XmlNode& node, const std::vector<std::string>& elements, const std::vector<std::string>& attributes) {
  const auto check = [&](const std::string& name, const std::vector<std::string>& known, const XmlNode& where) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const std::string hint = nearestNameHint(name, known);
    if (!hint.empty()) where.refuse(name, "", "expected a name that URDF has here" + hint);
  };
  for (const XmlNode& child : node.children()) check(child.name(), elements, child);
  for (const std::string& name : node.attributeNames()) check(name, attributes, node);
}

}  // namespace

UrdfModel::UrdfModel(std::string file, std::string_view bytes) : xml_(std::move(file), bytes) {
  if (robot().name() != "robot") robot().refuse(robot().name(), "", "expected <robot> as the root of a URDF");
  for (const XmlNode& node : robot().children("link")) addLink(node);
  for (const XmlNode& node : robot().children("joint")) addJoint(node);
}

void UrdfModel::addLink(const XmlNode& node) {
  refuseMisspelt(node, {"inertial", "visual", "collision"}, {"name", "type"});
  if (const auto inertial = node.child("inertial")) {
    refuseMisspelt(*inertial, {"origin", "mass", "inertia"}, {});
    if (const auto mass = inertial->child("mass")) refuseMisspelt(*mass, {}, {"value"});
  }
  const std::string name = node.requiredName("name");
  const auto [known, added] = links_.emplace(name, node);
  if (!added) {
    node.refuse("link", name,
                fmt::format("expected a name of its own; the link in line {} has it", known->second.line()));
  }
}

void UrdfModel::addJoint(const XmlNode& node) {
  refuseMisspelt(node, {"origin", "parent", "child", "axis", "calibration", "dynamics", "limit", "mimic", "safety_controller"},
                 {"name", "type"});
  const UrdfJoint joint{node.requiredName("name"), node.requiredName("type"),
                        node.requiredChild("parent").requiredName("link"),
                        node.requiredChild("child").requiredName("link"), node};
  const auto same_name = [&](const UrdfJoint& other) { return other.name == joint.name; };
  if (std::any_of(joints_.begin(), joints_.end(), same_name)) {
    node.refuse("joint", joint.name, "expected a name of its own; another joint has it");
  }
  const auto [above, added] = joint_above_.emplace(joint.child, joints_.size());
  if (!added) {
    node.refuse("child", joint.child,
                fmt::format("expected a link with one parent; joints '{}' and '{}' both carry it",
                            joints_[above->second].name, joint.name));
  }
  if (joint.fixed()) {
    fixed_at_.emplace(joint.parent, joints_.size());
    fixed_at_.emplace(joint.child, joints_.size());
  }
  joints_.push_back(joint);
}

std::vector<std::string> UrdfModel::linkNames() const {
  std::vector<std::string> names;
  for (const auto& [name, node] : links_) names.push_back(name);
  return names;
}

const UrdfJoint* UrdfModel::jointAbove(const std::string& link) const {
  const auto found = joint_above_.find(link);
  return found == joint_above_.end() ? nullptr : &joints_[found->second];
}

std::vector<const UrdfJoint*> UrdfModel::fixedJointsAt(const std::string& link) const {
  std::vector<const UrdfJoint*> found;
  const auto [begin, end] = fixed_at_.equal_range(link);
  for (auto it = begin; it != end; ++it) found.push_back(&joints_[it->second]);
  return found;
}

Eigen::Isometry3d urdfOrigin(const XmlNode& node) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const auto origin = node.child("origin");
  if (!origin) return pose;
  refuseMisspelt(*origin, {}, {"xyz", "rpy", "quat_xyzw"});
  if (origin->has("xyz")) pose.translation() = origin->vector("xyz");
  if (origin->has("rpy")) {
    const Eigen::Vector3d rpy = origin->vector("rpy");
    constexpr double kTurn = 6.2832;  // rounded up; degrees are larger
    if (rpy.cwiseAbs().maxCoeff() > kTurn) {
      origin->refuse("rpy", origin->requiredAttribute("rpy"), "expected radians, within one turn (+-6.2832)");
    }
    pose.linear() = rotationFromRpy(rpy);
  }
  // No arm is that long; lengths in millimetres are.
  constexpr double kLongest = 200.0;
  if (pose.translation().cwiseAbs().maxCoeff() > kLongest) {
    origin->refuse("xyz", origin->requiredAttribute("xyz"), "expected metres, within +-200 m");
  }
  return pose;
}

Eigen::Vector3d urdfAxis(const XmlNode& joint) {
  const auto axis = joint.child("axis");
  if (axis) refuseMisspelt(*axis, {}, {"xyz"});
  if (!axis || !axis->has("xyz")) return Eigen::Vector3d::UnitX();
  const Eigen::Vector3d direction = axis->vector("xyz");
  constexpr double kShortest = 1e-9, kLongest = 1e9;
  if (direction.norm() < kShortest || direction.cwiseAbs().maxCoeff() > kLongest) {
    axis->refuse("xyz", axis->requiredAttribute("xyz"), "expected an axis that is not zero, nor longer than 1e9");
  }
  return direction.normalized();
}

}  // namespace stiffscope
