#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include "core/audit/remarks.h"
#include "core/campaign/read_campaign.h"
#include "core/identification/remarks.h"
#include "core/preparation/remarks.h"
#include "reports/page/pages.h"
#include "reports/words/verdict.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace page_test {

reports::ReportContent contentOf(const SmallResult& small) {
  reports::ReportContent content;
  content.title = "A report";
  content.campaigns.push_back({small.campaign, small.identification});
  content.verdict = reports::verdictOf(content.campaigns, content.avoided);
  content.figures.push_back({"one", "A title", "See P_{wrist}", "plain words", {1, 2, 3}, 12, 7});
  content.versions = {{"stiffscope", "0.1.0"}};
  content.settings = {{"Load step", "1"}};
  content.command_line = "stiffscope report small --out out";
  return content;
}

/// Parses the page; fails the test where it is not well-formed.
void parse(const std::string& page, tinyxml2::XMLDocument& document) {
  ASSERT_EQ(document.Parse(page.c_str(), page.size()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
}

void eachElement(const tinyxml2::XMLElement* from, const std::function<void(const tinyxml2::XMLElement&)>& see) {
  for (; from != nullptr; from = from->NextSiblingElement()) {
    see(*from);
    eachElement(from->FirstChildElement(), see);
  }
}

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(Page, BeginsWithTheDoctypeAndSaysItsLanguage) {
  const SmallResult small;
  EXPECT_EQ(page::reportPage(contentOf(small)).rfind("<!DOCTYPE html><html lang=\"en\">", 0), 0u);
}

TEST(Page, EverySectionIsThereInOrder) {
  const SmallResult small;
  const std::string page = page::reportPage(contentOf(small));
  std::size_t at = 0;
  for (const char* id : {"conditions", "wrist", "links", "stiffness", "subsets", "compensation", "figures", "scope",
                         "provenance", "versions"}) {
    const std::size_t found = page.find("<section id=\"" + std::string(id) + "\">", at);
    ASSERT_NE(found, std::string::npos) << id;
    at = found;
  }
}

TEST(Page, HeadingsAreInOrderTablesHaveScopesAndPicturesWords) {
  const SmallResult small;
  tinyxml2::XMLDocument document;
  parse(page::reportPage(contentOf(small)), document);
  int level = 0, pictures = 0;
  eachElement(document.RootElement(), [&](const tinyxml2::XMLElement& element) {
    const std::string name = element.Name();
    if (name.size() == 2 && name[0] == 'h' && name[1] >= '1' && name[1] <= '6') {
      EXPECT_LE(name[1] - '0', level + 1) << "a heading skips a level";
      level = name[1] - '0';
    }
    if (name == "th") {
      EXPECT_NE(element.Attribute("scope"), nullptr);
    }
    if (name == "img") {
      ++pictures;
      EXPECT_STREQ(element.Attribute("alt"), "plain words");
      EXPECT_STREQ(element.Attribute("src"), "data:image/png;base64,AQID");
    }
  });
  EXPECT_EQ(pictures, 1);
}

TEST(Page, NothingIsLoadedFromElsewhere) {
  const SmallResult small;
  tinyxml2::XMLDocument document;
  const std::string page = page::reportPage(contentOf(small));
  parse(page, document);
  eachElement(document.RootElement(), [](const tinyxml2::XMLElement& element) {
    EXPECT_STRNE(element.Name(), "link");
    if (std::string(element.Name()) == "script") {
      EXPECT_EQ(element.Attribute("src"), nullptr);
    }
    EXPECT_EQ(std::string(element.Attribute("href") ? element.Attribute("href") : "#").front(), '#');
    if (const char* source = element.Attribute("src")) {
      EXPECT_EQ(std::string(source).rfind("data:", 0), 0u);
    }
  });
  EXPECT_FALSE(has(page, "http"));
  EXPECT_FALSE(has(page, "url("));
}

// A browser reads no entities in a style: a child selector written as &gt; is none.
TEST(Page, TheStyleStandsToTheLetter) {
  const SmallResult small;
  const std::string page = page::reportPage(contentOf(small));
  const std::size_t begin = page.find("<style>"), end = page.find("</style>");
  ASSERT_LT(begin, end);
  const std::string style = page.substr(begin, end - begin);
  for (const char* entity : {"&gt;", "&lt;", "&amp;", "&quot;", "&#"}) EXPECT_FALSE(has(style, entity)) << entity;
  EXPECT_TRUE(has(style, ">"));
}

TEST(Page, AHostileNameStaysText) {
  SmallResult small;
  const std::string hostile = "<script>alert(\"1\")</script> & 'quotes'\x01\xff";
  small.campaign.name = small.campaign.targets[0].id = small.campaign.robot.name = hostile;
  small.campaign.texts.conditions = small.campaign.inputs[0].name = hostile;
  small.identification.left_out = {{hostile, Remark(identification::RemarkId::no_wrist_point)}};
  reports::ReportContent content = contentOf(small);
  content.title = content.command_line = content.figures[0].alt = content.figures[0].caption = hostile;
  const std::string page = page::reportPage(content);
  // The page's own script is the only one.
  EXPECT_EQ(page.find("<script"), page.find("<script>//<![CDATA["));
  EXPECT_EQ(page.find("<script"), page.rfind("<script"));
  EXPECT_TRUE(has(page, "&lt;script&gt;"));
  EXPECT_FALSE(has(page, "\x01"));
  tinyxml2::XMLDocument document;
  parse(page, document);
  const auto* title = document.RootElement()->FirstChildElement("head")->FirstChildElement("title");
  EXPECT_STREQ(title->GetText(), "<script>alert(\"1\")</script> & 'quotes'??");
  eachElement(document.RootElement(), [](const tinyxml2::XMLElement& element) {
    if (std::string(element.Name()) == "img") {
      EXPECT_STREQ(element.Attribute("alt"), "<script>alert(\"1\")</script> & 'quotes'??");
    }
  });
}

TEST(Page, OnlyVoidElementsCloseThemselves) {
  const SmallResult small;
  reports::ReportContent content = contentOf(small);
  content.verdict.clear();
  const std::string page = page::reportPage(content);
  for (std::size_t at = page.find("/>"); at != std::string::npos; at = page.find("/>", at + 1)) {
    const std::size_t begin = page.rfind('<', at);
    const std::string name = page.substr(begin + 1, page.find_first_of(" /", begin) - begin - 1);
    EXPECT_TRUE(name == "meta" || name == "img") << name;
  }
}

TEST(Page, WhatIsMissingSaysWhy) {
  const SmallResult small;
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_TRUE(has(page, "is not measured: the campaign has no wrist sweep."));
  EXPECT_TRUE(has(page, "No axis was measured (the campaign has no circle sweeps)"));
  EXPECT_TRUE(has(page,
                  "Complete Pose (CP) is not available: a flange pose needs three reflectors, placed by circle sweeps, "
                  "in every posture."));
  EXPECT_TRUE(has(page, "</sub> is not seen: the load only hangs and does not turn axis 1: "));
  EXPECT_TRUE(has(page, "Negative: "));
  EXPECT_FALSE(has(page, ">nan"));
  EXPECT_FALSE(has(page, " nan"));
  EXPECT_FALSE(has(page, ">inf"));
}

TEST(Page, NumbersAreThoseOfTheResult) {
  const SmallResult small;
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_TRUE(has(page, "2.00\u00a0mm"));  // the mean of 1, 3 and 2
  EXPECT_TRUE(has(page, ">84\u00a0%<"));   // held out at the reflectors
  EXPECT_TRUE(has(page, "; 85\u00a0% at P<sub>wrist</sub>"));
  // One degree of freedom, t = 12.71 (any table).
  EXPECT_TRUE(has(page, "12.71 for PP (1.0 degree of freedom)"));
  EXPECT_TRUE(has(page, "5.0 (above 2.2)"));         // 1/0.2e-6; one over (0.2 + 12.71 times 0.02)e-6
  EXPECT_TRUE(has(page, "−0.25 (−0.69 to −0.15)"));  // joint 4 by PP: u is that of 2e-6 rad/Nm
  EXPECT_TRUE(has(page, "200 ± 250"));               // joint 2's compliance, 20 times 12.71
  EXPECT_TRUE(has(page, "all 3 subsets of 2 of 3 postures"));
  EXPECT_TRUE(has(page, "0123456789abcdef"));
}

TEST(Page, ThePaperStandsBesideOnlyWhereAskedFor) {
  const SmallResult small;
  reports::ReportContent content = contentOf(small);
  EXPECT_FALSE(has(page::reportPage(content), "Paper"));
  content.compare_with_paper = true;
  EXPECT_TRUE(has(page::reportPage(content), "5.6 &amp; 0.1"));
  EXPECT_TRUE(has(page::reportPage(content), ">84\u00a0%<"));
}

TEST(Page, TheAuditWithItsLimitsAndRejectedReadings) {
  const SmallResult small;
  audit::AuditReport audited;
  audited.verdict = preparation::AuditVerdict::fail;
  audited.made = 3;
  audited.of = 33;
  audited.checks = {{"station_drift",
                     preparation::AuditVerdict::warn,
                     12.5e-6,
                     10e-6,
                     Remark(audit::RemarkId::at_time, 900.0),
                     Remark(preparation::RemarkId::station_wandered, 12.5e-6),
                     preparation::byChance(Remark(audit::LimitId::chi_square, 6)),
                     {}},
                    {"lost_beam",
                     preparation::AuditVerdict::fail,
                     1.0,
                     0.0,
                     preparation::atRow("loading.csv", 7),
                     Remark(preparation::RemarkId::readings_at_zero, 1),
                     Remark(preparation::RemarkId::nothing_inside_station),
                     {}},
                    {"tare",
                     preparation::AuditVerdict::not_testable,
                     {},
                     {},
                     {},
                     Remark(audit::MissingId::no_load_cell_readings),
                     {},
                     {}},
                    {"posture_set",
                     preparation::AuditVerdict::pass,
                     2.6,
                     100.0,
                     {},
                     Remark(audit::RemarkId::joints_identified, 19, 3, std::vector<int>{1}, 2.6, std::vector<Remark>{}),
                     Remark(audit::LimitId::condition_practice),
                     {Remark(audit::RemarkId::joint_identifiable, 1, 812.0, 3.1)}}};
  audited.rejected = {{"loading.csv", 7, Remark(preparation::RemarkId::beam_lost)}};
  preparation::Preparation preparation;
  preparation.rejected = audited.rejected;
  preparation.drift = {true, {}, 0.5e-3, 20e-6, 3600.0, {}, 100, 4};
  reports::ReportContent content = contentOf(small);
  EXPECT_FALSE(has(page::reportPage(content), "id=\"audit\""));  // nothing is said of an audit that was not made
  content.campaigns[0].audit = &audited;
  content.campaigns[0].preparation = &preparation;
  const std::string page = page::reportPage(content);
  tinyxml2::XMLDocument document;
  parse(page, document);
  EXPECT_TRUE(has(page, "The audit fails"));
  EXPECT_TRUE(has(page, "3 of 33 checks could be made."));
  EXPECT_TRUE(has(page, "The audit fails: the tracker lost its beam in some readings (lost beam)."));
  EXPECT_TRUE(has(page, "The audit warns: tracker or robot moved against the floor during the day (station drift)."));
  EXPECT_TRUE(has(page, "<li>Readings: 1 left out; the station's motion"));
  EXPECT_TRUE(has(page, "12.5\u00a0µm"));
  EXPECT_TRUE(has(page, "where the arm was read (900 s)"));
  EXPECT_TRUE(has(page, "joint 1: identifiable"));
  EXPECT_TRUE(has(page, "1 reading rejected and left out of everything on this page"));
  EXPECT_TRUE(has(page, "loading.csv:7: lost beam"));
  EXPECT_TRUE(has(page,
                  "1 left out; the station's motion by the floor nests taken off 100 of them: at most 0.500 mm and "
                  "20 µrad, a drift over 3600 s; 4 state no time and stay as they were read"));
  preparation.raw = true;
  EXPECT_TRUE(has(page::reportPage(content), "but used all the same"));
}

TEST(Page, TheDiagnosisSaysWhatToDo) {
  const SmallResult small;
  diagnosis::Diagnosis diagnosis(6);
  diagnosis.usable = true;
  diagnosis.verdict.entries = {{{effects::Effect::load_cell_bias}, ""}};
  diagnosis.verdict.reasons = {Remark(diagnosis::RemarkId::left_by_stiffnesses, 30e-6, 5e-6, 36.0, true, false)};
  diagnosis.next = {{{effects::Effect::load_cell_bias, effects::Effect::hysteresis}, {}, 4.0}};
  diagnosis.next[0].what =
      Remark(diagnosis::RemarkId::posture_that_separates, std::vector<double>(6, 0.0), 1e3, 2, 9.0, 4.0, 8.0);
  reports::ReportContent content = contentOf(small);
  content.campaigns[0].diagnosis = &diagnosis;
  content.figures[0].section = "gap";
  content.verdict = reports::verdictOf(content.campaigns, {});
  const std::string page = page::reportPage(content);
  // As many as stand before it, and itself.
  std::size_t number = 1;
  for (std::size_t at = page.find("<section "); at < page.find("<section id=\"gap\"");
       at = page.find("<section ", at + 1))
    ++number;
  EXPECT_TRUE(has(page, "Besides joint springs the readings show load cell bias (see <a href=\"#gap\">section\u00a0" +
                            std::to_string(number) + ", What the model misses</a>)."));
  EXPECT_TRUE(has(page, "load cell bias: a constant force is added to the loaded readings"));
  EXPECT_TRUE(has(page, "and U is 1.96 times the standard uncertainty by weights of the noise"));
  EXPECT_TRUE(has(page, "<li>Tare the cell with nothing hanging"));
  EXPECT_TRUE(has(page, "<li>To tell load cell bias and hysteresis apart, measure a posture"));
  EXPECT_TRUE(has(page, "Stiffnesses alone leave 30.0 µm rms"));
  EXPECT_LT(page.find("id=\"gap\""), page.find("<figure"));  // its figure stands in it
  EXPECT_FALSE(has(page, "id=\"figures\""));
  // As identify states them.
  diagnosis.stated.emplace().method = identification::Method::partial_pose;
  diagnosis.stated->expanded = JointVector::Zero(6);
  diagnosis.stated->interval.resize(6);
  diagnosis.stated->expanded[1] = 0.3e6;
  diagnosis.identifiable[1] = true;
  diagnosis.stiffness_before[1] = 4.0e6, diagnosis.stiffness_after[1] = 5.0e6;
  EXPECT_TRUE(has(page::reportPage(content), "Joint stiffness by Partial Pose, by joint springs alone and with"));
  EXPECT_TRUE(has(page::reportPage(content), "5.00 ± 0.30"));
  EXPECT_FALSE(has(page::reportPage(content), "standard uncertainty by weights of the noise"));
  diagnosis.verdict.entries.clear();
  EXPECT_TRUE(has(page::reportPage(content), "Joint springs are enough for this machine"));
}

TEST(Page, TheTileCountsOnlyTrustedStiffnesses) {
  SmallResult small;
  EXPECT_TRUE(has(page::reportPage(contentOf(small)),
                  "<b>5 of 6</b><span>joint stiffnesses found by DPP, double encoders active</span>"));
  small.method(identification::Method::decoupled_partial_pose).estimate.compliance[3] = -4e-6;
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_TRUE(has(page,
                  "<b>4 of 6</b><span>joint stiffnesses found by DPP, double encoders active; k<sub>4</sub> is not to "
                  "be trusted and not counted</span>"));
  EXPECT_TRUE(has(page, "k<sub>4</sub> is not to be trusted."));  // the verdict's words
  small.method(identification::Method::decoupled_partial_pose).estimate.compliance[5] = -4e-6;
  EXPECT_TRUE(has(page::reportPage(contentOf(small)), "k<sub>4</sub>, k<sub>6</sub> are not to be trusted."));
}

TEST(Page, NegativeStiffnessesCompensateNothing) {
  SmallResult small;
  for (const identification::Method method : identification::kMethods)
    small.method(method).estimate.compliance = -small.method(method).estimate.compliance.cwiseAbs();
  reports::ReportContent content = contentOf(small);
  content.verdict = reports::verdictOf(content.campaigns, {});
  const std::string page = page::reportPage(content);
  EXPECT_TRUE(has(page,
                  "<b>–</b><span>compensated: every stiffness by DPP is negative, so no share of the deflection counts "
                  "as compensated"));
  EXPECT_FALSE(has(page, "takes away"));
  EXPECT_TRUE(has(page, "these shares say how well the readings are fitted"));
}

TEST(Page, BeginsWithTheNoteAndSaysWhatIsNotStated) {
  SmallResult small;
  reports::ReportContent content = contentOf(small);
  std::string page = page::reportPage(content);
  EXPECT_FALSE(has(page, "class=\"stated\""));
  EXPECT_TRUE(has(page, "<th scope=\"row\">Measured by</th><td>not stated</td>"));
  EXPECT_TRUE(has(page, "active; on which joints is not stated"));
  small.campaign.double_encoder_joints = {0, 1, 2};
  page = page::reportPage(content);
  EXPECT_FALSE(has(page, "is not stated"));
  EXPECT_TRUE(has(page, "<td>active, on joints 1 to 3</td>"));
  small.campaign.double_encoder_joints = {0, 3};
  EXPECT_TRUE(has(page::reportPage(content), "<td>active, on joints 1, 4</td>"));
  small.campaign.texts.note = "simulated; <no> machine";
  small.campaign.texts.operator_name = "A. Person";
  page = page::reportPage(content);
  const std::size_t note = page.find("<p class=\"stated\">Note: simulated; &lt;no&gt; machine</p>");
  ASSERT_NE(note, std::string::npos);
  EXPECT_LT(note, page.find("class=\"numbers\""));
  EXPECT_FALSE(has(page, "Measured by"));
}

// That one day is simulated says nothing of the other.
TEST(Page, ANoteOnOneOfTwoDaysNamesIt) {
  SmallResult first(campaign::DoubleEncoder::inactive), second(campaign::DoubleEncoder::active);
  first.campaign.texts.note = "simulated";
  const auto pageOfBoth = [&] {
    reports::ReportContent content = contentOf(first);
    content.campaigns.push_back({second.campaign, second.identification});
    return page::reportPage(content);
  };
  EXPECT_TRUE(has(pageOfBoth(), "<p class=\"stated\">Note on Double encoders inactive: simulated</p>"));
  second.campaign.texts.note = "simulated";
  EXPECT_TRUE(has(pageOfBoth(), "<p class=\"stated\">Note: simulated</p>"));
}

TEST(Page, FiguresOfACampaignStandWithItsTables) {
  const SmallResult first(campaign::DoubleEncoder::inactive), second(campaign::DoubleEncoder::active);
  reports::ReportContent content = contentOf(first);
  content.campaigns.push_back({second.campaign, second.identification});
  content.figures.clear();
  for (const char* id : {"stiffness-1", "stiffness-2", "common"}) {
    reports::Figure figure{id, "A title", "Words", "plain words", {1, 2, 3}, 12, 7};
    figure.section = "stiffness";
    if (id != std::string("common")) figure.campaign = content.figures.size();
    content.figures.push_back(std::move(figure));
  }
  const std::string page = page::reportPage(content);
  const std::size_t section = page.find("<section id=\"stiffness\">");
  const std::size_t second_heading = page.find("<h3>", page.find("<h3>", section) + 1);
  const std::size_t one = page.find("id=\"stiffness-1\""), other = page.find("id=\"stiffness-2\""),
                    common = page.find("id=\"common\"");
  EXPECT_LT(section, one);
  EXPECT_LT(one, second_heading);
  EXPECT_LT(second_heading, other);
  EXPECT_LT(other, common);
  EXPECT_LT(common, page.find("<section id=\"subsets\">"));
  for (const char* number : {"Figure 1. A title", "Figure 2. A title", "Figure 3. A title"})
    EXPECT_TRUE(has(page, number)) << number;
}

TEST(Page, WhatHoldsOfBothDaysIsSaidOnce) {
  const SmallResult first(campaign::DoubleEncoder::inactive), second(campaign::DoubleEncoder::active);
  reports::ReportContent content = contentOf(first);
  content.campaigns.push_back({second.campaign, second.identification});
  audit::AuditReport audits[2];
  for (audit::AuditReport& audited : audits) {
    audited.verdict = preparation::AuditVerdict::warn;
    preparation::AuditCheck drift;
    drift.id = "station_drift";
    drift.verdict = preparation::AuditVerdict::warn;
    audited.checks.push_back(drift);
  }
  audits[1].checks.push_back(audits[1].checks.front());
  audits[1].checks.back().id = "tare";
  for (std::size_t i = 0; i < 2; ++i) content.campaigns[i].audit = &audits[i];
  const std::string page = page::reportPage(content);
  EXPECT_TRUE(has(page, "Both days: The audit warns: tracker or robot moved against the floor during the day"));
  EXPECT_TRUE(has(page, "<li>The audit warns: the load cell does not read zero without a load (tare).</li>"));
}

TEST(Page, NoMethodAtAll) {
  SmallResult small;
  small.identification.methods = identification::Identification(small.campaign.robot.joints()).methods;
  for (identification::MethodResult& method : small.identification.methods)
    method.reason = Remark(identification::RemarkId::no_joint_turned);
  small.identification.cases.clear();
  small.identification.wrist.clear();
  small.identification.wrist_displacement.clear();
  small.identification.target_displacement.clear();
  const reports::ReportContent content = contentOf(small);
  EXPECT_EQ(content.verdict,
            "No joint stiffness can be identified: the load turns no joint enough to see its stiffness.");
  tinyxml2::XMLDocument document;
  parse(page::reportPage(content), document);
}

TEST(Page, TheSameContentGivesTheSameBytes) {
  const SmallResult small;
  EXPECT_EQ(page::reportPage(contentOf(small)), page::reportPage(contentOf(small)));
}

TEST(Avoided, AgainstTheSumsByHand) {
  const SmallResult inactive(campaign::DoubleEncoder::inactive, 2.0), active(campaign::DoubleEncoder::active, 1.0);
  const std::vector<reports::ReportCampaign> both{{active.campaign, active.identification},
                                                  {inactive.campaign, inactive.identification}};
  const auto avoided = reports::avoidedByEncoders(both);
  ASSERT_TRUE(avoided.has_value());
  EXPECT_DOUBLE_EQ(avoided->share, 0.5);
  EXPECT_TRUE(avoided->at_wrist);
  EXPECT_EQ(avoided->postures.size(), 3u);
  EXPECT_TRUE(std::isnan(avoided->low));  // three postures are too few for an interval
  EXPECT_EQ(reports::shareWords(*avoided), "50.0\u00a0%");
  reports::AvoidedByEncoders with = *avoided;
  with.low = 0.4, with.high = 0.6;
  EXPECT_EQ(reports::shareWords(with), "50.0\u00a0% (95\u00a0%: 40.0 to 60.0\u00a0%)");
  const std::string verdict = reports::verdictOf(both, avoided);
  EXPECT_TRUE(has(verdict, "The double encoders avoid 50\u00a0% of the deflection at P_{wrist}.")) << verdict;
}

TEST(Avoided, AJointWithoutAnEncoderThatDiffersIsNamed) {
  SmallResult inactive(campaign::DoubleEncoder::inactive, 2.0), active(campaign::DoubleEncoder::active, 1.0);
  inactive.campaign.double_encoder_joints = active.campaign.double_encoder_joints = {0, 1, 2};
  const std::vector<reports::ReportCampaign> both{{inactive.campaign, inactive.identification},
                                                  {active.campaign, active.identification}};
  auto avoided = reports::avoidedByEncoders(both);
  ASSERT_TRUE(avoided.has_value());
  avoided->by_joint.available = true;
  comparison::JointChange changed;
  changed.comparable = true;
  changed.p_holm = 0.001;
  changed.ratio.value = 1.534;
  avoided->by_joint.joints = PerJoint<comparison::JointChange>(6);
  const auto said = [&] { return has(reports::verdictOf(both, avoided), "Joints that have none differ as well"); };
  EXPECT_FALSE(said());
  avoided->by_joint.joints[1] = changed;  // which the encoder may well have done
  EXPECT_FALSE(said());
  avoided->by_joint.joints[4] = changed;
  const std::string verdict = reports::verdictOf(both, avoided);
  EXPECT_TRUE(has(verdict, "Joints that have none differ as well (k_{5} by +53\u00a0%): not only the encoders changed"))
      << verdict;
  avoided->by_joint.joints[4].p_holm = 0.06;
  EXPECT_FALSE(said());
  avoided->by_joint.joints[4].p_holm = 0.001;
  avoided->by_joint.joints[4].ratio.value = 1.005;
  EXPECT_FALSE(said());
  // Nobody stated which joints have one.
  avoided->by_joint.joints[4] = changed;
  inactive.campaign.double_encoder_joints.clear();
  EXPECT_FALSE(said());
}

TEST(Avoided, NeedsBothStatesAndACommonPosture) {
  SmallResult inactive(campaign::DoubleEncoder::inactive), active(campaign::DoubleEncoder::active);
  EXPECT_FALSE(reports::avoidedByEncoders({{active.campaign, active.identification}}).has_value());
  active.campaign.pose_ids = {"X", "Y", "Z"};
  reports::ReportContent content = contentOf(active);
  content.campaigns.push_back({inactive.campaign, inactive.identification});
  content.avoided = reports::avoidedByEncoders(content.campaigns);
  ASSERT_TRUE(content.avoided.has_value());
  EXPECT_FALSE(content.avoided->available);
  EXPECT_TRUE(has(page::reportPage(content), "Not known: no posture was measured in both campaigns"));
  EXPECT_FALSE(has(reports::verdictOf(content.campaigns, content.avoided), "avoid"));
}

TEST(Page, CampaignsOfDifferentMachinesAreNamed) {
  const SmallResult one;
  SmallResult other(campaign::DoubleEncoder::inactive);
  reports::ReportContent content = contentOf(one);
  content.campaigns.push_back({other.campaign, other.identification});
  EXPECT_FALSE(has(page::reportPage(content), "the URDFs"));
  other.campaign.robot.name = "a <second> arm";
  EXPECT_TRUE(has(page::reportPage(content), "<li>small and small: the URDFs name different machines: "));
  EXPECT_TRUE(has(page::reportPage(content), "a &lt;second&gt; arm."));
  other.campaign.robot.axes_in_base_at_zero[2].point.x() += 0.2;
  EXPECT_TRUE(
      has(page::reportPage(content), "the URDFs describe different machines: axis 3 stands 200.0 mm elsewhere."));
}

TEST(Page, ARealCampaignWithoutWrist) {
  const std::filesystem::path folder = STIFFSCOPE_SHARED_DIR "/real/fanuc-r2000ic-cable";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the campaigns at hand are not here";
  SmallResult real;
  real.campaign = campaign::readCampaign(folder).campaign;
  real.identification = identification::identify(real.campaign);
  const std::string page = page::reportPage(contentOf(real));
  tinyxml2::XMLDocument document;
  parse(page, document);
  EXPECT_TRUE(has(page, "mean deflection at the reflector TIP"));
  EXPECT_LT(page.size(), 100'000u);  // without pictures
}

}  // namespace page_test
}  // namespace stiffscope
