#include <gtest/gtest.h>
#include <tinyxml2.h>
#include "core/validation/run_blind.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/page/pages.h"
#include "reports/text/text.h"

namespace stiffscope {

namespace blind_page_test {

validation::BlindResult smallResult() {
  std::vector<validation::Label> labels(2);
  labels[0].name = "0001";
  labels[1].name = "0002";
  labels[1].kind = validation::CaseKind::single;
  labels[1].effects = {{"hysteresis", "joint 2", "deflection", 3.0, 3.0, 0.0}};
  labels[1].shrink_seen = 0.5;
  std::vector<validation::Answer> answers(2);
  answers[0].name = "0001";
  answers[1].name = "0002";
  answers[1].entries = {{{"hysteresis", "backlash"}, ""}};
  answers[1].promises = {{{"hysteresis", "backlash"}, 0.55, 0.4, 0.6, 0.9}};
  return {std::string(64, 'a'), std::string(64, 'b'), validation::score(labels, answers)};
}

TEST(BlindReport, pageIsWellFormedAndSelfContained) {
  const std::string page = page::blindPage({}, smallResult());
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(page.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  for (const char* words : {"hysteresis", "background:rgba(40,140,80", "55\xC2\xA0%", "5 and more"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_NE(page.find(std::string(64, 'a')), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST(BlindReport, pageOfDaysWithoutALoadSaysSo) {
  validation::BlindOptions options;
  options.unloaded = true;
  const std::string page = page::blindPage(options, smallResult());
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(page.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  EXPECT_NE(page.find("2 simulated machines on days without a load"), std::string::npos);
  EXPECT_EQ(page.find("wrist sweep"), std::string::npos);
  EXPECT_EQ(reports::blindJson(options, smallResult())["unloaded"], true);
  EXPECT_FALSE(reports::blindJson({}, smallResult()).contains("unloaded"));
}

TEST(BlindReport, jsonHasWhatTheContractAsks) {
  const reports::Json json = reports::blindJson({}, smallResult());
  EXPECT_EQ(json["seal"], std::string(64, 'a'));
  EXPECT_EQ(json["cases"].size(), 2u);
  EXPECT_EQ(json["cases"][0]["verdict"], reports::Json::parse("[[\"none\"]]"));
  EXPECT_EQ(json["cases"][1]["truth"][0]["effect"], "hysteresis");
  EXPECT_EQ(json["rates"]["singles"]["hits"], 1);
  EXPECT_EQ(json["rates"]["unknown"]["value"], nullptr);
  EXPECT_EQ(json["confusion"]["counts"].size(), json["confusion"]["truths"].size());
  EXPECT_EQ(json["shrink"][0]["promised"]["low"], 0.4);
}

TEST(BlindReport, textNamesTheRates) {
  const std::string text = reports::blindText(smallResult());
  EXPECT_NE(text.find("singles: the effect and nothing else"), std::string::npos);
  EXPECT_NE(text.find("1/1"), std::string::npos);
  EXPECT_NE(text.find("no case"), std::string::npos);
}

}  // namespace blind_page_test

}  // namespace stiffscope
