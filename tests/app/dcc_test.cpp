// `export dcc`: what is in the certificate, what is asked for, and PTB's schema where a copy of it is at hand.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/app/command.h"

namespace stiffscope {
namespace dcc_test {

namespace fs = std::filesystem;

const char* const kCertificate =
    "<certificate number=\"2026-017\" country=\"DE\" languages=\"de en\" begin=\"2026-11-20\" end=\"2026-11-21\" "
    "place=\"customer\">\n"
    "  <laboratory name=\"Messlabor &amp; Co\" email=\"lab@example.org\" street=\"Weg 1\" postcode=\"12345\" "
    "city=\"Ort\" country=\"DE\" code=\"D-K-00000\"/>\n"
    "  <customer name=\"Werk\" city=\"Stadt\"/>\n"
    "  <responsible name=\"A. Muster\" role=\"head of the laboratory\"/>\n"
    "  <item name=\"Robot 4\" manufacturer=\"Maker\" model=\"Type 7\" serial=\"S-0815\"/>\n"
    "</certificate>\n";

/// The sample with that element.
fs::path day(const ScratchFolder& scratch, const std::string& certificate) {
  const fs::path folder = scratch.path() / "day";
  fs::copy(STIFFSCOPE_SOURCE_DIR "/samples/active", folder);
  std::string xml = contentsOf(folder / "campaign.xml");
  xml.insert(xml.find("<tracker"), certificate);
  std::ofstream(folder / "campaign.xml", std::ios::binary) << xml;
  return folder;
}

std::string only(const std::string& xml, const std::string& element) {
  std::smatch found;
  const std::regex text("<" + element + "[^>]*>([^<]*)</" + element + ">");
  return std::regex_search(xml, found, text) ? found[1].str() : std::string("(none)");
}

TEST(Dcc, HoldsTheStiffnessesAsOneList) {
  const ScratchFolder scratch;
  const fs::path folder = day(scratch, kCertificate), out = scratch.path() / "dcc.xml";
  const Ran ran = runProgram(
      "export dcc '" + folder.string() + "' --springs-only --method pp --out '" + out.string() + "'", scratch.path());
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err.find("unknown"), std::string::npos) << ran.err;
  const std::string xml = contentsOf(out);
  EXPECT_NE(xml.find("schemaVersion=\"3.3.0\""), std::string::npos);
  EXPECT_EQ(only(xml, "dcc:uniqueIdentifier"), "2026-017");
  EXPECT_EQ(only(xml, "dcc:countryCodeISO3166_1"), "DE");
  EXPECT_EQ(only(xml, "dcc:mandatoryLangCodeISO639_1"), "de");
  EXPECT_EQ(only(xml, "dcc:performanceLocation"), "customer");
  EXPECT_NE(xml.find("Messlabor &amp; Co"), std::string::npos);
  EXPECT_EQ(only(xml, "si:labelXMLList"), "k2 k3 k4 k5 k6");
  EXPECT_EQ(only(xml, "si:unitXMLList"), "\\newton\\metre\\radian\\tothe{-1}");
  EXPECT_EQ(only(xml, "si:coverageProbabilityXMLList"), "0.95");
  EXPECT_NE(xml.find("k1 is not identifiable"), std::string::npos);
  EXPECT_NE(xml.find("No agreed vocabulary"), std::string::npos);
  // The numbers are those of identify.
  const Ran identified =
      runProgram("identify '" + folder.string() + "' --springs-only --method pp --json -", scratch.path());
  const nlohmann::json method = nlohmann::json::parse(identified.out)["methods"]["pp"];
  std::istringstream values(only(xml, "si:valueXMLList")), expanded(only(xml, "si:valueExpandedMUXMLList")),
      factors(only(xml, "si:coverageFactorXMLList"));
  for (std::size_t joint = 1; joint < 6; ++joint) {
    double value = 0.0, u = 0.0, factor = 0.0;
    ASSERT_TRUE(values >> value && expanded >> u && factors >> factor);
    const double sd = method["sd_nm_per_rad"][joint];
    EXPECT_NEAR(value, method["stiffness_nm_per_rad"][joint].get<double>(), 0.5);  // whole Nm/rad
    EXPECT_NEAR(u, factor * sd, 1.0 + 0.005 * sd);                                 // two decimals of the factor
    EXPECT_GT(factor, 1.9);
  }
  const std::string again = xml;
  ASSERT_EQ(runProgram("export dcc '" + folder.string() + "' --springs-only --method pp --out '" + out.string() + "'",
                       scratch.path())
                .status,
            0);
  EXPECT_EQ(contentsOf(out), again);
}

TEST(Dcc, RefusesWithTheListOfWhatIsMissing) {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "dcc.xml";
  const Ran ran =
      runProgram("export dcc '" STIFFSCOPE_SOURCE_DIR "/samples/active' --out '" + out.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 2);
  for (const char* missing : {"certificate number", "certificate country", "certificate languages", "certificate place",
                              "certificate/laboratory name", "certificate/customer name",
                              "certificate/responsible name", "certificate/item serial"})
    EXPECT_NE(ran.err.find(missing), std::string::npos) << missing << " in " << ran.err;
  EXPECT_EQ(ran.err.find("certificate begin"), std::string::npos) << "the campaign's date stands for it";
  EXPECT_FALSE(fs::exists(out));
}

TEST(Dcc, RefusesWhatIsNoCountryLanguageDateOrPlace) {
  const std::vector<std::pair<std::string, std::string>> spoilt{
      {"country=\"DE\" languages", "country: 'Germany': expected a country of ISO 3166-1"},
      {"languages=\"de en\"", "languages: 'German': expected languages of ISO 639-1"},
      {"begin=\"2026-11-20\"", "begin: '20.11.2026': expected a date such as 2026-11-21"},
      {"begin=\"2026-11-20\"", "begin: '2026-11-31': expected a date such as 2026-11-21"},
      {"begin=\"2026-11-20\"", "end: '2026-11-21': expected the end of the calibration on its beginning or after it"},
      {"place=\"customer\"",
       "place: 'customr': expected laboratory, customer, laboratoryBranch, customerBranch or other"}};
  const std::vector<std::string> by{"country=\"Germany\" languages", "languages=\"German\"", "begin=\"20.11.2026\"",
                                    "begin=\"2026-11-31\"",          "begin=\"2026-11-22\"", "place=\"customr\""};
  for (std::size_t i = 0; i < spoilt.size(); ++i) {
    const ScratchFolder scratch;
    std::string certificate = kCertificate;
    certificate.replace(certificate.find(spoilt[i].first), spoilt[i].first.size(), by[i]);
    const fs::path folder = day(scratch, certificate);
    const Ran ran = runProgram(
        "export dcc '" + folder.string() + "' --out '" + (scratch.path() / "dcc.xml").string() + "'", scratch.path());
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.err.find(spoilt[i].second), std::string::npos) << ran.err;
  }
}

// STIFFSCOPE_DCC_XSD names dcc.xsd, SI_Format.xsd beside it as it imports that; PTB publishes both.
TEST(Dcc, IsValidByTheSchema) {
  const char* schema = std::getenv("STIFFSCOPE_DCC_XSD");
  if (schema == nullptr) GTEST_SKIP() << "STIFFSCOPE_DCC_XSD does not name a copy of dcc.xsd";
  if (std::system("command -v xmllint >/dev/null") != 0) GTEST_SKIP() << "no xmllint (libxml2-utils)";
  const ScratchFolder scratch;
  const fs::path folder = day(scratch, kCertificate), out = scratch.path() / "dcc.xml";
  ASSERT_EQ(
      runProgram("export dcc '" + folder.string() + "' --springs-only --out '" + out.string() + "'", scratch.path())
          .status,
      0);
  const std::string command = "xmllint --nonet --noout --schema '" + std::string(schema) + "' '" + out.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace dcc_test
}  // namespace stiffscope
