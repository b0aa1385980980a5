#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <string>
#include <vector>
#include "reports/page/pages.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace page_contents_test {

// On a narrow screen they stand folded above what they are of, counted as the headings are.
TEST(PageContents, ComeFirstAndHaveAnEntryForEachSection) {
  const SmallResult small;
  tinyxml2::XMLDocument document;
  reports::ReportContent content;
  content.title = "A report";
  content.campaigns.push_back({small.campaign, small.identification});
  const std::string page = page::reportPage(content);
  ASSERT_EQ(document.Parse(page.c_str(), page.size()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  const auto* body = document.RootElement()->FirstChildElement("body");
  const auto* nav = body->FirstChildElement("nav");
  ASSERT_NE(nav, nullptr);
  EXPECT_STREQ(nav->NextSiblingElement()->Name(), "header");
  const auto* fold = nav->FirstChildElement("details");
  ASSERT_NE(fold, nullptr);
  EXPECT_STREQ(fold->FirstChildElement("summary")->GetText(), "Contents");
  std::vector<std::string> entries, sections;
  for (const auto* item = fold->FirstChildElement("ul")->FirstChildElement(); item; item = item->NextSiblingElement())
    entries.emplace_back(item->FirstChildElement("a")->Attribute("href"));
  const auto* main = body->FirstChildElement("main");
  for (const auto* one = main->FirstChildElement("section"); one != nullptr; one = one->NextSiblingElement("section"))
    sections.push_back(std::string("#") + one->Attribute("id"));
  EXPECT_EQ(entries, sections);
}

}  // namespace page_contents_test
}  // namespace stiffscope
