#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnosis/gap_study.h"
#include "core/effects/effect.h"
#include "core/extended_model/effect_offsets.h"
#include "core/extended_model/fitted_effects.h"
#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/identification/identify.h"

namespace stiffscope::extended_model {

/// A parameter of an effect that may hide, in words of effect_model.h.
struct HiddenParameter {
  effects::Effect effect = effects::Effect::link_compliance;
  std::string name;  ///< "joint 3", "1/GJ of link 3"
  std::string unit;  ///< SI
  double fit = 0.0;  ///< what the model has of it; 0 where it has none
};

/// c_j + ratio theta: what the data determine where they tell neither from the other (1/k4 + L/GJ of the forearm).
struct SeenCombination {
  int joint = 0;  ///< 0-based
  HiddenParameter parameter;
  double ratio = 0.0;  ///< rad/Nm by the parameter's unit
  double value = 0.0;  ///< rad/Nm
  double sd = 0.0;     ///< standard uncertainty of `value`, rad/Nm
};

/// For each identifiable joint the parameter whose combination with the compliance is known best, where it is known at
/// least three times better than the compliance itself: the ratio that leaves least of the draws, least squares about
/// the fit. `moved` and `off`: how far the compliances (joints x draws) and the parameters (one a row) are from the
/// fit; `own`: covariance of the compliances by everything else, which the combination keeps.
std::vector<SeenCombination> seenCombinations(const std::vector<HiddenParameter>& parameters,
                                              const Eigen::MatrixXd& moved, const Eigen::MatrixXd& off,
                                              const JointMatrix& own,
                                              const identification::StiffnessEstimate& estimate);

/// Where a part of a joint's uncertainty comes from.
enum class BudgetSource {
  scatter,         ///< between postures: noise, and what the model does not explain
  frames,          ///< the measured axes
  wrist,           ///< radii about the wrist centre
  geometry,        ///< calibrated on unloaded positions
  effect,          ///< an effect: of its fitted size where it is in the model, of all that could hide where it is not
  correlation,     ///< what the effects' parts have in common: they are known less well one by one than together
  load_cell_gain,  ///< as declared
  masses,          ///< the URDF's, as declared
  tracker_scale,   ///< as declared
  standing_load,   ///< joints go on deflecting while a load stays on (courseOfDay)
  over_day,        ///< compliances grow or shrink over the day
  apparent,        ///< between this model and joint springs alone, where no model explains the gap
};

/// One line of the budget of all joints (GUM, annex H).
struct BudgetLine {
  BudgetSource source = BudgetSource::scatter;
  std::optional<effects::Effect> effect;
  bool in_model = false;  ///< of an effect: fitted, not only possible
  bool declared = false;  ///< of an effect: its size is known beforehand from what is declared
  JointVector variance;   ///< of c, rad^2/(Nm)^2; negative where a correlation takes away
  JointVector dof;        ///< degrees of freedom; 0: known exactly, or from all draws together

  BudgetLine(BudgetSource of, JointVector variance_of_c)
      : source(of), variance(std::move(variance_of_c)), dof(JointVector::Zero(variance.size())) {}
  BudgetLine(BudgetSource of, JointVector variance_of_c, JointVector its_dof)
      : source(of), variance(std::move(variance_of_c)), dof(std::move(its_dof)) {}
};

/// What the day declares with a standard uncertainty, and what one of these does; and what its course shows.
struct Declared {
  double gain_sd = 0.0;        ///< of the load cell's scale, a share
  double cell_angle_sd = 0.0;  ///< of its axes about each of these, rad: of load_cell_misalignment beforehand
  double cell_point_sd = 0.0;  ///< of its point along each axis, m: of load_point_error beforehand

  struct Column {
    BudgetSource source = BudgetSource::masses;
    std::array<JointVector, 3> compliance;  ///< by Method: change by one standard uncertainty, rad/Nm
  };
  std::vector<Column> columns;
};

/// What else may be true of the machine, a draw each column: all that intervals and predictions are made of.
struct HiddenDraws {
  EffectColumns columns;                ///< the effects' parameters in the study's equations
  std::vector<effects::Effect> effect;  ///< of each of them
  std::vector<HiddenParameter> named;   ///< the same with its name and fitted size
  std::vector<bool> declared;           ///< whether its size is known beforehand
  Eigen::MatrixXd off;                  ///< theta - theta_fit

  /// Errors of one method's compliances.
  struct OfMethod {
    std::vector<Eigen::Index> possible;  ///< draws in which no stiffness is negative
    JointsByColumn compliance;           ///< c of these draws less the estimate's, rad/Nm
    JointMatrix others;                  ///< covariance of c by what is no effect, for normal numbers of its coverage
  };
  std::array<OfMethod, 3> methods;  ///< by Method; empty where that is not available
};

/// How far the data let anything besides the fitted model move the stiffnesses.
struct HiddenEffects {
  double lack_of_fit = 0.0;  ///< chi2 per degree of freedom of the loading that joint springs alone leave
  double left_over = 0.0;    ///< that of the model
  double left_limit = 0.0;   ///< what chance makes of that, by which the diagnosis judges it, too
  /// Share of the gap beyond noise that the model leaves, and whether that is too much to call the model an
  /// explanation: where the diagnosis says `unknown` and it is more than a few per cent. Then the intervals hold what
  /// joint springs alone say, too.
  double unexplained_share = 0.0;
  bool unexplained = false;
  std::array<std::vector<BudgetLine>, 3> budget;  ///< by Method; empty where that is not available
  /// By Method: what is seen of joints that the data does not tell from an effect; none where no model explains the
  /// gap.
  std::array<std::vector<SeenCombination>, 3> combinations;
  HiddenDraws draws;
  double gain_sd = 0.0;  ///< of the load cell's scale, as declared
  /// Where the fitted sizes of the model's effects make a stiffness of the method shown first negative, and joint
  /// springs alone do not: by how much each parameter of `draws` changes, on the mean, in the draws whose effects in
  /// the model leave none negative; to nothing where hardly a draw does.
  std::optional<Eigen::VectorXd> to_possible;
};

/// Puts into the estimates of `with` the intervals that hold what could still hide.
///
/// With theta the parameters of all effects that the campaign can show, a method's compliances are to first order c
/// = c_fit - H (theta - theta_fit): H through the method's own equations (method_equations.h), theta_fit what `with`
/// was corrected for, theta from its posterior on the study's equations (below). Draws with a negative
/// stiffness are left out, and where c_fit itself has one the medians of the rest stand for it. With the scatter
/// between postures, what frames and calibration share, and what is declared (Declared) they give each interval: the
/// shortest one of the stated coverage, tails in steps of 0.5 %, widened to hold c_fit and its own interval. Where
/// angles or point of the load cell are declared with an uncertainty, that is what is known beforehand of the effect
/// that they are.
///
/// Where the model explains too little, half of the draws are those of `without`, joint springs alone: neither is
/// right.
///
/// The frames of `with` get what the same draws do to them, and where the model explains too little their distance to
/// `frames_without`, those of springs alone.
///
/// `seen`: cases and equations from which H is taken, of postures that the study has; `with` itself where it has all.
/// `seen_campaign`: what `seen` was identified from.
HiddenEffects weighHiddenEffects(const diagnosis::GapStudy& study, const EffectFit& fitted,
                                 const campaign::Campaign& seen_campaign, const identification::Identification& seen,
                                 const identification::Identification& without, const frames::Frames& frames_without,
                                 const Declared& declared, identification::Identification& with);

/// What `campaign` declares with a standard uncertainty, at the result `at` that was identified from it by `options`.
/// Masses (the URDF's, all by one factor; the tool is weighed by itself) and the tracker's scale (distances from its
/// station) act by a difference of the whole identification, one declared standard uncertainty up; of a day of more
/// than preparation::kMostAveraged postures, of so many. Nothing is identified anew for what is not declared, nor where
/// estimates alone are asked for.
Declared declaredOf(const campaign::Campaign& campaign, const identification::Identification& at,
                    const identification::IdentifyOptions& options);

/// What the readings' course says of the compliances themselves: one number a joint is meant, and they change.
struct CourseOfDay {
  /// Growth of the displacement between the first repeat of a standing load and the last, a share of it
  /// (preparation::StandingMotion); 0 where chance makes as much.
  double standing = 0.0;
  /// Change of all compliances from the middle of the day to its ends, a share of them; 0 where chance makes as much.
  double over_day = 0.0;
  double over_day_t = 0.0;  ///< of that change over its standard uncertainty, which counts postures as wholes

  bool any() const { return standing != 0.0 || over_day != 0.0; }
};

/// Change over the day: with s from -1 at the first posture to 1 at the last, y_p = A_p c (1 + beta s_p) by least
/// squares over the reflectors of a method's equations, c and beta free, beta's uncertainty from the scatter between
/// postures (sandwich). `at` was identified from `campaign`. Nothing where states have no times.
CourseOfDay courseOfDay(const campaign::Campaign& campaign, const identification::Identification& at);

/// As lines of the budget, of all methods of `at`: twice the growth, and twice the change from the middle of the day to
/// its ends, as standard uncertainties. How far joints moved before the first reading nobody has read.
void addCourse(const CourseOfDay& course, const identification::Identification& at, Declared& declared);

/// What the data say of all effects' parameters together, stiffnesses and geometry fitted away: chi2(x) = x^T N x
/// - 2 b^T x + const, x in units of the parameters' physical bounds (effect_model.h).
struct EffectEvidence {
  Eigen::MatrixXd normal;          ///< N, n x n, positive semidefinite
  Eigen::VectorXd right;           ///< b, n
  std::vector<std::size_t> group;  ///< the effect of each parameter, 0, 1, ...
  std::vector<std::size_t> scale;  ///< l of each parameter, 0, 1, ...; those that share it are alike; empty: none do
  std::vector<bool> positive;      ///< a compliance, a width: never negative
  std::vector<double> known_sd;    ///< of each parameter beforehand, where that is declared; 0 or absent: it is not
};

struct PosteriorOptions {
  int draws = 1800;   ///< of all chains together
  int chains = 2;     ///< independent of each other, side by side
  int warm_up = 150;  ///< made by each chain before its first
  std::uint64_t seed = 1;
};

/// Draws from the posterior of x: n rows, a draw each column.
///
/// Prior: the horseshoe (Carvalho, Polson and Scott, Biometrika 97, 2010, 465), x_i ~ N(0, l_i^2 t_g^2) with l_i ~
/// C+(0, 1) for the parameter and t_g ~ C+(0, kUsual) for its effect g; x_i > 0 where that is physics. Most effects of
/// a machine are too small to matter and some are large: this prior says just that. Where the data do not see a
/// parameter it stays as small as its effect's others; where they see it, the heavy tails leave it as it is. Parameters
/// that are alike by physics (EffectPart::alike: a link's bending and its twist) share one l_i: a link that hardly
/// bends hardly twists, though its twist looks like that of the joint beside it. The prior of a parameter that is
/// declared with a standard uncertainty is normal with that.
///
/// By Gibbs sampling: the parameters of either sign jointly; those that are positive with the former integrated out,
/// one after the other and along random lines through all of them; the scales by their inverse gamma mixtures (Makalic
/// and Schmidt, IEEE Signal Processing Letters 23, 2016, 179) and by stretching their parameters with them. Positive
/// parameters that the data hardly tell apart explain them the one or the other, and go from one explanation to the
/// other along lines with their scales integrated out (horseshoe.h). The same seed gives the same draws. Each step
/// follows the evidence smoothly but for the rare one between explanations that is not taken: what another processor
/// rounds otherwise hardly changes the draws, but where explanations vie it may by as much as another seed.
Eigen::MatrixXd drawEffects(const EffectEvidence& evidence, const PosteriorOptions& options = {});

/// Scale of an effect's size before anything is measured, as a share of the physical bounds. From a third to three
/// times it, intervals hold the truth as often.
inline constexpr double kUsual = 0.03;

}  // namespace stiffscope::extended_model
