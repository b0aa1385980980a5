#include <gtest/gtest.h>
#include <tinyxml2.h>
#include "reports/page/html.h"
#include "reports/page/pages.h"
#include "reports/report_content.h"
#include "reports/words/names.h"
#include "reports/words/verdict.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace hostile_name_test {

reports::ReportContent contentOf(const SmallResult& small) {
  reports::ReportContent content;
  content.title = "Joint stiffness";
  content.campaigns.push_back({small.campaign, small.identification});
  content.campaigns.push_back({small.campaign, small.identification});  // two, so that headings carry the name
  content.verdict = reports::verdictOf(content.campaigns, {});
  content.settings = {{"load step", "1"}};
  return content;
}

/// Names of all elements and attributes, in order.
void skeleton(const tinyxml2::XMLElement* element, std::string& text) {
  text += std::string("<") + element->Name();
  for (const auto* one = element->FirstAttribute(); one != nullptr; one = one->Next()) text += ' ', text += one->Name();
  for (const auto* child = element->FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    skeleton(child, text);
  text += '>';
}

std::string skeletonOf(const std::string& page) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(page.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  std::string text;
  if (document.RootElement() != nullptr) skeleton(document.RootElement(), text);
  return text;
}

/// The small result with all that its campaign says in words, each the same.
SmallResult saying(const std::string& words) {
  SmallResult small;
  for (const campaign::NamedCampaignText& one : campaign::kCampaignTexts) small.campaign.texts.*one.text = words;
  return small;
}

TEST(HostileName, ChangesNothingButItsOwnText) {
  const SmallResult harmless;
  const std::string expected = skeletonOf(page::reportPage(contentOf(harmless)));
  for (const std::string& name :
       {std::string("<script>alert(1)</script>"), std::string("\"'><img src=x onerror=alert(1)>"),
        std::string(10'000, 'x'), std::string("\u202Eright to left \u05d0\u05d1\u05d2"),
        std::string("two\nlines\r\n\x1b[31mred"), std::string("sub_{script} `code` & &amp; \xff\xfe"),
        std::string("@{Stiffness} and mail@")}) {
    SmallResult hostile = saying(name);
    hostile.campaign.name = name;
    hostile.campaign.date = name;
    EXPECT_EQ(skeletonOf(page::reportPage(contentOf(hostile))), skeletonOf(page::reportPage(contentOf(saying("a")))))
        << name.substr(0, 40);
  }
  EXPECT_FALSE(expected.empty());
}

TEST(HostileName, StandsOnThePageToTheLetter) {
  SmallResult hostile;
  hostile.campaign.name = "a_{b} `c` <d>";
  EXPECT_NE(page::reportPage(contentOf(hostile)).find("<h3>a_{b} `c` &lt;d&gt;</h3>"), std::string::npos);
  EXPECT_EQ(reports::plain(reports::asIs("a_{b} `c`")), "a_{b} `c`");
}

TEST(HostileName, AReflectorIsNoMarkup) {
  EXPECT_EQ(reports::plain(reports::pointName("P_{x}")), "P_{x}");
  EXPECT_EQ(reports::pointName("P12"), "P_{12}");
  EXPECT_EQ(reports::pointName("TIP"), "TIP");
}

TEST(RichText, BackticksAreSetAsCodeAndUnfinishedMarksAreText) {
  page::Html html;
  html.paragraph("measure `nests` and k_{1}; a ` alone, _{ too");
  EXPECT_NE(html.bytes().find("measure <code>nests</code> and k<sub>1</sub>; a ` alone, _{ too"), std::string::npos)
      << html.bytes();
}

TEST(ReportId, FollowsFromTheInputAlone) {
  const SmallResult small;
  const std::string id = reports::reportId(contentOf(small));
  EXPECT_EQ(id.size(), 14u);
  EXPECT_EQ(reports::reportId(contentOf(small)), id);
  SmallResult other;
  other.campaign.inputs.front().sha256[0] = 'f';
  EXPECT_NE(reports::reportId(contentOf(other)), id);
  reports::ReportContent settings = contentOf(small);
  settings.settings.front().text = "2";
  EXPECT_NE(reports::reportId(settings), id);
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_NE(page.find("content:'Report " + id + "'"), std::string::npos);  // at the foot of every printed page
  EXPECT_NE(page.find("End of report " + id), std::string::npos);
}

TEST(Page, AbsentTextsLeaveNoHoles) {
  const SmallResult small;
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_EQ(page.find("Laboratory"), std::string::npos);
  EXPECT_EQ(page.find("<td></td>"), std::string::npos);
  SmallResult with;
  with.campaign.texts.laboratory = "Laboratory of Metrology";
  EXPECT_NE(page::reportPage(contentOf(with)).find("Laboratory of Metrology"), std::string::npos);
}

TEST(Page, EveryTableIsAFileToo) {
  const SmallResult small;
  const page::ReportPage page = page::makeReportPage(contentOf(small));
  std::size_t on_page = 0;
  for (std::size_t at = page.html.find("<table"); at != std::string::npos; at = page.html.find("<table", at + 1))
    ++on_page;
  std::vector<std::string> names;
  for (const reports::TableFile& table : page.tables) names.push_back(table.name);
  // Every posture is too long for the page, and in a file of its own.
  const auto beside =
      std::count_if(names.begin(), names.end(), [](const std::string& name) { return name.starts_with("postures"); });
  // The first page's two tables have no files of their own, and the conditions of both campaigns are one table there.
  EXPECT_EQ(names.size(), on_page - 1 + static_cast<std::size_t>(beside));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_TRUE(std::binary_search(names.begin(), names.end(), "stiffness-2"));
}

}  // namespace hostile_name_test
}  // namespace stiffscope
