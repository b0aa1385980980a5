#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/comparison/paired_fit.h"
#include "core/fleet/campaign_result.h"
#include "metrology/remark.h"

namespace stiffscope::fleet {

/// A compliance that is another from one date on.
struct Step {
  int joint = 0;                     ///< from 0
  std::size_t first = 0;             ///< day from which the change holds
  std::size_t begin = 0, end = 0;    ///< from the step before to the next: [begin, first) against [first, end)
  comparison::Uncertain difference;  ///< mean of the days after - mean of those before, rad/Nm
  comparison::Uncertain before;      ///< mean compliance of the days before, rad/Nm
  double p_value = 1.0;              ///< of no difference, times the number of what was tried (ComplianceSeries)

  Stated share() const;  ///< difference over `before`; not numbers where `before` is not above its own U
};

/// A joint's compliance on the dates of one machine, as a control chart.
struct ControlChart {
  struct Point {
    double value = kUnknown;     ///< compliance less the centre, over the centre
    double expanded = kUnknown;  ///< U of that (95 %): what is not the same on every day
    double limit = kUnknown;     ///< +-: chance is outside in kOutside of all days
    bool outside = false;
  };
  double centre = kUnknown;   ///< mean compliance of the days before the first step, rad/Nm
  std::vector<Point> points;  ///< none where `centre` is not above its own U: shares of it are not known
  double scatter = kUnknown;  ///< of the dates between steps, over what is stated; not a number of few dates
  double scatter_p = 1.0;     ///< chance of as much
};

/// Chance that a day of an unchanged machine is outside the limits of one joint's chart: three standard deviations.
inline constexpr double kOutside = 0.0027;

/// The compliances of one machine over its days, by one method and joint springs alone, or by own weight. A day's
/// compliance errs by sum_p g_p over its postures and by what they share. With weights w_t that sum to zero
///
///   d = sum_t w_t c_t,   u^2(d) = sum_p (sum_t w_t g_t,p)^2 + sum_t w_t^2 v_t,
///
/// g_t,p the influence of posture p on day t, v_t the shared variance: what the model misses in a posture is the same
/// on every day and cancels in value and uncertainty alike (PairedFit, for two days). Where all days have the same
/// postures, the first sum is pooled over the dates between which nothing is said to have changed,
///
///   |w|^2 s^2,   s^2 = sum over segments, t, p of (g_t,p - mean of the segment)^2 / (days - segments),
///
/// with so many more degrees of freedom, unless the sum itself is larger than chance makes it (F, 1 %): then something
/// changed that the springs do not hold, and the sum is taken. Days are assumed to err independently beyond this; an
/// error of several days in a row (a load cell recalibrated) is a change like any other.
///
/// Steps: no step, one and two are held against each other, at all dates and all pairs of dates, since of two that
/// partly undo each other neither may show alone, and of two the same way one is found between them. Those dates are
/// the likeliest at which the differences d of the means of segments that adjoin have the largest d^T C^-1 d, C by a
/// scatter that is the same for all dates; their own would prefer dates at which it is small by chance. Two steps are
/// taken where both are beyond chance, else one; then the same within each segment. The p-value of one step among n
/// days counts (n - 1) / 0.9 times, for the dates tried, those of two (n - 1) (n - 2) / 2 / 0.1 times, for the pairs:
/// together an unchanged series has a step in at most `level` of all cases. Where one is beyond chance, two are held
/// to (n - 1) / 0.9 as well, the question being whether a second stands beside it.
class ComplianceSeries {
 public:
  /// Days in the order of time; `method`, or without one the own weight, is available in all of them.
  ComplianceSeries(const std::vector<const CampaignResult*>& days, std::optional<identification::Method> method);

  std::size_t days() const { return days_.size(); }
  /// Whether all days have all postures: pose id, angles and force, as comparison::matchPostures asks.
  bool samePostures() const { return same_postures_; }
  /// How many postures all days have.
  std::size_t posturesOfAll() const;
  /// Seen on every day.
  bool has(int joint) const;

  /// sum_t w_t c_t with its uncertainty; days of one segment are those between which nothing changed, `first_days` the
  /// first of each, in order, beginning with 0.
  comparison::Uncertain contrast(int joint, const Eigen::VectorXd& weights,
                                 const std::vector<std::size_t>& first_days) const;

  /// That nothing changed: the smaller p-value of the likeliest step and of the likeliest two (the larger of theirs),
  /// times the number of what was tried.
  double pOfNoStep(int joint) const;

  /// All steps, in order of time: what is found first at `level`, further ones within the segments at `further`. Each
  /// is the difference between the segments that adjoin, estimated once all steps are known.
  std::vector<Step> steps(int joint, double level, double further) const;
  std::vector<Step> steps(int joint, double level) const { return steps(joint, level, level); }

  /// Share of the mean compliance that a step from day `first` on has to have so that nine times in ten its p-value,
  /// times the number of what is tried, is at most `level`: (t + 1.28) u of the contrast. Not a number where the
  /// joint is not seen on every day, or no uncertainty can be stated.
  double detectableStep(int joint, std::size_t first, double level) const;

  /// Two-sided p-value of a number that is zero; 1 where it has no uncertainty.
  static double pOfNothing(const comparison::Uncertain& number);

  ControlChart chart(int joint, const std::vector<Step>& steps) const;

 private:
  const SpringsOfDay& springs(std::size_t day) const;
  double pooledScatter(int joint, const std::vector<std::size_t>& first_days) const;
  Step stepBetween(int joint, std::size_t segment, const std::vector<std::size_t>& first_days) const;
  friend class StepSearch;

  std::vector<const CampaignResult*> days_;
  std::optional<identification::Method> method_;
  std::vector<std::vector<std::size_t>> places_;  ///< by day and posture: equal where postures correspond
  std::size_t place_count_ = 0;
  bool same_postures_ = true;
};

/// Chance, over all questions of a fleet together, that something is said to have changed where nothing did.
inline constexpr double kFleetLevel = 0.01;

/// One campaign of a fleet.
struct FleetCampaign {
  std::string folder;                    ///< as found
  std::string machine, date;             ///< whose and when, even where there is no result
  std::optional<CampaignResult> result;  ///< empty: `failure` says why
  std::string failure;
  std::string report;          ///< its own, relative to the fleet's page; empty: none
  std::string report_failure;  ///< why one that was asked for is not there, of a campaign with a result
};

/// Whose a campaign is: `robot_serial`, else `item`, else the name of the folder that holds the campaign's.
std::string machineOf(const std::string& robot_serial, const std::string& item, const std::string& folder);

/// Campaign `before` and the next of its machine in the same state, by their places among the fleet's campaigns.
struct FleetPair {
  std::size_t before = 0, after = 0;
  std::optional<PairResult> result;
  std::string failure;
  /// Corrected for all questions that the pairs of the fleet ask (Holm): by joint, as many as the machine has (by
  /// studyFleet; before it none), and of the geometry.
  PerJoint<double> p_holm;
  double machine_p_holm = kUnknown;
};

/// Campaigns under one machine's name whose URDFs describe one arm, none refused by `compare` beside another. Several
/// arms under one name are of different machines, which nothing is asked of together.
struct Arm {
  std::string machine;
  std::vector<std::size_t> campaigns;  ///< those with a result, in order of date
  // Of its first campaign, where it is not the first arm under this name:
  Remark difference;             ///< what `compare` says
  std::size_t differs_from = 0;  ///< beside this campaign of the first arm
};

/// Days of one machine that can be held against each other: of one kind, the double encoders in one state, and of one
/// arm.
struct DaySeries {
  std::string machine;
  std::size_t arm = 0;  ///< of the fleet's
  DayKind kind = DayKind::loaded;
  campaign::DoubleEncoder encoders = campaign::DoubleEncoder::unspecified;
  int joints = 0;
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

/// Smallest share of a joint's compliance by which it has to change to be found nine times in ten, among all questions
/// of the fleet: in the middle of the dates, and on the last one alone. Not numbers of joints that the days do not see.
struct Detectable {
  double middle = kUnknown, last = kUnknown;
};

/// The control charts of a series, by joint; those without points are of joints that its days do not see, or whose
/// compliance is not above its own U.
struct SeriesCharts {
  std::size_t series = 0;
  std::optional<identification::Method> method;  ///< none: by own weight
  bool same_postures = false;
  PerJoint<ControlChart> joints;
  PerJoint<Detectable> detectable;
};

/// What a machine needs, the most urgent first in the order of this list.
enum class NeedId {
  no_result,
  several_machines,  ///< under one name
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
  std::vector<Arm> arms;                 ///< by machine, date of the first campaign
  std::vector<DaySeries> series;
  std::vector<FleetPair> pairs;
  std::vector<SeriesCharts> charts;
  std::vector<FleetStep> steps;    ///< by machine, date
  std::vector<Machine> machines;   ///< those that need most first
  std::size_t pair_questions = 0;  ///< that Holm's correction of the pairs is for
  /// Of the charts: a joint of a series each; and the geometry of each pair of days without a load.
  std::size_t chart_questions = 0;
};

/// The order of machine, date (as texts: 2026-11-24) and folder, which is that of everything that follows.
bool inOrder(const FleetCampaign& a, const FleetCampaign& b);
void sortCampaigns(std::vector<FleetCampaign>& campaigns);

/// The arms of sorted campaigns: each is of the first arm under its name with all of whose campaigns it can be
/// compared.
std::vector<Arm> armsOf(const std::vector<FleetCampaign>& campaigns);

/// The series of sorted campaigns, of those with a result.
std::vector<DaySeries> seriesOf(const std::vector<FleetCampaign>& campaigns);

/// Each day with the next of its series.
std::vector<FleetPair> pairsOf(const std::vector<DaySeries>& series);

/// Fills the results of the pairs of days with loads from what is kept of each: differences of compliances as
/// comparison::PairedFit has them, of all postures of both.
void compareLoaded(const std::vector<FleetCampaign>& campaigns, std::vector<FleetPair>& pairs);

/// The same by own weight, into the results that the pairs of days without a load have of their geometry.
void compareUnloaded(const std::vector<FleetCampaign>& campaigns, std::vector<FleetPair>& pairs);

/// What follows from the results of all campaigns (sorted) and pairs.
///
/// A compliance, of days without a load that by own weight, has changed where the likeliest step or two of its series
/// (ComplianceSeries) have a p-value, corrected for the dates at which they could have been and by Holm for the joints
/// of all series of the fleet and its pairs of days without a load, of kFleetLevel at most. A geometry has changed
/// where the pair's has. An effect has appeared where the diagnosis of no day before, two or more, and of every day
/// from then on, two or more, names it, gone the other way round; a diagnosis names an effect that is not there on one
/// day in a hundred or fewer.
Fleet studyFleet(std::vector<FleetCampaign> campaigns, std::vector<FleetPair> pairs);

}  // namespace stiffscope::fleet
