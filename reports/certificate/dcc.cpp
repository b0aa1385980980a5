#include "reports/certificate/dcc.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "reports/json/campaign_json.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"

namespace stiffscope::reports {

namespace {

using tinyxml2::XMLElement;

constexpr const char* kStiffnessUnit = R"(\newton\metre\radian\tothe{-1})";  // as D-SI spells it

void addLeaf(XMLElement& parent, const char* name, const std::string& text) {
  if (!text.empty()) parent.InsertNewChildElement(name)->SetText(text.c_str());
}

/// A text in the language of this program's words.
void addText(XMLElement& parent, const char* name, const std::string& text) {
  XMLElement* content = parent.InsertNewChildElement(name)->InsertNewChildElement("dcc:content");
  content->SetAttribute("lang", "en");
  content->SetText(text.c_str());
}

/// A name out of campaign.xml, in whatever language it is.
void addName(XMLElement& parent, const std::string& text) {
  parent.InsertNewChildElement("dcc:name")->InsertNewChildElement("dcc:content")->SetText(text.c_str());
}

void addContact(XMLElement& contact, const campaign::CertificateParty& party) {
  addName(contact, party.name);
  addLeaf(contact, "dcc:eMail", party.email);
  addLeaf(contact, "dcc:phone", party.phone);
  if (!party.located()) return;
  XMLElement& location = *contact.InsertNewChildElement("dcc:location");
  addLeaf(location, "dcc:city", party.city);
  addLeaf(location, "dcc:countryCode", party.country);
  addLeaf(location, "dcc:postCode", party.postcode);
  addLeaf(location, "dcc:street", party.street);
}

void addSoftware(XMLElement& list, const DccContent& content) {
  XMLElement& software = *list.InsertNewChildElement("dcc:software");
  addName(software, "stiffscope");
  addLeaf(software, "dcc:release", content.version);
  addLeaf(software, "dcc:type", "application");
}

void addCoreData(XMLElement& administrative, const campaign::Certificate& certificate) {
  XMLElement& core = *administrative.InsertNewChildElement("dcc:coreData");
  addLeaf(core, "dcc:countryCodeISO3166_1", certificate.country);
  std::vector<std::string> used = certificate.languages;
  // What this program says is English.
  if (std::find(used.begin(), used.end(), "en") == used.end()) used.emplace_back("en");
  for (const std::string& language : used) addLeaf(core, "dcc:usedLangCodeISO639_1", language);
  addLeaf(core, "dcc:mandatoryLangCodeISO639_1", certificate.languages.front());
  addLeaf(core, "dcc:uniqueIdentifier", certificate.number);
  addLeaf(core, "dcc:beginPerformanceDate", certificate.begin);
  addLeaf(core, "dcc:endPerformanceDate", certificate.end);
  addLeaf(core, "dcc:performanceLocation", certificate.place);
  addLeaf(core, "dcc:issueDate", certificate.issued);
}

void addItem(XMLElement& administrative, const campaign::Certificate& certificate) {
  XMLElement& item = *administrative.InsertNewChildElement("dcc:items")->InsertNewChildElement("dcc:item");
  addName(item, certificate.item);
  if (!certificate.manufacturer.empty())
    addName(*item.InsertNewChildElement("dcc:manufacturer"), certificate.manufacturer);
  addLeaf(item, "dcc:model", certificate.model);
  XMLElement& identification =
      *item.InsertNewChildElement("dcc:identifications")->InsertNewChildElement("dcc:identification");
  addLeaf(identification, "dcc:issuer", "manufacturer");
  addLeaf(identification, "dcc:value", certificate.serial);
  addText(identification, "dcc:name", "serial number");
}

void addAdministrativeData(XMLElement& root, const DccContent& content) {
  const campaign::Certificate& certificate = content.certificate;
  XMLElement& administrative = *root.InsertNewChildElement("dcc:administrativeData");
  addSoftware(*administrative.InsertNewChildElement("dcc:dccSoftware"), content);
  addCoreData(administrative, certificate);
  addItem(administrative, certificate);
  XMLElement& laboratory = *administrative.InsertNewChildElement("dcc:calibrationLaboratory");
  addLeaf(laboratory, "dcc:calibrationLaboratoryCode", certificate.laboratory.code);
  addContact(*laboratory.InsertNewChildElement("dcc:contact"), certificate.laboratory);
  XMLElement& responsible =
      *administrative.InsertNewChildElement("dcc:respPersons")->InsertNewChildElement("dcc:respPerson");
  addContact(*responsible.InsertNewChildElement("dcc:person"), certificate.responsible);
  addLeaf(responsible, "dcc:role", certificate.responsible.role);
  addLeaf(responsible, "dcc:mainSigner", "true");
  addContact(*administrative.InsertNewChildElement("dcc:customer"), certificate.customer);
}

/// Joints whose stiffness has a value and a finite U.
std::vector<int> listedJoints(const DccContent& content) {
  const identification::StiffnessEstimate& estimate = content.result.of(content.method).estimate;
  std::vector<int> joints;
  for (int joint = 0; joint < estimate.joints(); ++joint) {
    if (estimate.identifiable[static_cast<std::size_t>(joint)] && estimate.compliance[joint] > 0.0 &&
        std::isfinite(identification::expandedUncertainty(estimate, joint)))
      joints.push_back(joint);
  }
  return joints;
}

/// Why a joint is not in the list.
std::string notListedWords(const DccContent& content, int joint) {
  const identification::StiffnessEstimate& estimate = content.result.of(content.method).estimate;
  if (!estimate.identifiable[static_cast<std::size_t>(joint)])
    return fmt::format("k{} is not identifiable: {}", joint + 1,
                       words(content.result.identifiability.joints[static_cast<std::size_t>(joint)].reason));
  if (estimate.compliance[joint] <= 0.0)
    return fmt::format("k{} came out negative, which no spring has; it is not stated", joint + 1);
  const identification::CoverageInterval interval = identification::stiffnessInterval(estimate, joint);
  return fmt::format("k{} is only known to be above {:.0f} Nm/rad", joint + 1, interval.low);
}

/// "5582763 6390912": D-SI lists are decimal numbers between blanks.
template <class NumberOf>
std::string listOf(const std::vector<int>& joints, int decimals, const NumberOf& number_of) {
  std::vector<std::string> numbers;
  for (const int joint : joints) numbers.push_back(fmt::format("{:.{}f}", number_of(joint), decimals));
  return fmt::format("{}", fmt::join(numbers, " "));
}

void addStiffnessList(XMLElement& data, const DccContent& content, const std::vector<int>& joints) {
  const identification::StiffnessEstimate& estimate = content.result.of(content.method).estimate;
  XMLElement& quantity = *data.InsertNewChildElement("dcc:quantity");
  addText(quantity, "dcc:name", "Joint stiffness k, torque over rotation about the joint's axis");
  XMLElement& list = *quantity.InsertNewChildElement("si:realListXMLList");
  std::vector<std::string> labels;
  for (const int joint : joints) labels.push_back(fmt::format("k{}", joint + 1));
  addLeaf(list, "si:labelXMLList", fmt::format("{}", fmt::join(labels, " ")));
  addLeaf(list, "si:valueXMLList", listOf(joints, 0, [&](int joint) { return estimate.stiffness(joint); }));
  addLeaf(list, "si:unitXMLList", kStiffnessUnit);
  XMLElement& expanded = *list.InsertNewChildElement("si:measurementUncertaintyUnivariateXMLList")
                              ->InsertNewChildElement("si:expandedMUXMLList");
  const auto u = [&](int joint) { return identification::expandedUncertainty(estimate, joint); };
  addLeaf(expanded, "si:valueExpandedMUXMLList", listOf(joints, 0, [&](int joint) { return std::ceil(u(joint)); }));
  addLeaf(expanded, "si:coverageFactorXMLList",
          listOf(joints, 2, [&](int joint) { return std::max(1.0, u(joint) / estimate.stiffnessSd(joint)); }));
  addLeaf(expanded, "si:coverageProbabilityXMLList", fmt::format("{:g}", identification::kStatedCoverage));
}

void addMethod(XMLElement& measured, const DccContent& content) {
  XMLElement& method = *measured.InsertNewChildElement("dcc:usedMethods")->InsertNewChildElement("dcc:usedMethod");
  addText(method, "dcc:name", fmt::format("{} identification of joint stiffness", namesOf(content.method).full));
  addText(method, "dcc:description",
          "Displacements of reflectors on the tool under measured loads, by laser tracker, against the torques of the "
          "joints. U is the farther end of the interval that holds the truth with the stated probability.");
  addLeaf(method, "dcc:reference", "Ambiehl, Garnier, Subrin, Furet, IROS 2017, doi 10.1109/IROS.2017.8205950");
}

void addEquipment(XMLElement& measured, const campaign::Campaign& campaign) {
  if (!campaign.tracker || campaign.tracker->model.empty()) return;
  XMLElement& tracker =
      *measured.InsertNewChildElement("dcc:measuringEquipments")->InsertNewChildElement("dcc:measuringEquipment");
  addName(tracker, campaign.tracker->model);
}

void addConditions(XMLElement& measured, const campaign::Campaign& campaign) {
  if (campaign.texts.conditions.empty()) return;
  XMLElement& condition =
      *measured.InsertNewChildElement("dcc:influenceConditions")->InsertNewChildElement("dcc:influenceCondition");
  addText(condition, "dcc:name", "Conditions as stated by the laboratory");
  condition.InsertNewChildElement("dcc:data")
      ->InsertNewChildElement("dcc:text")
      ->InsertNewChildElement("dcc:content")
      ->SetText(campaign.texts.conditions.c_str());
}

void addResults(XMLElement& root, const DccContent& content) {
  XMLElement& measured =
      *root.InsertNewChildElement("dcc:measurementResults")->InsertNewChildElement("dcc:measurementResult");
  addText(measured, "dcc:name", "Joint stiffness of an industrial robot");
  addMethod(measured, content);
  addEquipment(measured, content.campaign);
  addConditions(measured, content.campaign);
  XMLElement& result = *measured.InsertNewChildElement("dcc:results")->InsertNewChildElement("dcc:result");
  addText(result, "dcc:name", "Stiffness of the joints");
  XMLElement& data = *result.InsertNewChildElement("dcc:data");
  const std::vector<int> joints = listedJoints(content);
  if (!joints.empty()) addStiffnessList(data, content, joints);
  for (int joint = 0; joint < content.result.of(content.method).estimate.joints(); ++joint) {
    if (std::find(joints.begin(), joints.end(), joint) == joints.end())
      addText(data, "dcc:text", notListedWords(content, joint));
  }
  addText(data, "dcc:text",
          content.model == nullptr
              ? std::string("The model has joint springs alone.")
              : fmt::format("The model has besides joint springs: {}.", addedNames(content.model->effects)));
}

}  // namespace

std::string dccXml(const DccContent& content) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* root = document.NewElement("dcc:digitalCalibrationCertificate");
  document.InsertEndChild(root);
  root->SetAttribute("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
  root->SetAttribute("xmlns:dcc", "https://ptb.de/dcc");
  root->SetAttribute("xmlns:si", "https://ptb.de/si");
  root->SetAttribute("xsi:schemaLocation",
                     fmt::format("https://ptb.de/dcc https://ptb.de/dcc/v{}/dcc.xsd", kDccSchema).c_str());
  root->SetAttribute("schemaVersion", kDccSchema);
  addAdministrativeData(*root, content);
  addResults(*root, content);
  XMLElement* note = root->InsertNewChildElement("dcc:comment")->InsertNewChildElement("note");
  note->SetAttribute("lang", "en");
  note->SetText(
      "No agreed vocabulary for the stiffness of robots exists: there are no refTypes, and quantities are named in "
      "words. Unsigned.");
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

Json dccExportJson(const DccContent& content, const std::string& file) {
  Json joints = Json::array();
  for (const int joint : listedJoints(content)) joints.push_back(joint + 1);
  return {{"campaign", campaignJson(content.campaign)},
          {"method", namesOf(content.method).key},
          {"format", "dcc"},
          {"file", file},
          {"schema", kDccSchema},
          {"number", content.certificate.number},
          {"joints", joints}};
}

std::string dccExportText(const DccContent& content, const std::string& file) {
  std::vector<std::string> joints;
  for (const int joint : listedJoints(content)) joints.push_back(fmt::format("k{}", joint + 1));
  std::string text =
      fmt::format("{}: certificate {} of {} by {}\n", content.campaign.name, content.certificate.number,
                  joints.empty() ? "no joint" : fmt::format("{}", fmt::join(joints, ", ")), longName(content.method));
  return text + fmt::format("{}: written (DCC {}, not signed)\n", file, kDccSchema);
}

}  // namespace stiffscope::reports
