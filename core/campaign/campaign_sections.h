#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign_xml.h"
#include "core/input/xml_node.h"

// One function a section of campaign.xml; each takes the section's element, converts to SI and radians, and
// throws InputError for what the format does not allow.

namespace stiffscope {

Tracker readTracker(const XmlNode& node, std::vector<std::string>& warnings);
std::vector<Target> readTargets(const XmlNode& node, std::vector<std::string>& warnings);
LoadCell readLoadCell(const XmlNode& node, std::vector<std::string>& warnings);
Tool readTool(const XmlNode& node, std::vector<std::string>& warnings);
TableReference readTableReference(const XmlNode& node, std::vector<std::string>& warnings);

}  // namespace stiffscope
