#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/input/xml_node.h"

namespace stiffscope {

struct UrdfJoint {
  std::string name, type, parent, child;
  XmlNode node;

  bool fixed() const { return type == "fixed"; }
};

/// The links and joints of a URDF and how they hang together. Their numbers stay unread until they are asked
/// for with the functions below, so that what is wrong off the chain does not matter.
class UrdfModel {
 public:
  /// Throws InputError where the file is no `robot`, a link or joint has no name or one that is taken, a
  /// joint lacks its parent or child, or a link has two parents.
  UrdfModel(std::string file, std::string_view bytes);

  XmlNode robot() const { return xml_.root(); }
  const std::vector<UrdfJoint>& joints() const { return joints_; }

  bool hasLink(const std::string& name) const { return links_.contains(name); }
  const XmlNode& link(const std::string& name) const { return links_.at(name); }
  std::vector<std::string> linkNames() const;

  /// The joint that carries `link`; null for a root.
  const UrdfJoint* jointAbove(const std::string& link) const;

  /// Fixed joints on `link`, below and above it, in the order of the file.
  std::vector<const UrdfJoint*> fixedJointsAt(const std::string& link) const;

 private:
  void addLink(const XmlNode& node);
  void addJoint(const XmlNode& node);

  XmlFile xml_;
  std::map<std::string, XmlNode> links_;
  std::vector<UrdfJoint> joints_;
  std::map<std::string, std::size_t> joint_above_;
  std::multimap<std::string, std::size_t> fixed_at_;
};

/// `origin` of a joint or an inertial (m, rad; identity where absent).
Eigen::Isometry3d urdfOrigin(const XmlNode& node);

/// `axis` of a joint in its own frame, unit length (1 0 0 where absent). Throws InputError for a zero axis.
Eigen::Vector3d urdfAxis(const XmlNode& joint);

}  // namespace stiffscope
