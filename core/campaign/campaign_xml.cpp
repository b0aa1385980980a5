#include "core/campaign/campaign_xml.h"

#include <fmt/format.h>

#include "core/campaign/campaign_sections.h"
#include "core/input/nearest_name.h"
#include "core/input/xml_node.h"

namespace stiffscope {

namespace {

const std::vector<std::pair<std::string, std::string CampaignTexts::*>>& textElements() {
  static const std::vector<std::pair<std::string, std::string CampaignTexts::*>> elements{
      {"laboratory", &CampaignTexts::laboratory},
      {"customer", &CampaignTexts::customer},
      {"operator", &CampaignTexts::operator_name},
      {"item", &CampaignTexts::item},
      {"conditions", &CampaignTexts::conditions}};
  return elements;
}

std::vector<std::string> knownElements() {
  std::vector<std::string> known{"robot", "tracker", "targets", "load_cell", "tool"};
  known.insert(known.end(), tableElements().begin(), tableElements().end());
  for (const auto& [name, member] : textElements()) known.push_back(name);
  return known;
}

void requireFormatOne(const XmlNode& root) {
  if (root.name() != "campaign") {
    root.refuse(root.name(), "", "expected <campaign> as the root of campaign.xml");
  }
  const std::string format = root.requiredAttribute("format");
  if (format != "1")
    root.refuse("format", format, "expected 1, the version of the format this program reads");
}

DoubleEncoder readDoubleEncoder(const XmlNode& node) {
  const std::string value = node.requiredAttribute("double_encoder");
  if (value == "active") return DoubleEncoder::active;
  if (value == "inactive") return DoubleEncoder::inactive;
  if (value == "unspecified") return DoubleEncoder::unspecified;
  node.refuse("double_encoder", value,
              "expected active, inactive or unspecified" +
                  nearestNameHint(value, {"active", "inactive", "unspecified"}));
}

void readRobotElement(const XmlNode& node, CampaignXml& xml, std::vector<std::string>& warnings) {
  warnOfUnknown(node, {"urdf", "base_link", "flange_link", "double_encoder", "gravity_m_s2"}, {}, warnings);
  xml.urdf = {node.requiredName("urdf"), "urdf", node.line()};
  xml.campaign.base_link = node.requiredName("base_link");
  xml.campaign.flange_link = node.requiredName("flange_link");
  xml.campaign.double_encoder = readDoubleEncoder(node);
  if (!node.has("gravity_m_s2")) return;
  xml.campaign.gravity_in_base = node.vector("gravity_m_s2");
  constexpr double kStrongest = 20.0;
  if (xml.campaign.gravity_in_base.norm() > kStrongest) {
    node.refuse("gravity_m_s2", node.requiredAttribute("gravity_m_s2"), "expected m/s^2, at most 20");
  }
}

void readSections(const XmlNode& root, CampaignXml& xml, std::vector<std::string>& warnings) {
  Campaign& campaign = xml.campaign;
  readRobotElement(root.requiredChild("robot"), xml, warnings);
  if (const auto node = root.child("tracker")) campaign.tracker = readTracker(*node, warnings);
  if (const auto node = root.child("targets")) campaign.targets = readTargets(*node, warnings);
  if (const auto node = root.child("load_cell")) {
    campaign.load_cell = readLoadCell(*node, warnings);
    xml.load_cell_line = node->line();
  }
  if (const auto node = root.child("tool")) campaign.tool = readTool(*node, warnings);
  for (const std::string& element : tableElements()) {
    if (const auto node = root.child(element)) xml.tables[element] = readTableReference(*node, warnings);
  }
  for (const auto& [name, member] : textElements()) {
    if (const auto node = root.child(name)) campaign.texts.*member = node->text();
  }
}

}  // namespace

const std::vector<std::string>& tableElements() {
  static const std::vector<std::string> elements{"circle_sweeps", "wrist_sweep",   "loading",
                                                 "states",        "displacements", "nests"};
  return elements;
}

CampaignXml readCampaignXml(const std::string& file, std::string_view bytes,
                            std::vector<std::string>& warnings) {
  const XmlFile xml_file(file, bytes);
  const XmlNode root = xml_file.root();
  requireFormatOne(root);
  warnOfUnknown(root, {"format", "name", "date"}, knownElements(), warnings);
  CampaignXml xml;
  xml.campaign.name = root.requiredAttribute("name");
  xml.campaign.date = root.requiredAttribute("date");
  readSections(root, xml, warnings);
  return xml;
}

}  // namespace stiffscope
