#include "core/calibration/calibrated_urdf.h"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "core/io/input_error.h"
#include "core/robot/kinematics.h"
#include "metrology/lines.h"

namespace stiffscope::calibration {

namespace {

using tinyxml2::XMLElement;

std::string named(const XMLElement& joint, const char* element) {
  const XMLElement* child = joint.FirstChildElement(element);
  const char* name = child != nullptr ? child->Attribute("link") : nullptr;
  return name != nullptr ? name : "";
}

/// Joints from the base to the flange.
std::vector<XMLElement*> chainOf(XMLElement& robot, const std::string& base, const std::string& flange) {
  std::map<std::string, XMLElement*> above;
  for (XMLElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    above[named(*joint, "child")] = joint;
  }
  std::vector<XMLElement*> chain;
  for (std::string link = flange; link != base; link = named(*chain.back(), "parent")) {
    const auto found = above.find(link);
    if (found == above.end() || chain.size() > above.size())
      throw std::runtime_error(fmt::format("the URDF has no chain from '{}' to '{}'", base, flange));
    chain.push_back(found->second);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

Eigen::Vector3d vectorOf(const XMLElement* element, const char* attribute) {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  const char* text = element != nullptr ? element->Attribute(attribute) : nullptr;
  if (text == nullptr) return value;
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  for (double& number : value) words >> number;
  return value;
}

Eigen::Isometry3d originOf(const XMLElement& joint) {
  const XMLElement* origin = joint.FirstChildElement("origin");
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = robot::rotationFromRpy(vectorOf(origin, "rpy"));
  motion.translation() = vectorOf(origin, "xyz");
  return motion;
}

/// How a joint stands turned from its origin with all joints at zero: by the offset of one that follows another.
Eigen::Isometry3d atZero(const XMLElement& joint) {
  const XMLElement* mimic = joint.FirstChildElement("mimic");
  const double offset = mimic != nullptr ? mimic->DoubleAttribute("offset", 0.0) : 0.0;
  if (offset == 0.0) return Eigen::Isometry3d::Identity();
  const XMLElement* axis = joint.FirstChildElement("axis");
  const Eigen::Vector3d direction =
      axis != nullptr && axis->Attribute("xyz") ? vectorOf(axis, "xyz") : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  return Eigen::Isometry3d(Eigen::AngleAxisd(offset, direction.normalized()));
}

/// The least rotation that brings direction `from` to `to`: about their common normal. Half a turn about any where they
/// are opposite.
Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d start = from.normalized(), end = to.normalized();
  const double cosine = end.dot(start);
  constexpr double kOpposite = 1e-12;
  if (cosine < kOpposite - 1.0) return Eigen::AngleAxisd(std::numbers::pi, start.unitOrthogonal()).toRotationMatrix();
  // Twice the cosine of half the angle; half of it and the sine along the normal are the quaternion.
  const double half = std::sqrt((1.0 + cosine) * 2.0);
  const Eigen::Vector3d vector = start.cross(end) * (1.0 / half);
  return Eigen::Quaterniond(half * 0.5, vector.x(), vector.y(), vector.z()).toRotationMatrix();
}

void setOrigin(XMLElement& joint, const Eigen::Isometry3d& motion) {
  XMLElement* origin = joint.FirstChildElement("origin");
  if (origin == nullptr) origin = joint.InsertNewChildElement("origin");
  const auto written = [](const Eigen::Vector3d& v) {
    return fmt::format("{:.17g} {:.17g} {:.17g}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
  };
  origin->SetAttribute("xyz", written(motion.translation()).c_str());
  origin->SetAttribute("rpy", written(robot::rpyFromRotation(motion.linear())).c_str());
}

}  // namespace

std::string calibratedUrdf(std::string_view bytes, const std::string& file, const std::string& base_link,
                           const std::string& flange_link, const robot::Robot& nominal,
                           const robot::Robot& calibrated) {
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS)
    throw io::InputError({file, static_cast<std::size_t>(std::max(0, document.ErrorLineNum())), ""}, "",
                         "expected well-formed XML");
  const Eigen::Isometry3d flange_moved =
      calibrated.base_from_flange_at_zero * nominal.base_from_flange_at_zero.inverse();
  Eigen::Isometry3d parent = Eigen::Isometry3d::Identity(), parent_as_built = Eigen::Isometry3d::Identity();
  const std::size_t axes = nominal.axes_in_base_at_zero.size();
  std::size_t turning = 0;
  for (XMLElement* joint : chainOf(*document.RootElement(), base_link, flange_link)) {
    const Eigen::Isometry3d origin = originOf(*joint);
    const Eigen::Isometry3d as_built = parent_as_built * origin;
    Eigen::Isometry3d placed = parent * origin;
    const char* type = joint->Attribute("type");
    const bool turns = type != nullptr && std::string_view(type) != "fixed" && std::string_view(type) != "prismatic";
    if (turns && turning < axes) {
      const metrology::Line& axis = calibrated.axes_in_base_at_zero[turning];
      if (turning + 1 == axes) {
        placed = flange_moved * as_built;
      } else {
        const Eigen::Vector3d& direction = nominal.axes_in_base_at_zero[turning].direction;
        placed.linear() = rotationBetween(direction, axis.direction) * as_built.linear();
        placed.translation() = metrology::nearestPoint(axis, as_built.translation());
      }
      ++turning;
      setOrigin(*joint, parent.inverse() * placed);
      placed = parent * originOf(*joint);  // as it will be read
    }
    const Eigen::Isometry3d turned = atZero(*joint);
    parent = placed * turned;
    parent_as_built = as_built * turned;
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace stiffscope::calibration
