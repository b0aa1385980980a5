#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::campaign {

/// A laboratory, a customer, a person: as far as campaign.xml has it, empty where not.
struct CertificateParty {
  std::string name, email, phone, street, postcode, city;
  std::string country;  ///< ISO 3166-1, two letters
  std::string code;     ///< of an accredited laboratory
  std::string role;     ///< of a person
  bool located() const { return !(street.empty() && postcode.empty() && city.empty() && country.empty()); }
};

/// What a calibration certificate says besides results: the element `certificate` of campaign.xml
/// (docs/campaign-format.md), with the campaign's own texts where that does not have them.
struct Certificate {
  std::string number;                  ///< unique identifier of the certificate
  std::string country;                 ///< where it is issued, ISO 3166-1
  std::vector<std::string> languages;  ///< ISO 639-1
  std::string begin, end, issued;      ///< ISO 8601 dates; `issued` may stay empty
  std::string place;                   ///< laboratory, customer, laboratoryBranch, customerBranch or other
  CertificateParty laboratory, customer, responsible;
  std::string item, manufacturer, model, serial;  ///< of the machine; `manufacturer` and `model` may stay empty

  /// What must not be empty and is, as campaign.xml spells it: "certificate country", "certificate/item serial".
  std::vector<std::string> missing() const;
};

/// Reads it from the campaign's XML file. Throws InputError for a country, language, date or place that is none, and
/// for an end before the beginning; unknown attributes go to `warnings`.
Certificate readCertificate(const Campaign& campaign, std::vector<std::string>& warnings);

}  // namespace stiffscope::campaign
