#include "core/elastic_model/simulator_models.h"

#include <tinyxml2.h>
#include <algorithm>
#include <cmath>

#include "core/elastic_model/written.h"

namespace stiffscope::elastic_model {

namespace {

using tinyxml2::XMLElement;

std::string quaternionOf(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return fmt::format("{} {} {} {}", q.w() + 0.0, q.x() + 0.0, q.y() + 0.0, q.z() + 0.0);
}

void addInertial(XMLElement& node, const ChainBody& body) {
  XMLElement* inertial = node.InsertNewChildElement("inertial");
  if (body.mass.mass_kg <= 0.0) {
    inertial->SetAttribute("pos", "0 0 0");
    inertial->SetAttribute("mass", written(kStandInMass).c_str());
    inertial->SetAttribute("diaginertia", written(Eigen::Vector3d::Constant(kStandInInertia)).c_str());
    return;
  }
  const Eigen::Matrix3d& about = body.mass.inertia;
  inertial->SetAttribute("pos", written(Eigen::Vector3d(body.mass.centre - body.origin)).c_str());
  inertial->SetAttribute("mass", written(body.mass.mass_kg).c_str());
  inertial->SetAttribute("fullinertia", (written(Eigen::Vector3d(about.diagonal())) + ' ' +
                                         written(Eigen::Vector3d(about(0, 1), about(0, 2), about(1, 2))))
                                            .c_str());
}

/// Of the drives' position control, N m/rad: its own give is the least part of any joint's.
double driveGain(const ElasticChain& chain) {
  double stiffest = 1e6;
  for (const ChainBody& body : chain.bodies) {
    for (const ChainJoint& joint : body.joints) {
      if (joint.kind == ChainJoint::Kind::turn_spring) stiffest = std::max(stiffest, joint.stiffness);
    }
  }
  return kDriveGain * stiffest;
}

void addMjcfJoint(XMLElement& node, const ChainBody& body, const ChainJoint& joint, double gain) {
  XMLElement* element = node.InsertNewChildElement("joint");
  const bool drive = joint.kind == ChainJoint::Kind::drive, shift = joint.kind == ChainJoint::Kind::shift_spring;
  element->SetAttribute("name", joint.name.c_str());
  element->SetAttribute("type", shift ? "slide" : "hinge");
  if (!shift) element->SetAttribute("pos", written(Eigen::Vector3d(joint.point - body.origin)).c_str());
  element->SetAttribute("axis", written(joint.direction).c_str());
  element->SetAttribute("damping", written(kDampingTime * (drive ? gain : joint.stiffness)).c_str());
  if (!drive) {
    element->SetAttribute("stiffness", written(joint.stiffness).c_str());
    element->SetAttribute("springref", "0");
  } else if (std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
    element->SetAttribute("limited", "true");
    element->SetAttribute("range", fmt::format("{} {}", joint.lower, joint.upper).c_str());
  }
}

void addMjcfSites(XMLElement& node, const ElasticChain& chain, int body) {
  const Eigen::Vector3d origin =
      body < 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : chain.bodies[static_cast<std::size_t>(body)].origin;
  for (const ChainSite& site : chain.sites) {
    if (site.body != body) continue;
    XMLElement* element = node.InsertNewChildElement("site");
    element->SetAttribute("name", site.name.c_str());
    element->SetAttribute("pos", written(Eigen::Vector3d(site.base_from_site.translation() - origin)).c_str());
    element->SetAttribute("quat", quaternionOf(site.base_from_site.linear()).c_str());
  }
}

void addDrives(XMLElement& root, const ElasticChain& chain, double gain) {
  XMLElement* actuators = root.InsertNewChildElement("actuator");
  for (const ChainBody& body : chain.bodies) {
    for (const ChainJoint& joint : body.joints) {
      if (joint.kind != ChainJoint::Kind::drive) continue;
      XMLElement* drive = actuators->InsertNewChildElement("position");
      drive->SetAttribute("name", ("drive_" + joint.name).c_str());
      drive->SetAttribute("joint", joint.name.c_str());
      drive->SetAttribute("kp", written(gain).c_str());
    }
  }
}

}  // namespace

std::string mjcf(const ElasticChain& chain, const std::vector<std::string>& comments) {
  const double gain = driveGain(chain);
  tinyxml2::XMLDocument document;
  XMLElement* root = document.NewElement("mujoco");
  document.InsertEndChild(root);
  root->SetAttribute("model", chain.name.c_str());
  for (const std::string& comment : comments) root->InsertNewComment(commentText(comment).c_str());
  root->InsertNewChildElement("compiler")->SetAttribute("angle", "radian");
  XMLElement* option = root->InsertNewChildElement("option");
  option->SetAttribute("gravity", written(chain.gravity).c_str());
  option->SetAttribute("timestep", written(kTimeStep).c_str());
  XMLElement* parent = root->InsertNewChildElement("worldbody");
  addMjcfSites(*parent, chain, -1);
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  for (std::size_t b = 0; b < chain.bodies.size(); ++b) {
    const ChainBody& body = chain.bodies[b];
    XMLElement* element = parent->InsertNewChildElement("body");
    element->SetAttribute("name", body.name.c_str());
    element->SetAttribute("pos", written(Eigen::Vector3d(body.origin - inside)).c_str());
    addInertial(*element, body);
    for (const ChainJoint& joint : body.joints) addMjcfJoint(*element, body, joint, gain);
    addMjcfSites(*element, chain, static_cast<int>(b));
    inside = body.origin;
    parent = element;
  }
  addDrives(*root, chain, gain);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace stiffscope::elastic_model
