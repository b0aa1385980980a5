#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "reports/csv/posture_tables.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/paper_values.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"
#include "reports/words/verdict.h"

namespace stiffscope::page {

namespace {

/// The paper compensates what the active double encoders leave, and judges at P_wrist: beside other days it has
/// nothing.
bool besidePaper(const reports::ReportContent& content, const reports::ReportCampaign& campaign) {
  return content.compare_with_paper && campaign.campaign.double_encoder == campaign::DoubleEncoder::active;
}

reports::Row shareRow(const reports::ReportContent& content, const reports::ReportCampaign& campaign,
                      identification::Method method, bool at_wrist) {
  const identification::MethodResult& one = campaign.identification.of(method);
  const identification::Compensation& compensation = *reports::compensationAt(one, at_wrist);
  const bool subsets = !one.subsets.compliances.empty();
  const auto ofSubsets = [&](double share) { return subsets ? reports::percent(share) : std::string("–"); };
  reports::Row row{reports::shortName(method), reports::percent(compensation.all_postures),
                   ofSubsets(compensation.subsets.used), ofSubsets(compensation.subsets.held_out),
                   ofSubsets(compensation.subsets.all)};
  if (besidePaper(content, campaign))
    row.emplace_back(at_wrist ? reports::percent(reports::kPaperCompensated[static_cast<std::size_t>(method)], 0)
                              : "–");
  return row;
}

std::vector<reports::DataCell> shareData(const reports::ReportContent& content, const reports::ReportCampaign& campaign,
                                         identification::Method method, bool at_wrist) {
  const identification::MethodResult& one = campaign.identification.of(method);
  const identification::Compensation& compensation = *reports::compensationAt(one, at_wrist);
  std::vector<reports::DataCell> row{std::string(at_wrist ? "P_wrist" : "reflectors"),
                                     std::string(reports::namesOf(method).key), 100.0 * compensation.all_postures};
  if (one.subsets.compliances.empty()) {
    row.resize(row.size() + 3);
  } else {
    for (const double share : {compensation.subsets.used, compensation.subsets.held_out, compensation.subsets.all})
      row.emplace_back(100.0 * share);
  }
  const bool paper = at_wrist && besidePaper(content, campaign);
  row.push_back(paper ? reports::DataCell(100.0 * reports::kPaperCompensated[static_cast<std::size_t>(method)])
                      : reports::DataCell());
  return row;
}

reports::Table shareTable(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  reports::Table table{
      "Share of the deflection compensated",
      {"At", "Method", "All postures: fitted and judged", "Subsets: used", "Subsets: held out", "Subsets: all"},
      {}};
  table.id = "compensation";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"at",
                  "method",
                  "all_postures_percent",
                  "subsets_used_percent",
                  "subsets_held_out_percent",
                  "subsets_all_percent",
                  "paper_all_percent"};
  if (besidePaper(content, one)) table.columns.emplace_back("Paper: all");
  for (const bool at_wrist : {true, false}) {
    reports::RowGroup group{at_wrist ? "P_{wrist}" : "Reflectors", {}};
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& result = one.identification.of(method);
      if (result.available && reports::compensationAt(result, at_wrist)) {
        group.rows.push_back(shareRow(content, one, method, at_wrist));
        data.rows.push_back(shareData(content, one, method, at_wrist));
      }
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

/// Both points side by side, with the spread over the subsets.
reports::Table heldOutTable(const identification::Identification& result) {
  reports::Table table{"Share compensated on postures held out, and its standard deviation over the subsets, %",
                       {"Method", "At the reflectors", "sd at the reflectors", "At P_{wrist}", "sd at P_{wrist}"},
                       {{}}};
  table.id = "held-out";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"method", "at_reflectors_percent", "sd_at_reflectors_percent", "at_wrist_percent",
                  "sd_at_wrist_percent"};
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult& one = result.of(method);
    if (!one.available || one.subsets.compliances.empty()) continue;
    reports::Row row{reports::shortName(method)};
    std::vector<reports::DataCell> cells{std::string(reports::namesOf(method).key)};
    for (const bool at_wrist : {false, true}) {
      const auto& share = reports::compensationAt(one, at_wrist);
      row.emplace_back(share ? reports::fixed(100.0 * share->subsets.held_out, 2) : "–");
      row.emplace_back(share && std::isfinite(share->held_out_sd) ? reports::fixed(100.0 * share->held_out_sd, 2)
                                                                  : "–");
      cells.push_back(share ? reports::DataCell(100.0 * share->subsets.held_out) : reports::DataCell());
      cells.push_back(share ? reports::DataCell(100.0 * share->held_out_sd) : reports::DataCell());
    }
    table.groups.front().rows.push_back(std::move(row));
    data.rows.push_back(std::move(cells));
  }
  return table;
}

std::string noiseWords(const reports::ReportCampaign& one) {
  const identification::Identification& result = one.identification;
  if (!result.noise) {
    return fmt::format("How much noise alone keeps from being compensated is not known: {}.",
                       one.campaign.tracker ? "the campaign has displacements only, not the readings they come from"
                                            : "the tracker's noise is not declared");
  }
  const std::string at_targets = reports::percent(result.noise->at_targets);
  if (!result.noise->at_wrist) {
    return fmt::format(
        "The tracker's noise alone keeps about {} of the deflection at the reflectors from being compensated, by "
        "whatever model.",
        at_targets);
  }
  return fmt::format(
      "The tracker's noise alone keeps about {} of the deflection at P_{{wrist}}, and {} of that at the reflectors, "
      "from being compensated, by whatever model.",
      reports::percent(*result.noise->at_wrist), at_targets);
}

std::string withU(const comparison::Uncertain& number, double times) {
  return std::isfinite(number.value) ? reports::withUncertainty(times * number.value, times * number.expanded()) : "–";
}

std::string pWords(double p) {
  if (!std::isfinite(p)) return "–";
  return p < 1e-4 ? "< 0.0001" : reports::fixed(p, 4);
}

/// What the active encoders take away, joint by joint; joints that are stated to have none are marked. Where such a
/// joint has `changed`, no line is the encoders' alone.
reports::Table takenTable(const reports::AvoidedByEncoders& avoided, const std::vector<int>& having, bool changed) {
  reports::Table table{fmt::format("{} ± U, by {}",
                                   changed ? "What differs between the two states of the double encoders"
                                           : "What the double encoders take away",
                                   reports::longName(avoided.method)),
                       {"Joint", "Compliance 1/k, 10⁻⁹\u00a0rad/Nm", "Share of it, %",
                        "Of the deflection at the reflectors, %", "p (Holm)"},
                       {{}}};
  table.id = "taken-away";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"joint",
                  "compliance_rad_per_nm",
                  "u_rad_per_nm",
                  "share_percent",
                  "u_share_percent",
                  "deflection_at_reflectors_percent",
                  "u_deflection_at_reflectors_percent",
                  "p_value_holm"};
  for (std::size_t j = 0; j < avoided.by_joint.joints.size(); ++j) {
    const comparison::JointChange& joint = avoided.by_joint.joints[j];
    if (!joint.comparable) continue;
    const comparison::Uncertain gone{-joint.difference.value, joint.difference.sd, joint.difference.dof};
    const bool without =
        !having.empty() && std::find(having.begin(), having.end(), static_cast<int>(j)) == having.end();
    table.groups.front().rows.push_back({reports::Cell(fmt::format("1/{}", reports::jointName(static_cast<int>(j))),
                                                       without ? "no double encoder" : ""),
                                         withU(gone, 1e9), withU(joint.taken, 100.0), withU(joint.avoided, 100.0),
                                         pWords(joint.p_holm)});
    data.rows.push_back({static_cast<double>(j + 1), gone.value, gone.expanded(), 100.0 * joint.taken.value,
                         100.0 * joint.taken.expanded(), 100.0 * joint.avoided.value, 100.0 * joint.avoided.expanded(),
                         joint.p_holm});
  }
  return table;
}

void writeTaken(Html& html, const reports::ReportContent& content, const reports::AvoidedByEncoders& avoided) {
  if (!avoided.by_joint.available) return;
  const std::vector<reports::ReportCampaign> loaded = reports::ofKind(content.campaigns, reports::DayKind::loaded);
  const std::string changes = reports::changedWithoutEncoder(loaded, avoided);
  writeTable(html, takenTable(avoided, loaded.front().campaign.double_encoder_joints, !changes.empty()));
  if (!changes.empty())
    html.paragraph(
        fmt::format("Joints without a double encoder differ as well ({}): not only the encoders changed "
                    "between the two days, and what joints with one lose need not be the encoders' alone.",
                    changes));
  std::string words = avoided.by_joint.same_postures
                          ? fmt::format(
                                "Differences of compliances fitted on the {} postures of both states: what both "
                                "share cancels.",
                                avoided.by_joint.postures)
                      : avoided.by_joint.by_models
                          ? std::string("Differences of the compliances of each day's own model.")
                          : std::string(
                                "Differences of compliances fitted on other postures: what the model misses does not "
                                "cancel.");
  if (!avoided.residual_is_noise) {
    words +=
        " What joint springs leave is more than noise, or not known to be noise: shares are of the apparent "
        "compliance, which holds what else gives as the joint does.";
  }
  html.paragraph(words, "faint");
}

/// Which joints P_wrist and the reflectors see.
std::string whatIsSeen(const reports::ReportContent& content) {
  const int joints = content.campaigns.front().campaign.robot.joints();
  const bool same = std::all_of(content.campaigns.begin(), content.campaigns.end(),
                                [joints](const auto& one) { return one.campaign.robot.joints() == joints; });
  if (!same) return "the joints before the wrist's only, the reflectors all.";
  return fmt::format("joints {} only, the reflectors all {}.", reports::countsFromTo(1, robot::armJointsOf(joints)),
                     reports::countWord(joints));
}

void writeAvoided(Html& html, const reports::ReportContent& content) {
  std::string words;
  if (!content.avoided) return;  // the two states were not both measured: there is nothing to explain
  if (content.avoided->available) {
    words = fmt::format(
        "With the double encoders active the deflection at {} is smaller than with them inactive by {}, over {} "
        "postures at the same joint angles under the same load; the interval is of what other postures would give.",
        reports::pointOf(*content.avoided), reports::shareWords(*content.avoided), content.avoided->postures.size());
    if (content.compare_with_paper)
      words += fmt::format(" The paper: {}.", reports::percent(reports::kPaperAvoided, 0));
  } else {
    words = fmt::format("Not known: {}.", reports::words(content.avoided->reason));
  }
  html.leaf("h3", "Avoided by the double encoders");
  html.paragraph(words);
  writeTaken(html, content, *content.avoided);
}

}  // namespace

void writeCompensation(Html& html, const reports::ReportContent& content) {
  const auto section = html.element("section", {{"id", "compensation"}});
  html.leaf("h2", content.avoided ? "Deflection compensated and avoided" : "Deflection compensated");
  html.paragraph(
      "Compensated is 1 − Σ|what is left| / Σ|displacement|. Over the subsets of postures it is "
      "the mean: on the postures a subset used, on those it held out, and on all. P_{wrist} sees " +
      whatIsSeen(content));
  writeAvoided(html, content);
  writeEach(html, content, "compensation", isLoaded, [&](const reports::ReportCampaign& one) {
    if (!reports::shownMethod(one.identification)) {
      html.paragraph("No method is available, so nothing is compensated.");
      return;
    }
    if (const std::string negative = reports::negativeFitWords(one.identification); !negative.empty())
      html.paragraph(reports::capitalised(negative) + ": these shares say how well the readings are fitted.");
    if (one.identification.shown_first)
      html.paragraph(
          reports::withSubscripts(reports::shownFirstWords(one.identification, *one.identification.shown_first)));
    if (const reports::Table held_out = heldOutTable(one.identification); !held_out.groups.front().rows.empty())
      writeTable(html, held_out);
    writeTable(html, shareTable(content, one));
    if (const reports::DataTable postures = reports::postureTable(one); !postures.rows.empty())
      html.keepTable("postures", reports::csvTable(postures));
    if (one.identification.wrist_displacement.empty()) {
      html.paragraph("P_{wrist} is not measured in the load states: shares are given at the reflectors.");
    }
    html.paragraph(noiseWords(one));
  });
}

}  // namespace stiffscope::page
