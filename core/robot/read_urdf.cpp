#include "core/robot/read_urdf.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/xml.h"
#include "core/robot/body_inertia.h"
#include "core/robot/kinematics.h"

namespace stiffscope::robot {

struct UrdfJoint {
  std::string name, type, parent, child;
  io::XmlNode node;

  bool fixed() const { return type == "fixed"; }
};

/// The links and joints of a URDF and how they hang together. Their numbers stay unread until they are asked
/// for with the functions below, so that what is wrong off the chain does not matter.
class UrdfModel {
 public:
  /// Throws InputError where the file is no `robot`, a link or joint has no name or one that is taken, a
  /// joint lacks its parent or child, or a link has two parents.
  UrdfModel(std::string file, std::string_view bytes);

  io::XmlNode robot() const { return xml_.root(); }
  const std::vector<UrdfJoint>& joints() const { return joints_; }

  bool hasLink(const std::string& name) const { return links_.contains(name); }
  const io::XmlNode& link(const std::string& name) const { return links_.at(name); }
  std::vector<std::string> linkNames() const;

  /// The joint that carries `link`; null for a root.
  const UrdfJoint* jointAbove(const std::string& link) const;

  /// Fixed joints on `link`, below and above it, in the order of the file.
  std::vector<const UrdfJoint*> fixedJointsAt(const std::string& link) const;

 private:
  void addLink(const io::XmlNode& node);
  void addJoint(const io::XmlNode& node);

  io::XmlFile xml_;
  std::map<std::string, io::XmlNode> links_;
  std::vector<UrdfJoint> joints_;
  std::map<std::string, std::size_t> joint_above_;
  std::multimap<std::string, std::size_t> fixed_at_;
};

/// `origin` of a joint or an inertial (m, rad; identity where absent).
Eigen::Isometry3d urdfOrigin(const io::XmlNode& node);

/// `axis` of a joint in its own frame, unit length (1 0 0 where absent). Throws InputError for a zero axis.
Eigen::Vector3d urdfAxis(const io::XmlNode& joint);

namespace {

// A robot description may hold elements of other programs, which are passed over; one that is nearly a name which is
// read here would be passed over too, and its value with it.
void refuseMisspelt(const io::XmlNode& node, const std::vector<std::string>& elements,
                    const std::vector<std::string>& attributes) {
  const auto check = [&](const std::string& name, const std::vector<std::string>& known, const io::XmlNode& where) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const std::string hint = io::nearestNameHint(name, known);
    if (!hint.empty()) where.refuse(name, "", "expected a name that URDF has here" + hint);
  };
  for (const io::XmlNode& child : node.children()) check(child.name(), elements, child);
  for (const std::string& name : node.attributeNames()) check(name, attributes, node);
}

}  // namespace

UrdfModel::UrdfModel(std::string file, std::string_view bytes) : xml_(std::move(file), bytes) {
  if (robot().name() != "robot") robot().refuse(robot().name(), "", "expected <robot> as the root of a URDF");
  for (const io::XmlNode& node : robot().children("link")) addLink(node);
  for (const io::XmlNode& node : robot().children("joint")) addJoint(node);
}

void UrdfModel::addLink(const io::XmlNode& node) {
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

void UrdfModel::addJoint(const io::XmlNode& node) {
  refuseMisspelt(
      node, {"origin", "parent", "child", "axis", "calibration", "dynamics", "limit", "mimic", "safety_controller"},
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

Eigen::Isometry3d urdfOrigin(const io::XmlNode& node) {
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

Eigen::Vector3d urdfAxis(const io::XmlNode& joint) {
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

namespace {

using Chain = std::vector<const UrdfJoint*>;

void requireLink(const UrdfModel& model, const io::XmlNode& where, const std::string& role, const std::string& name,
                 const std::string& stated_where = "") {
  if (model.hasLink(name)) return;
  where.refuse(role, name,
               "expected a link of the robot" + io::nearestNameHint(name, model.linkNames()) + stated_where);
}

/// The name does not stand in the URDF, whose line an error shows.
std::string statedAs(const char* attribute) {
  return fmt::format(
      "; the name is that of attribute {} of `robot` in campaign.xml or the specification, or of an option", attribute);
}

// Joints from base to flange, found upwards because each link has one parent but may carry many others.
Chain chainBetween(const UrdfModel& model, const std::string& base, const std::string& flange) {
  requireLink(model, model.robot(), "base_link", base, statedAs("base_link"));
  requireLink(model, model.robot(), "flange_link", flange, statedAs("flange_link"));
  Chain chain;
  for (std::string link = flange; link != base;) {
    const UrdfJoint* joint = model.jointAbove(link);
    if (joint == nullptr) {
      model.robot().refuse("flange_link", flange,
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

/// The linear axis of the chain: prismatic, and before every joint that turns. Null where there is none.
const UrdfJoint* railOf(const Chain& chain) {
  const auto first = std::find_if(chain.begin(), chain.end(), [](const UrdfJoint* joint) { return !joint->fixed(); });
  return first != chain.end() && (*first)->type == "prismatic" ? *first : nullptr;
}

/// Of a joint that follows another: angle = multiplier * that one's + offset (URDF, `mimic`).
struct Mimic {
  std::string followed;
  double multiplier = 1.0, offset = 0.0;  // offset in rad
};

std::optional<Mimic> mimicOf(const UrdfJoint& joint) {
  const auto node = joint.node.child("mimic");
  if (!node) return std::nullopt;
  refuseMisspelt(*node, {}, {"joint", "multiplier", "offset"});
  Mimic mimic{node->requiredName("joint")};
  if (node->has("multiplier")) mimic.multiplier = node->number("multiplier");
  if (node->has("offset")) mimic.offset = node->number("offset");
  constexpr double kMostTurns = 1000.0;  // a gear's ratio belongs to the motor, not to the axis
  if (mimic.multiplier == 0.0 || std::abs(mimic.multiplier) > kMostTurns) {
    node->refuse("multiplier", node->attribute("multiplier").value_or(""),
                 "expected a multiplier within +-1000 that is not 0: a joint that stands still is 'fixed'");
  }
  return mimic;
}

bool follows(const UrdfJoint& joint) { return joint.node.child("mimic").has_value(); }

void requireRevolute(const UrdfModel& model, const Chain& chain, const std::string& base, const std::string& flange) {
  std::vector<std::string> turning;
  std::size_t axes = 0;
  for (const UrdfJoint* joint : chain) {
    if (joint->fixed() || joint == railOf(chain)) continue;
    if (!turns(*joint)) {
      joint->node.refuse("type", joint->type,
                         fmt::format("expected revolute joints between '{}' and '{}'; joint '{}' is not. One linear "
                                     "axis may stand below the arm: a prismatic joint before all others",
                                     base, flange, joint->name));
    }
    ++axes;
    if (!follows(*joint)) turning.push_back(joint->name);
  }
  if (axes > kMostJoints && axes != turning.size()) {
    model.robot().refuse("joint", "",
                         fmt::format("expected at most {} axes between '{}' and '{}', those that follow others "
                                     "('mimic') among them; there are {}",
                                     kMostJoints, base, flange, axes));
  }
  if (turning.size() < kFewestJoints || turning.size() > kMostJoints) {
    model.robot().refuse(
        "joint", "",
        fmt::format("expected {} to {} revolute joints between '{}' and '{}'; there are {}{}{}", kFewestJoints,
                    kMostJoints, base, flange, turning.size(), turning.empty() ? "" : ": ", fmt::join(turning, ", ")));
  }
}

/// The joints of the chain that turn, with those that follow others tied to them. Null where none does.
std::shared_ptr<const Couplings> couplingsOf(const std::vector<const UrdfJoint*>& turning) {
  if (std::none_of(turning.begin(), turning.end(), [](const UrdfJoint* joint) { return follows(*joint); })) {
    return nullptr;
  }
  std::vector<std::string> names;
  auto couplings = std::make_shared<Couplings>();
  for (std::size_t axis = 0; axis < turning.size(); ++axis) {
    const bool own = !follows(*turning[axis]);
    couplings->own_joint.push_back(own ? static_cast<int>(names.size()) : -1);
    if (!own) continue;
    couplings->own_axis.push_back(static_cast<int>(axis));
    names.push_back(turning[axis]->name);
  }
  couplings->turns.setZero(static_cast<Eigen::Index>(turning.size()), static_cast<Eigen::Index>(names.size()));
  for (std::size_t axis = 0; axis < turning.size(); ++axis) {
    const auto row = static_cast<Eigen::Index>(axis);
    const std::optional<Mimic> mimic = mimicOf(*turning[axis]);
    if (!mimic) {
      couplings->turns(row, couplings->own_joint[axis]) = 1.0;
      continue;
    }
    const auto followed = std::find(names.begin(), names.end(), mimic->followed);
    if (followed == names.end()) {
      turning[axis]->node.child("mimic")->refuse(
          "joint", mimic->followed,
          fmt::format("expected a joint between base and flange that has an angle of its own: {}{}",
                      fmt::join(names, ", "), io::nearestNameHint(mimic->followed, names)));
    }
    couplings->turns(row, followed - names.begin()) = mimic->multiplier;
  }
  return couplings;
}

constexpr JointLimits kUnlimited{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

/// Lower and upper; URDF gives both a default of 0.
std::pair<double, double> statedLimits(const UrdfJoint& joint) {
  const io::XmlNode limit = joint.node.requiredChild("limit");
  const double lower = limit.has("lower") ? limit.number("lower") : 0.0;
  const double upper = limit.has("upper") ? limit.number("upper") : 0.0;
  if (lower > upper) {
    limit.refuse("lower", fmt::format("{}", lower),
                 fmt::format("expected at most the upper limit of joint '{}', {}", joint.name, upper));
  }
  return {lower, upper};
}

JointLimits limitsOf(const UrdfJoint& joint) {
  if (joint.type == "continuous") return kUnlimited;
  const auto [lower, upper] = statedLimits(joint);
  return {lower, upper};
}

/// A rail whose direction is known in the base; the arm on it stands still in the carriage.
Rail railAlong(const UrdfJoint& joint, const Eigen::Isometry3d& base_from_joint) {
  if (follows(joint)) {
    joint.node.child("mimic")->refuse("joint", joint.name, "expected a linear axis that follows no other joint");
  }
  const auto [lower, upper] = statedLimits(joint);
  constexpr double kLongest = 200.0;  // m; no rail is that long, one in millimetres is
  if (std::max(std::abs(lower), std::abs(upper)) > kLongest) {
    joint.node.requiredChild("limit").refuse("upper", fmt::format("{}", upper), "expected metres, within +-200 m");
  }
  return {joint.name, (base_from_joint.linear() * urdfAxis(joint.node)).normalized(), lower, upper};
}

/// R0 stands where the common perpendicular of axes 1 and 2 meets axis 1, with y0 along axis 2 (metrology::baseFrame).
void requireBaseFrame(const std::vector<const UrdfJoint*>& turning, const ArmAxes& axes) {
  if (metrology::angleBetween(axes[0], axes[1]) > metrology::kNearParallel) return;
  turning[1]->node.refuse("axis", turning[1]->name,
                          fmt::format("expected an axis that is not parallel to that of joint '{}': the two define the "
                                      "frame R0 in which results are stated",
                                      turning[0]->name));
}

void placeChain(const Chain& chain, const std::string& base, Robot& robot) {
  Eigen::Isometry3d base_from_link = Eigen::Isometry3d::Identity();
  robot.links.push_back({base, 0, base_from_link});
  std::vector<const UrdfJoint*> turning;
  for (const UrdfJoint* joint : chain) {
    base_from_link = base_from_link * urdfOrigin(joint->node);
    if (joint->type == "prismatic") robot.rail = railAlong(*joint, base_from_link);
    if (turns(*joint)) {
      turning.push_back(joint);
      const Eigen::Vector3d axis = urdfAxis(joint->node);
      robot.axes_in_base_at_zero.push_back(
          {base_from_link.translation(), (base_from_link.linear() * axis).normalized()});
      robot.axis_names.push_back(joint->name);
      robot.axis_limits.push_back(limitsOf(*joint));
      if (const auto mimic = mimicOf(*joint)) {
        // With all joints at zero it stands turned by the offset.
        base_from_link.linear() = base_from_link.linear() * Eigen::AngleAxisd(mimic->offset, axis).toRotationMatrix();
        JointLimits& limits = robot.axis_limits.back();
        const bool none_stated = limits.lower == limits.upper;
        limits = none_stated ? kUnlimited : JointLimits{limits.lower - mimic->offset, limits.upper - mimic->offset};
      } else {
        robot.limits.push_back(robot.axis_limits.back());
        robot.joint_names.push_back(joint->name);
      }
    }
    robot.links.push_back({joint->child, static_cast<int>(turning.size()), base_from_link});
  }
  requireBaseFrame(turning, robot.axes_in_base_at_zero);
  robot.axes_in_base_at_zero.couplings = couplingsOf(turning);
  robot.base_from_flange_at_zero = base_from_link;
  robot.bodies.resize(robot.axes_in_base_at_zero.size() + 1);
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
      robot.links.push_back({other, carrier.body, carrier.base_from_link_at_zero * (below ? step : step.inverse())});
    }
  }
}

void addMass(const UrdfModel& model, const LinkFrame& frame, Robot& robot) {
  const auto inertial = model.link(frame.name).child("inertial");
  if (!inertial) return;
  const io::XmlNode mass = inertial->requiredChild("mass");
  const double mass_kg = mass.number("value");
  if (mass_kg < 0.0) mass.refuse("value", mass.requiredAttribute("value"), "expected a mass of 0 or more");
  if (mass_kg == 0.0) return;
  const Eigen::Vector3d com = frame.base_from_link_at_zero * urdfOrigin(*inertial).translation();
  BodyMass& body = robot.bodies[static_cast<std::size_t>(frame.body)];
  body.com_in_base_at_zero = (body.mass_kg * body.com_in_base_at_zero + mass_kg * com) / (body.mass_kg + mass_kg);
  body.mass_kg += mass_kg;
}

}  // namespace

Robot parseUrdf(std::string_view bytes, const std::string& file, const std::string& base_link,
                const std::string& flange_link) {
  const UrdfModel model(file, bytes);
  const Chain chain = chainBetween(model, base_link, flange_link);
  requireRevolute(model, chain, base_link, flange_link);
  Robot robot;
  robot.name = model.robot().attribute("name").value_or("");
  placeChain(chain, base_link, robot);
  placeAttachedLinks(model, robot);
  for (const LinkFrame& frame : robot.links) addMass(model, frame, robot);
  return robot;
}

namespace {

Eigen::Matrix3d urdfInertia(const io::XmlNode& inertial) {
  const auto node = inertial.child("inertia");
  if (!node) return Eigen::Matrix3d::Zero();
  const auto entry = [&](const char* name) { return node->has(name) ? node->number(name) : 0.0; };
  Eigen::Matrix3d inertia;
  inertia << entry("ixx"), entry("ixy"), entry("ixz"),  //
      entry("ixy"), entry("iyy"), entry("iyz"),         //
      entry("ixz"), entry("iyz"), entry("izz");
  return inertia;
}

}  // namespace

PerBody<Eigen::Matrix3d> bodyInertias(std::string_view bytes, const std::string& file, const std::string& base_link,
                                      const std::string& flange_link) {
  const UrdfModel model(file, bytes);
  const Robot robot = parseUrdf(bytes, file, base_link, flange_link);
  PerBody<Eigen::Matrix3d> inertias(robot.bodies.size(), Eigen::Matrix3d::Zero());
  for (const LinkFrame& frame : robot.links) {
    const auto inertial = model.link(frame.name).child("inertial");
    if (!inertial) continue;
    const double mass_kg = inertial->requiredChild("mass").number("value");
    if (mass_kg == 0.0) continue;
    const Eigen::Isometry3d place = frame.base_from_link_at_zero * urdfOrigin(*inertial);
    const auto body = static_cast<std::size_t>(frame.body);
    inertias[body] += place.linear() * urdfInertia(*inertial) * place.linear().transpose() +
                      pointMassInertia(mass_kg, place.translation() - robot.bodies[body].com_in_base_at_zero);
  }
  return inertias;
}

Robot readUrdf(const std::filesystem::path& file, const std::string& base_link, const std::string& flange_link) {
  return parseUrdf(io::readTextFile(file, io::kLargestXml), file.string(), base_link, flange_link);
}

}  // namespace stiffscope::robot
