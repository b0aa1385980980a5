// What the page says in words beside its numbers: that no sentence contradicts a card, a table or another section.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include "core/calibration/remarks.h"
#include "core/comparison/remarks.h"
#include "core/diagnosis/remarks.h"
#include "core/mistakes/remarks.h"
#include "reports/page/diagnosis_tables.h"
#include "reports/page/pages.h"
#include "reports/words/calibration_words.h"
#include "reports/words/entry_words.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/numbers.h"
#include "reports/words/verdict.h"
#include "reports/words/workspace_words.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace page_words_test {

using identification::Method;

bool says(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

std::size_t countOf(const std::string& page, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++count;
  return count;
}

reports::ReportContent contentOf(const SmallResult& small) {
  reports::ReportContent content;
  content.title = "A report";
  content.campaigns.push_back({small.campaign, small.identification});
  content.verdict = reports::verdictOf(content.campaigns, content.avoided);
  return content;
}

/// Two days of which joint 5, that has no double encoder, has become stiffer.
struct Pair {
  SmallResult inactive{campaign::DoubleEncoder::inactive, 2.0}, active{campaign::DoubleEncoder::active, 1.0};
  reports::ReportContent content;

  Pair() {
    inactive.campaign.double_encoder_joints = active.campaign.double_encoder_joints = {0, 1, 2};
    content = contentOf(inactive);
    content.campaigns.push_back({active.campaign, active.identification});
    content.avoided = reports::avoidedByEncoders(content.campaigns);
    comparison::StiffnessChange& by_joint = content.avoided->by_joint;
    by_joint.available = true;
    by_joint.joints = PerJoint<comparison::JointChange>(6);
    for (const std::size_t joint : {std::size_t{1}, std::size_t{4}}) {
      by_joint.joints[joint].comparable = true;
      by_joint.joints[joint].p_holm = 0.001;
      by_joint.joints[joint].ratio.value = 1.534;
    }
    for (const char* id : {"deflection-1", "deflection-2"}) {
      reports::Figure figure{id, "A title", "Words", "plain words", {1, 2, 3}, 12, 7};
      figure.section = "opening";
      content.figures.push_back(std::move(figure));
    }
  }
};

TEST(PageWords, OneRemedyNamesAllItsPlaces) {
  const SmallResult small;
  audit::AuditReport audited;
  audited.verdict = preparation::AuditVerdict::fail;
  for (const char* pose : {"4", "8"}) {
    mistakes::Suspected one;
    one.mistake = "cell_axes";
    one.where = Remark(mistakes::RemarkId::at_pose_in, pose, "fx_n", "states.csv", 18);
    one.remedy = Remark(mistakes::RemarkId::moments_first);
    audited.suspected.push_back(one);
  }
  audited.suspected.push_back(audited.suspected.front());
  audited.suspected.back().remedy = Remark(mistakes::RemarkId::left_handed);
  reports::ReportContent content = contentOf(small);
  content.campaigns[0].audit = &audited;
  const std::string page = page::reportPage(content);
  EXPECT_TRUE(says(page, "The audit suspects mistakes in the files, cell axes of the pose 4, "))
      << page.substr(0, 20000);
  EXPECT_TRUE(says(page, "; of the pose 8, "));
  EXPECT_EQ(countOf(page, "then make this report again"), 2u);
  EXPECT_TRUE(says(page, "The audit suspects a mistake in the files, cell axes of the pose 4, "));
}

TEST(PageWords, WhatTheEncodersAvoidHasItsCaveatWithIt) {
  Pair pair;
  std::string page = page::reportPage(pair.content);
  const std::string of_card =
      "is avoided by active ones; joints without a double encoder differ as well (k<sub>5</sub> by +53\u00a0%): not "
      "only the encoders changed";
  EXPECT_TRUE(says(page, of_card));
  EXPECT_TRUE(says(page, "Next:</b> Find out what else changed between the two days, and measure them again"));
  EXPECT_TRUE(says(page, "What differs between the two states of the double encoders ± U"));
  EXPECT_TRUE(says(page, "1/k<sub>5</sub> <small>no double encoder</small>"));
  EXPECT_FALSE(says(page, "1/k<sub>2</sub> <small>no double encoder</small>"));
  EXPECT_TRUE(says(page, "and what joints with one lose need not be the encoders' alone"));
  pair.content.avoided->by_joint.joints[4].ratio.value = 1.0;
  page = page::reportPage(pair.content);
  EXPECT_FALSE(says(page, "differ as well"));
  EXPECT_TRUE(says(page, "What the double encoders take away ± U"));
}

TEST(PageWords, TheDeflectionOfTwoDaysIsThatOfBoth) {
  Pair pair;
  std::string page = page::reportPage(pair.content);
  EXPECT_TRUE(says(page, "<b>4.00 and 2.00\u00a0mm</b>"));
  EXPECT_TRUE(says(page, "3 postures: double encoders inactive, and double encoders active"));
  // Of two days that nothing tells apart but their names, these.
  pair.inactive.campaign.name = "before", pair.active.campaign.name = "after";
  pair.inactive.campaign.double_encoder = pair.active.campaign.double_encoder = campaign::DoubleEncoder::unspecified;
  page = page::reportPage(pair.content);
  EXPECT_TRUE(says(page, "3 postures: before, and after"));
  // Under another load the leading day's alone, with which it is.
  for (identification::LoadCase& one : pair.active.identification.cases) one.wrench.force *= 2.0;
  page = page::reportPage(pair.content);
  EXPECT_TRUE(says(page, "<b>4.00\u00a0mm</b>"));
  EXPECT_TRUE(says(page, "under 1.00\u00a0kN, 3 postures, before"));
}

TEST(PageWords, TheVerdictOfTwoDaysIsAList) {
  const Pair pair;
  const std::string page = page::reportPage(pair.content);
  const std::size_t told = page.find("<div class=\"told\"><ul>");
  ASSERT_NE(told, std::string::npos);
  const std::string list = page.substr(told, page.find("</ul>", told) - told);
  EXPECT_GE(countOf(list, "<li>"), 4u) << list;
  EXPECT_TRUE(says(list, "<li>With double encoders inactive it takes away ")) << list;
  EXPECT_TRUE(says(list, "<li>With double encoders active it takes away ")) << list;
  EXPECT_TRUE(says(list, "<li>The double encoders avoid "));
  // The list and the paragraph of one text.
  std::string joined;
  for (const std::string& item : reports::verdictItems(pair.content.campaigns, pair.content.avoided))
    joined += (joined.empty() ? "" : " ") + item;
  EXPECT_EQ(joined, reports::verdictOf(pair.content.campaigns, pair.content.avoided));
}

TEST(PageWords, TheVerdictCountsTheJointsThatTheCardCounts) {
  SmallResult small;
  small.method(Method::decoupled_partial_pose).estimate.compliance[3] = -4e-6;
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_TRUE(says(page, "<b>4 of 6</b>"));
  EXPECT_TRUE(says(page, "finds the stiffness of 4 of 6 joints; "));
  EXPECT_FALSE(says(page, "of 5 of 6 joints"));
}

TEST(PageWords, AFarFromSymmetricIntervalStandsInTheCell) {
  identification::StiffnessEstimate estimate(6);
  estimate.compliance.setConstant(1.0 / 6.0);
  estimate.covariance.diagonal().setConstant(1e-4);
  estimate.identifiable.assign(6, true);
  estimate.compliance[2] = -0.25;
  const double inf = std::numeric_limits<double>::infinity();
  estimate.stated = {{1.0 / 17.3, 1.0 / 4.08}, {-0.1, 0.2},           {-0.6, 0.2}, {-inf, inf},
                     {1 / 6.11, 1.0 / 5.9},    {1.0 / 6.0, 1.0 / 6.0}};
  EXPECT_EQ(reports::uncertainStiffness(estimate, 0, 1.0), "6.0 (4.1 to 17)");  // not 6 ± 11, which holds −5
  EXPECT_EQ(reports::uncertainStiffness(estimate, 1, 1.0), "6.0 (above 5.0)");
  EXPECT_EQ(reports::uncertainStiffness(estimate, 2, 1.0), "above 5.0 (fit −4.0)");
  EXPECT_EQ(reports::uncertainStiffness(estimate, 3, 1.0), "6.0 (U open)");
  EXPECT_EQ(reports::uncertainStiffness(estimate, 4, 1.0), "6.00 ± 0.11");
  EXPECT_EQ(reports::uncertainStiffness(estimate, 4, 1e3), "0.00600 ± 0.00011");
  EXPECT_TRUE(reports::farFromSymmetric(estimate, 0));
  EXPECT_FALSE(reports::farFromSymmetric(estimate, 4));
}

TEST(PageWords, TheFirstTableAndTheFullOneHaveTheSameCells) {
  const SmallResult small;  // one degree of freedom: all intervals are open
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_EQ(countOf(page, ">5.0 (above 2.2)<"), 3u);  // first table, PP, DPP
  EXPECT_TRUE(says(page, "In brackets: the 95\u00a0% interval itself"));
  EXPECT_TRUE(says(page, "the data only say how stiff it is at least"));
  EXPECT_FALSE(says(page, "is only known to be above"));
}

/// With bearing tilt in the model, and a stated interval of U = 2.7 u either way.
struct WithEffects {
  SmallResult small;
  extended_model::ExtendedModel model;
  diagnosis::Diagnosis diagnosis{6};
  audit::AuditReport audited;
  reports::ReportContent content;

  WithEffects() {
    model.effects.added.resize(1);
    model.effects.added[0].effect = effects::Effect::bearing_tilt;
    for (identification::MethodResult& method : small.identification.methods) {
      identification::StiffnessEstimate& estimate = method.estimate;
      estimate.covariance *= 0.01;
      for (int j = 0; j < 6; ++j) {
        const double c = estimate.compliance[j], u = 0.01 * std::abs(c);
        estimate.stated.push_back({c - 2.7 * u, c + 2.6 * u});
      }
    }
    model.without = model.with = small.identification;
    model.hidden.emplace();
    model.hidden->lack_of_fit = 40.0, model.hidden->left_over = 1.1;
    diagnosis.usable = true;
    diagnosis.verdict.entries = {{{}, ""}};
    content = contentOf(small);
    content.campaigns[0].improved = &model;
    content.campaigns[0].diagnosis = &diagnosis;
    content.campaigns[0].audit = &audited;
  }
};

TEST(PageWords, EffectsThatTheDiagnosisRefusesAreSaidToBeKept) {
  WithEffects day;
  EXPECT_TRUE(
      says(page::reportPage(day.content),
           "Bearing tilt is in the model although the diagnosis does not name it: the model keeps what predicts"));
  day.diagnosis.verdict.entries = {{{effects::Effect::bearing_tilt}, ""}};
  EXPECT_FALSE(says(page::reportPage(day.content), "although the diagnosis does not name it"));
}

TEST(PageWords, TheBudgetLeadsToTheStatedUncertainty) {
  const WithEffects day;
  const std::string page = page::reportPage(day.content);
  const std::size_t at = page.find("U over u: coverage factor");
  ASSERT_NE(at, std::string::npos);
  const std::string rows = page.substr(at, page.find("</tbody>", at) - at);
  // 1/(1 - 0.027) - 1 = 2.775 %, of a standard uncertainty of 1 %.
  EXPECT_TRUE(says(rows, "<td>2.77</td>")) << rows;
  EXPECT_LT(page.find("<th scope=\"row\">together</th>"), at);
  EXPECT_TRUE(says(page, "longer tails than a normal distribution"));
}

TEST(PageWords, TheAuditIsOfReadingsWithTheEffectsInThem) {
  WithEffects day;
  EXPECT_TRUE(says(page::reportPage(day.content), "of this page, diagnosis and audit aside, is of the model"));
  for (frames::MeasuredAxis& axis : day.small.identification.frames.axes) axis.measured = true;
  frames::LinkGeometry& link = day.small.identification.frames.links[0];
  link.distance_sd = 1e-6;
  link.distance = link.nominal_distance + 0.0913e-3;
  preparation::AuditCheck check;
  check.id = "link_lengths";
  check.value = 0.757e-3;
  check.limit = 20e-3;
  day.audited.checks = {check};
  EXPECT_TRUE(says(page::reportPage(day.content),
                   "by it distances are off the nominal ones by up to 0.76\u00a0mm, instead of 0.091\u00a0mm here."));
  day.audited.checks[0].value = 0.0913e-3;
  EXPECT_FALSE(says(page::reportPage(day.content), "The audit looks at the readings before"));
}

TEST(PageWords, StiffnessesOfTheDiagnosisStandAsInTheOtherTables) {
  WithEffects day;
  identification::MethodResult& with = day.model.with.methods[1];
  with.estimate.stated[5] = {1.0 / 0.104e6, 1.0 / 0.077e6};  // far from symmetric about 0.1
  day.diagnosis.stated.emplace().method = identification::Method::partial_pose;
  day.diagnosis.stated->expanded = JointVector::Constant(6, 0.022e6);
  day.diagnosis.stated->interval.resize(6);
  day.diagnosis.verdict.entries = {{{effects::Effect::bearing_tilt}, ""}};
  day.diagnosis.identifiable = with.estimate.identifiable;
  day.diagnosis.stiffness_before = day.diagnosis.stiffness_after = with.estimate.compliance.cwiseInverse();
  const std::string page = page::reportPage(day.content);
  const std::size_t table = page.find("by joint springs alone and with the effects in the model, k ± U");
  ASSERT_NE(table, std::string::npos);
  const std::string rows = page.substr(table, page.find("</table>", table) - table);
  EXPECT_TRUE(says(rows, "<td>0.1000 ± 0.0028</td>\n<td>0.10 (0.077 to 0.10)</td>")) << rows;
}

TEST(PageWords, AJointThatIsNotSeenSaysOfWhichModelItsTorqueIs) {
  WithEffects day;
  const char* whose = "The torque is about the axis of the model with its effects";
  EXPECT_TRUE(says(page::reportPage(day.content), whose));
  day.model.effects.added.clear();
  EXPECT_FALSE(says(page::reportPage(day.content), whose));
}

TEST(PageWords, TheVerdictSaysByWhatItNamesWhatShrinksNothing) {
  diagnosis::EffectClass one;
  one.effects = {effects::Effect::kinematic_error};
  one.in_verdict = true;
  one.shrink = {-0.007, -0.09, 0.05};
  EXPECT_EQ(page::whyNamed(one), "by sweeps and unloaded positions; deflections hardly feel it");
  one.effects = {effects::Effect::bearing_tilt};
  EXPECT_EQ(page::whyNamed(one), "by the fall of BIC, not by this shrink");
  one.shrink.low = 0.01;
  EXPECT_EQ(page::whyNamed(one), "");
  accuracy::AccuracyClass wave;
  wave.effects = {calibration::UnloadedEffect::transmission_error};
  wave.shrink = {0.017, -0.04, 0.05};
  EXPECT_EQ(page::whyNamed(wave), "");  // the verdict does not name it
  wave.in_verdict = true;
  EXPECT_EQ(page::whyNamed(wave), "by the fall of BIC and its size; this shrink may be chance");
}

TEST(PageWords, LimitsOfTheAuditHaveADirection) {
  const SmallResult small;
  audit::AuditReport audited;
  const auto add = [&audited](const char* id, double value, double limit) {
    preparation::AuditCheck check;
    check.id = id;
    check.value = value;
    check.limit = limit;
    audited.checks.push_back(check);
  };
  add("reflector_on_axis", 0.264, 0.01905);
  add("circle_count", 20, 6);
  add("load_size", 413e3, 5e3);
  add("link_lengths", 0.757e-3, 20e-3);
  reports::ReportContent content = contentOf(small);
  content.campaigns[0].audit = &audited;
  const std::string page = page::reportPage(content);
  for (const char* limit :
       {"at least 19.1\u00a0mm", "at least 6\u00a0readings", "at least 5\u00a0N/mm", "at most 20\u00a0mm"})
    EXPECT_TRUE(says(page, limit)) << limit;
}

TEST(PageWords, ADayOfSweepsThatFailsSaysSoFirst) {
  SmallResult small;
  small.identification = identification::Identification(6);
  small.campaign.circle_sweeps.emplace();
  small.campaign.states.reset();
  audit::AuditReport audited;
  audited.verdict = preparation::AuditVerdict::fail;
  reports::ReportCampaign day{small.campaign, small.identification};
  day.audit = &audited;
  ASSERT_EQ(reports::kindOf(day), reports::DayKind::sweeps);
  const std::string verdict = reports::verdictOf({day}, {});
  EXPECT_TRUE(verdict.starts_with("The audit fails")) << verdict;
  EXPECT_TRUE(says(verdict, "joint axes are found from their circle sweeps")) << verdict;
  EXPECT_EQ(countOf(verdict, "The audit fails"), 1u);
}

TEST(PageWords, NumbersAndTheirUnitsAreReadable) {
  const extended_model::SeenCombination seen{
      1, {effects::Effect::bearing_tilt, "joint 2", "rad/Nm", 0.0}, 0.216, 1.791e-7, 3e-9 / 1.96};
  EXPECT_EQ(
      reports::combinationWords(seen),
      "1/k2 and bearing tilt (joint 2, rad/Nm) are hardly told apart; known is 1/k2 + 0.216 times that: (179.1 +- "
      "3.0) 1e-9 rad/Nm (U, 95 %)");
  EXPECT_EQ(page::interval({0.991, 0.9886, 0.9937}), "98.9 to 99.4");
  EXPECT_EQ(page::interval({0.9, 0.88, 0.92}), "88 to 92");
  EXPECT_EQ(page::interval({0.5, 0.5, 0.5}), "50 to 50");
  EXPECT_EQ(reports::shortDetail("joint 1, joint 2, joint 4, joint 3, joint 6"), "joints 1, 2, 3, 4 and 6");
  EXPECT_EQ(reports::shortDetail("joint 5, joint 4, joint 6"), "joints 4 to 6");
}

TEST(PageWords, CompliancesThatWouldBeNegativeAreOneNote) {
  calibration::Calibration calibration;
  calibration.models.resize(1);
  calibration.models[0].model = calibration::CalibratedModel::gravity;
  for (const char* joint : {"joint 4", "joint 5", "joint 6"})
    calibration.models[0].notes.emplace_back(calibration::RemarkId::negative_compliance, "joint_compliance", joint);
  calibration.models[0].notes.emplace_back(calibration::RemarkId::no_masses);
  const std::vector<std::string> notes = reports::modelNotes(calibration);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "gravity: joint compliance of joints 4 to 6 would be negative, which no spring is: left at zero");
}

TEST(PageWords, EffectsHaveNamesAndNoIds) {
  EXPECT_TRUE(reports::words(Remark(diagnosis::RemarkId::candidates_only,
                                    std::vector<std::string>{"bearing_tilt", "kinematic_error"}, 1.0, 0.1))
                  .starts_with("Beside that, bearing tilt and kinematic error are no more than candidates"));
}

TEST(PageWords, TheHeadingAndTheColumnsAreOfWhatThereIs) {
  const SmallResult inactive(campaign::DoubleEncoder::inactive);
  reports::ReportContent content = contentOf(inactive);
  content.compare_with_paper = true;
  std::string page = page::reportPage(content);
  EXPECT_TRUE(says(page, "<h2>Deflection compensated</h2>"));
  EXPECT_FALSE(says(page, "Paper: all"));
  Pair pair;
  pair.content.compare_with_paper = true;
  page = page::reportPage(pair.content);
  EXPECT_TRUE(says(page, "<h2>Deflection compensated and avoided</h2>"));
  EXPECT_EQ(countOf(page, "<th scope=\"col\">Paper: all</th>"), 1u);  // of the active day alone
}

TEST(PageWords, ThePaperIsCitedWhereItsNumbersStand) {
  const SmallResult small;
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_TRUE(says(page, "Table II: "));
  EXPECT_EQ(countOf(page, "Ambiehl, Garnier, Subrin and Furet, IROS 2017"), 1u);
}

TEST(PageWords, NothingRefersToItself) {
  const SmallResult small;
  audit::AuditReport audited;
  audited.verdict = preparation::AuditVerdict::warn;
  reports::ReportContent content = contentOf(small);
  content.campaigns[0].audit = &audited;
  const std::string page = page::reportPage(content);
  const std::size_t audit = page.find("<section id=\"audit\"");
  ASSERT_NE(audit, std::string::npos);
  // By the number that the browser counts before its heading.
  const std::string reference = fmt::format("(see <a href=\"#audit\">section\u00a0{}, Audit</a>)",
                                            countOf(page.substr(0, audit), "<section ") + 1);
  EXPECT_EQ(countOf(page, reference), 1u) << reference;
  EXPECT_EQ(countOf(page, "href=\"#audit\""), 2u);  // and the contents
  EXPECT_LT(page.find(reference), audit);
}

TEST(PageWords, APercentStaysWithItsNumber) {
  SmallResult small;
  small.campaign.texts.note = "at 93 % of the payload";
  const std::string page = page::reportPage(contentOf(small));
  EXPECT_TRUE(says(page, "at 93\u00a0% of the payload"));
}

}  // namespace page_words_test
}  // namespace stiffscope
