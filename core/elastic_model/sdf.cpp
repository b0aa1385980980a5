#include "core/elastic_model/simulator_models.h"

#include <tinyxml2.h>
#include <cmath>

#include "core/elastic_model/written.h"

namespace stiffscope::elastic_model {

namespace {

using tinyxml2::XMLElement;

void addText(XMLElement& parent, const char* name, const std::string& text) {
  parent.InsertNewChildElement(name)->SetText(text.c_str());
}

/// Of a frame that stands parallel to the one it is written in.
std::string parallelAt(const Eigen::Vector3d& place) { return written(place) + " 0 0 0"; }

void addLink(XMLElement& model, const std::string& name, const Eigen::Vector3d& origin, const ChainMass& mass) {
  XMLElement* link = model.InsertNewChildElement("link");
  link->SetAttribute("name", name.c_str());
  addText(*link, "pose", parallelAt(origin));
  const bool stand_in = mass.mass_kg <= 0.0;
  if (stand_in) addText(*link, "gravity", "false");
  XMLElement* inertial = link->InsertNewChildElement("inertial");
  if (!stand_in) addText(*inertial, "pose", parallelAt(mass.centre - origin));
  addText(*inertial, "mass", written(stand_in ? kStandInMass : mass.mass_kg));
  const Eigen::Matrix3d about =
      stand_in ? Eigen::Matrix3d(kStandInInertia * Eigen::Matrix3d::Identity()) : mass.inertia;
  XMLElement* inertia = inertial->InsertNewChildElement("inertia");
  addText(*inertia, "ixx", written(about(0, 0)));
  addText(*inertia, "ixy", written(about(0, 1)));
  addText(*inertia, "ixz", written(about(0, 2)));
  addText(*inertia, "iyy", written(about(1, 1)));
  addText(*inertia, "iyz", written(about(1, 2)));
  addText(*inertia, "izz", written(about(2, 2)));
}

/// `origin`: of the child.
void addSdfJoint(XMLElement& model, const ChainJoint& joint, const std::string& parent, const std::string& child,
                 const Eigen::Vector3d& origin) {
  XMLElement* element = model.InsertNewChildElement("joint");
  const bool drive = joint.kind == ChainJoint::Kind::drive, shift = joint.kind == ChainJoint::Kind::shift_spring;
  element->SetAttribute("name", joint.name.c_str());
  element->SetAttribute("type", shift ? "prismatic" : "revolute");
  if (!shift) addText(*element, "pose", parallelAt(joint.point - origin));
  addText(*element, "parent", parent);
  addText(*element, "child", child);
  XMLElement* axis = element->InsertNewChildElement("axis");
  addText(*axis, "xyz", written(joint.direction));
  XMLElement* limit = axis->InsertNewChildElement("limit");
  if (drive && std::isfinite(joint.lower)) addText(*limit, "lower", written(joint.lower));
  if (drive && std::isfinite(joint.upper)) addText(*limit, "upper", written(joint.upper));
  if (drive) return;
  XMLElement* dynamics = axis->InsertNewChildElement("dynamics");
  addText(*dynamics, "damping", written(kDampingTime * joint.stiffness));
  addText(*dynamics, "spring_reference", "0");
  addText(*dynamics, "spring_stiffness", written(joint.stiffness));
}

void addFixedBase(XMLElement& model, const std::string& base) {
  addLink(model, base, Eigen::Vector3d::Zero(), {});
  XMLElement* joint = model.InsertNewChildElement("joint");
  joint->SetAttribute("name", ("fixed_" + base).c_str());
  joint->SetAttribute("type", "fixed");
  addText(*joint, "parent", "world");
  addText(*joint, "child", base);
}

void addFrames(XMLElement& model, const ElasticChain& chain) {
  for (const ChainSite& site : chain.sites) {
    const bool on_base = site.body < 0;
    const Eigen::Vector3d origin =
        on_base ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : chain.bodies[static_cast<std::size_t>(site.body)].origin;
    XMLElement* frame = model.InsertNewChildElement("frame");
    frame->SetAttribute("name", site.name.c_str());
    frame->SetAttribute("attached_to",
                        (on_base ? chain.base : chain.bodies[static_cast<std::size_t>(site.body)].name).c_str());
    // As a quaternion: flanges often stand where roll and yaw of the other form are one.
    const Eigen::Quaterniond turn(site.base_from_site.linear());
    addText(*frame, "pose",
            fmt::format("{} {} {} {} {}", written(Eigen::Vector3d(site.base_from_site.translation() - origin)),
                        turn.x() + 0.0, turn.y() + 0.0, turn.z() + 0.0, turn.w() + 0.0));
    frame->FirstChildElement("pose")->SetAttribute("rotation_format", "quat_xyzw");
  }
}

}  // namespace

std::string sdf(const ElasticChain& chain, const std::vector<std::string>& comments) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* root = document.NewElement("sdf");
  document.InsertEndChild(root);
  root->SetAttribute("version", "1.9");
  for (const std::string& comment : comments) root->InsertNewComment(commentText(comment).c_str());
  XMLElement* world = root->InsertNewChildElement("world");
  world->SetAttribute("name", (chain.name + "_world").c_str());
  addText(*world, "gravity", written(chain.gravity));
  XMLElement* model = world->InsertNewChildElement("model");
  model->SetAttribute("name", chain.name.c_str());
  addFixedBase(*model, chain.base);
  std::string parent = chain.base;
  for (const ChainBody& body : chain.bodies) {
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
      const bool last = j + 1 == body.joints.size();
      const std::string child = last ? body.name : body.joints[j].name + "_between";
      addLink(*model, child, body.origin, last ? body.mass : ChainMass());
      addSdfJoint(*model, body.joints[j], parent, child, body.origin);
      parent = child;
    }
  }
  addFrames(*model, chain);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace stiffscope::elastic_model
