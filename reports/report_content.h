#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/accuracy_diagnosis.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/audit/audit.h"
#include "core/campaign/campaign.h"
#include "core/comparison/compare.h"
#include "core/conformity/decide.h"
#include "core/diagnosis/diagnosis.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"
#include "core/workspace/workspace_stiffness.h"

namespace stiffscope::reports {

/// A campaign as it was used, with what was identified from it, how the audit judges the readings, and what was
/// done to them beforehand, how the station moved before that was corrected for, and what the model misses. Refers to
/// all of these; the pointers may be null. Readings of sweeps and nests are shown; load states are shown as the
/// identification's cases, the rows of their tables need not be there.
struct ReportCampaign {
  const campaign::Campaign& campaign;
  const identification::Identification& identification;
  const audit::AuditReport* audit = nullptr;
  const preparation::Preparation* preparation = nullptr;
  const preparation::StationMotion* station = nullptr;
  const diagnosis::Diagnosis* diagnosis = nullptr;
  const extended_model::ExtendedModel* improved =
      nullptr;  ///< effects were asked for: `campaign` and `identification` are of it
  const accuracy::AccuracyDiagnosis* accuracy = nullptr;  ///< of a day without a load; the calibration is in it
  calibration::CalibrationOptions calibrated_by = accuracy::kDiagnosisFolds;  ///< how that was held out
  const workspace::WorkspaceStiffness* workspace = nullptr;                   ///< of a loaded day
  const std::vector<conformity::Decision>* decisions = nullptr;  ///< on the acceptance limits, where there are any
};

/// What a day can say: stiffness under loads, accuracy in unloaded postures, or the geometry by sweeps alone.
enum class DayKind { loaded, unloaded, sweeps };
DayKind kindOf(const ReportCampaign& one);
bool anyOfKind(const std::vector<ReportCampaign>& campaigns, DayKind kind);
std::vector<ReportCampaign> ofKind(const std::vector<ReportCampaign>& campaigns, DayKind kind);

/// Of the machine that has most: tables of several campaigns have a row a joint.
int mostJointsOf(const std::vector<ReportCampaign>& campaigns);

/// The two days' models for a comparison; none where a day has none.
comparison::SupportedModels supportedModels(const extended_model::ExtendedModel* before,
                                            const extended_model::ExtendedModel* after);

/// What active double encoders keep away of the deflection (paper, IV.E), with its interval over postures.
struct AvoidedByEncoders : comparison::DeflectionAvoided {
  bool at_wrist = false;  ///< judged at P_wrist; else at the reflectors (means)
  /// Joint by joint: what the active encoders take away of each compliance, by the method that stands for both.
  identification::Method method = identification::Method::complete_pose;
  comparison::StiffnessChange by_joint;
  bool residual_is_noise = false;  ///< else shares of the inactive compliance are of apparent stiffnesses
};

/// What the double encoders avoid, by the first campaign with them inactive (before) and the first with them active
/// (after). Empty without such a pair; not available, with the reason, where they are of two machines or have
/// no posture in common.
std::optional<AvoidedByEncoders> avoidedByEncoders(const std::vector<ReportCampaign>& campaigns);

/// The point at which it is judged, rich text: "P_{wrist}" or "the reflectors".
std::string pointOf(const AvoidedByEncoders& avoided);

/// "33.2 % (95 %: 31.0 to 35.1 %)"; without an interval the share alone.
std::string shareWords(const AvoidedByEncoders& avoided);

/// A value that stands in a picture, for what is laid over it: shares of its width and height; what it is of.
struct FigureMark {
  double x = 0, y = 0;
  std::string series, category;  ///< rich texts; of an axis of numbers no category
  double value = 0, at = 0;      ///< in the unit of the axes; `at` on the horizontal one
  std::string quantity{};        ///< what the value's axis says, which may be its panel's own
};

/// A finished picture with its words. In title and caption `x_{abc}` sets abc as a subscript; `alt` is plain.
struct Figure {
  std::string id;  ///< unique in a report; letters, digits and hyphens: an anchor, and a file's name without ".png"
  std::string title;
  std::string caption;  ///< what to see in it, with the number
  std::string alt;      ///< what the picture shows, for those who do not see it
  std::vector<std::uint8_t> png;
  int width = 0;                              ///< pixels
  int height = 0;                             ///< pixels
  std::vector<FigureMark> marks = {};         ///< empty: nothing is laid over it
  std::string value_name{}, category_name{};  ///< what the axes say: "Residual (µm)", "Posture"
  std::string section = "figures";            ///< id of the section of the page that it stands in; see kFigureSections
  /// Which of the report's campaigns it is of, by its place among them; empty: of all, or of the only one.
  std::optional<std::size_t> campaign = std::nullopt;
};

/// The sections that have figures, in the order of the page: figures are counted in it.
inline constexpr std::array kFigureSections{"opening", "accuracy",  "station", "accuracy-gap", "wrist",
                                            "links",   "stiffness", "subsets", "workspace",    "compensation",
                                            "gap",     "figures",   "audit",   "postures"};

/// The name of its file in a report's folder.
inline std::string pictureFile(const Figure& figure) { return figure.id + ".png"; }

/// The data of a scene that stands for a figure where a browser can draw it (app/figures/page_scene.h).
struct PageScene {
  std::string figure;  ///< its id
  std::string json;
};

/// A name with its value: a version, a setting.
struct NamedText {
  std::string name, text;
};

/// Everything the report page shows. Nothing else goes in, no clock and no environment: the same content
/// gives the same bytes. Campaigns are referred to, not copied: they must outlive the page's making.
struct ReportContent {
  std::string title;
  std::string verdict;  ///< one to three sentences; verdictOf makes them
  std::vector<ReportCampaign> campaigns;
  std::optional<AvoidedByEncoders> avoided;  ///< by the double encoders, where both states were measured
  std::vector<Figure> figures;
  std::vector<PageScene> scenes;
  std::vector<NamedText> versions;  ///< stiffscope and its libraries
  std::vector<NamedText> settings;
  std::string command_line;         ///< empty: not shown
  std::string limits_file;          ///< of the acceptance limits, its bare name; empty: none were given
  bool compare_with_paper = false;  ///< beside the figures of Ambiehl et al., IROS 2017
};

/// What a report is known by: twelve hex digits of the SHA-256 of the names and hashes of all files read, of
/// the settings, the version of the program and whether the paper stands beside. The same input gives the same
/// id, on any day and any machine: "4f2a-91c0-77de".
std::string reportId(const ReportContent& content);

}  // namespace stiffscope::reports
