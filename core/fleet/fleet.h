#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/fleet/campaign_result.h"
#include "core/fleet/compliance_series.h"
#include "metrology/remark.h"

namespace stiffscope::fleet {

/// Chance, over all questions of a fleet together, that something is said to have changed where nothing did.
inline constexpr double kFleetLevel = 0.01;

/// One campaign of a fleet.
struct FleetCampaign {
  std::string folder;                    ///< as found
  std::string machine, date;             ///< whose and when, even where there is no result
  std::optional<CampaignResult> result;  ///< empty: `failure` says why
  std::string failure;
  std::string report;  ///< its own, relative to the fleet's page; empty: none
};

/// Whose a campaign is: `robot_serial`, else `item`, else the name of the folder that holds the campaign's.
std::string machineOf(const std::string& robot_serial, const std::string& item, const std::string& folder);

/// Campaign `before` and the next of its machine in the same state, by their places among the fleet's campaigns.
struct FleetPair {
  std::size_t before = 0, after = 0;
  std::optional<PairResult> result;
  std::string failure;
  /// Corrected for all questions that the pairs of the fleet ask (Holm): by joint, and of the geometry.
  std::array<double, 6> p_holm{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  double machine_p_holm = kUnknown;
};

/// Days of one machine that can be held against each other: of one kind, the double encoders in one state.
struct DaySeries {
  std::string machine;
  DayKind kind = DayKind::loaded;
  campaign::DoubleEncoder encoders = campaign::DoubleEncoder::unspecified;
  std::vector<std::size_t> campaigns;  ///< in order of date
};

/// What is another from one date on.
struct FleetStep {
  enum class What { compliance, effect_appeared, effect_gone, geometry };
  What what = What::compliance;
  std::string machine;
  std::size_t series = 0;
  std::size_t campaign = 0;  ///< the first day on which it holds
  std::size_t days_before = 0, days_after = 0;
  Step compliance;
  std::vector<std::string> effects;  ///< that it may be
  double size = kUnknown;            ///< of a geometry: rms at the reflectors, m
  double p_holm = kUnknown;          ///< of compliances and geometry
};

/// The control charts of a series, by joint; those without points are of joints that its days do not see.
struct SeriesCharts {
  std::size_t series = 0;
  identification::Method method = identification::Method::partial_pose;
  bool same_postures = false;
  std::array<ControlChart, 6> joints;
};

/// What a machine needs, the most urgent first in the order of this list.
enum class NeedId {
  no_result,
  audit_failed,
  changed,
  unknown_gap,
  audit_not_testable,
  perhaps_changed,  ///< an effect on the last day alone
  dates_scatter,
  joint_imprecise,
  audit_warned,
  nothing,
};

struct Need {
  NeedId id = NeedId::nothing;
  Remark reason, next;
  std::size_t campaign = 0;  ///< the day that says so
};

struct Machine {
  std::string name;
  std::vector<std::size_t> campaigns;  ///< in order of date
  std::vector<Need> needs;             ///< the most urgent first; never empty
};

struct Fleet {
  std::vector<FleetCampaign> campaigns;  ///< by machine, date, folder
  std::vector<DaySeries> series;
  std::vector<FleetPair> pairs;
  std::vector<SeriesCharts> charts;
  std::vector<FleetStep> steps;     ///< by machine, date
  std::vector<Machine> machines;    ///< those that need most first
  std::size_t pair_questions = 0;   ///< that Holm's correction of the pairs is for
  std::size_t chart_questions = 0;  ///< of the charts: a joint of a series each, and a pair of days without a load each
};

/// The order of machine, date (as texts: 2026-11-24) and folder, which is that of everything that follows.
bool inOrder(const FleetCampaign& a, const FleetCampaign& b);
void sortCampaigns(std::vector<FleetCampaign>& campaigns);

/// The series of sorted campaigns, of those with a result.
std::vector<DaySeries> seriesOf(const std::vector<FleetCampaign>& campaigns);

/// Each day with the next of its series.
std::vector<FleetPair> pairsOf(const std::vector<DaySeries>& series);

/// Fills the results of the pairs of days with loads from what is kept of each: differences of compliances as
/// comparison::PairedFit has them, of all postures of both.
void compareLoaded(const std::vector<FleetCampaign>& campaigns, std::vector<FleetPair>& pairs);

/// What follows from the results of all campaigns (sorted) and pairs.
///
/// A compliance has changed where the likeliest step of its series (ComplianceSeries) has a p-value, corrected for the
/// dates at which it could have been and by Holm for the joints of all series of the fleet and its pairs of days
/// without a load, of kFleetLevel at most. A geometry has changed where the pair's has. An effect has appeared where
/// the diagnosis of no day before, two or more, and of every day from then on, two or more, names it, gone the other
/// way round; a diagnosis names an effect that is not there on one day in a hundred or fewer.
Fleet studyFleet(std::vector<FleetCampaign> campaigns, std::vector<FleetPair> pairs);

}  // namespace stiffscope::fleet
