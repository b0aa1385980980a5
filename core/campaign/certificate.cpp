#include "core/campaign/certificate.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "core/campaign/iso_date.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/xml.h"

namespace stiffscope::campaign {

namespace {

constexpr std::array<const char*, 5> kPlaces{"laboratory", "customer", "laboratoryBranch", "customerBranch", "other"};

bool isCode(const std::string& text, char first, char last) {
  return text.size() == 2 && std::all_of(text.begin(), text.end(), [&](char c) { return c >= first && c <= last; });
}

std::string textOf(const io::XmlNode& node, const char* attribute) { return node.attribute(attribute).value_or(""); }

std::string countryOf(const io::XmlNode& node) {
  const std::string country = textOf(node, "country");
  if (!country.empty() && !isCode(country, 'A', 'Z'))
    node.refuse("country", country, "expected a country of ISO 3166-1, two capital letters such as DE");
  return country;
}

std::string dateOf(const io::XmlNode& node, const char* attribute) {
  const std::string date = textOf(node, attribute);
  if (!date.empty() && !isIsoDate(date)) node.refuse(attribute, date, "expected a date such as 2026-11-21");
  return date;
}

std::vector<std::string> languagesOf(const io::XmlNode& node) {
  std::vector<std::string> languages;
  std::istringstream words(textOf(node, "languages"));
  for (std::string word; words >> word;) {
    if (!isCode(word, 'a', 'z'))
      node.refuse("languages", word, "expected languages of ISO 639-1, two small letters each such as en");
    languages.push_back(word);
  }
  return languages;
}

void readParty(const io::XmlNode& parent, const char* name, CertificateParty& party,
               std::vector<std::string>& warnings) {
  const auto node = parent.child(name);
  if (!node) return;
  io::warnOfUnknown(*node, {"name", "email", "phone", "street", "postcode", "city", "country", "code", "role"}, {},
                    warnings);
  if (node->has("name")) party.name = textOf(*node, "name");
  party.email = textOf(*node, "email");
  party.phone = textOf(*node, "phone");
  party.street = textOf(*node, "street");
  party.postcode = textOf(*node, "postcode");
  party.city = textOf(*node, "city");
  party.country = countryOf(*node);
  party.code = textOf(*node, "code");
  party.role = textOf(*node, "role");
}

void readElement(const io::XmlNode& node, Certificate& certificate, std::vector<std::string>& warnings) {
  io::warnOfUnknown(node, {"number", "country", "languages", "begin", "end", "issued", "place"},
                    {"laboratory", "customer", "responsible", "item"}, warnings);
  certificate.number = textOf(node, "number");
  certificate.country = countryOf(node);
  certificate.languages = languagesOf(node);
  if (node.has("begin")) certificate.begin = dateOf(node, "begin");
  if (node.has("end")) certificate.end = dateOf(node, "end");
  certificate.issued = dateOf(node, "issued");
  if (!certificate.begin.empty() && !certificate.end.empty() && certificate.end < certificate.begin)
    node.refuse(node.has("end") ? "end" : "begin", node.has("end") ? certificate.end : certificate.begin,
                "expected the end of the calibration on its beginning or after it; it is from " + certificate.begin +
                    " to " + certificate.end);
  certificate.place = textOf(node, "place");
  const std::vector<std::string> places(kPlaces.begin(), kPlaces.end());
  if (!certificate.place.empty() && std::find(places.begin(), places.end(), certificate.place) == places.end())
    node.refuse("place", certificate.place,
                "expected laboratory, customer, laboratoryBranch, customerBranch or other" +
                    io::nearestNameHint(certificate.place, places));
  readParty(node, "laboratory", certificate.laboratory, warnings);
  readParty(node, "customer", certificate.customer, warnings);
  readParty(node, "responsible", certificate.responsible, warnings);
  if (const auto item = node.child("item")) {
    io::warnOfUnknown(*item, {"name", "manufacturer", "model", "serial"}, {}, warnings);
    if (item->has("name")) certificate.item = textOf(*item, "name");
    certificate.manufacturer = textOf(*item, "manufacturer");
    certificate.model = textOf(*item, "model");
    certificate.serial = textOf(*item, "serial");
  }
}

}  // namespace

std::vector<std::string> Certificate::missing() const {
  std::vector<std::string> missing;
  const auto need = [&missing](bool there, const char* name) {
    if (!there) missing.emplace_back(name);
  };
  need(!number.empty(), "certificate number");
  need(!country.empty(), "certificate country");
  need(!languages.empty(), "certificate languages");
  need(!begin.empty(), "certificate begin");
  need(!end.empty(), "certificate end");
  need(!place.empty(), "certificate place");
  need(!laboratory.name.empty(), "certificate/laboratory name");
  need(laboratory.located(), "certificate/laboratory city or country");
  need(!customer.name.empty(), "certificate/customer name");
  need(customer.located(), "certificate/customer city or country");
  need(!responsible.name.empty(), "certificate/responsible name");
  need(!item.empty(), "certificate/item name");
  need(!serial.empty(), "certificate/item serial");
  return missing;
}

Certificate readCertificate(const Campaign& campaign, std::vector<std::string>& warnings) {
  Certificate certificate;
  certificate.laboratory.name = campaign.texts.laboratory;
  certificate.customer.name = campaign.texts.customer;
  certificate.item = campaign.texts.item.empty() ? campaign.robot.name : campaign.texts.item;
  if (isIsoDate(campaign.date)) certificate.begin = certificate.end = campaign.date;
  const std::filesystem::path file = campaign.folder / campaign.inputs.front().name;
  const std::string bytes = io::readTextFile(file);
  const io::XmlFile xml(file.string(), bytes);
  if (const auto node = xml.root().child("certificate")) readElement(*node, certificate, warnings);
  return certificate;
}

}  // namespace stiffscope::campaign
