#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/audit/audit_input.h"
#include "core/campaign/campaign.h"
#include "core/campaign/state_points.h"
#include "core/mistakes/suspected.h"
#include "metrology/remark.h"

// What a day measures more often than it needs, and what that leaves: the load's one point, the tool that is rigid, the
// wrist's sphere, and the declared noise that all of them are held against. Several checks use them.

namespace stiffscope::audit {

/// A sum of squares over the declared variance, chi-square with `dof` degrees of freedom where only noise is in it.
struct NoiseSum {
  double chi2 = 0.0;
  int dof = 0;
  double ratio() const;  ///< standard deviation found against declared; 0 without degrees of freedom
};

/// What a day's readings say of one instrument's declared noise.
struct DeclaredNoise {
  Remark where;   ///< the instrument
  Remark reason;  ///< why nothing can be said; empty where something can
  /// Its figures found against declared where these are wrong by more than a factor of two, else 1: of the tracker
  /// along and across the beam, of the load cell one for all.
  std::vector<double> factors;
  double deviation = 1.0;            ///< larger of factor and its inverse that the readings bear out
  bool too_large = false;            ///< declared is more than twice of what is found
  bool too_small = false;            ///< declared is less than half of what is found
  bool explained = false;            ///< by a mistake that the readings show otherwise, as another unit
  std::vector<Remark> evidence;      ///< each kind of readings with its ratio
  double before = 0.0, after = 0.0;  ///< ratio of the readings over the day, with the figures as declared and as found
};

/// The tracker, then the load cell, by readings that agree on it.
///
/// At once: repeats of one state, along and across the beam; the load cell's unloaded readings about their mean, and
/// about a drift of its zero or a weight that was not tared where they follow one (core/mistakes/cell_zero.h). They
/// give the size. Over the day: what rounds of floor nests, circles of each swept axis and returns to zero leave; the
/// load cell's moments against one lever. Whatever else is wrong adds to these, so the smallest of them is taken, and
/// it has to be beyond chance on the same side. Repeats within seconds that are quiet while the day is as noisy as
/// declared are no wrong declaration, nor is one kind of readings that scatters where another does not.
///
/// A ratio of two, as between standard deviation and the stated interval of most data sheets. A kind has a say from
/// thirty degrees of freedom on: chance makes two of one in less than one day in 50 000.
std::vector<DeclaredNoise> judgeDeclaredNoise(const AuditInput& input);

/// Those of the instruments whose figures are wrong, with the figures that the readings show. None of one whose
/// readings are explained by a mistake that is suspected.
std::vector<mistakes::Suspected> suspectedNoise(const AuditInput& input);

/// A zero of the load cell that drifts over the day, and a weight that was not tared where the loads do not name it.
std::vector<mistakes::Suspected> suspectedZero(const AuditInput& input);

/// How far reflectors of postures unloaded again stand from step 0, of all postures together; core/audit/checks.h:
/// return_to_zero. None where nothing was unloaded again.
NoiseSum scatterOfReturns(const AuditInput& input);

/// A load that hangs or pulls at one point of the tool: M = lever x F with one lever, in the load cell's
/// axes.
struct LoadPointFit {
  bool done = false;
  Remark reason;                                    ///< why not
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< from the cell's point to the load's, in the tool, m
  double chi2 = 0.0;
  int dof = 0;
  double rms = 0.0;         ///< of the moments' residuals, per component, Nm
  double worst_chi2 = 0.0;  ///< of one state, three components
  double worst_limit = 0.0;
  std::size_t worst_line = 0;  ///< in the states' file
  int worst_pose = 0;
  int worst_step = 0;
  /// Components of the moment whose turned sign mends the fit; empty: none does.
  std::vector<std::string> mending_signs;
  bool mends_all_states = false;  ///< turned in all states, not in the worst alone
};

/// Weighted least squares over all states with a force; the moment's variance is that of the moment and of
/// the lever times the force's. Axes that do not turn with the flange are turned into it by forward
/// kinematics of the URDF. Not done, with the reason: moments that were not measured, or forces along one
/// line in the tool, which leave the lever open.
LoadPointFit fitLoadPoint(const campaign::Campaign& campaign);

/// One distance between two reflectors in one state, against its reference.
struct ToolDistance {
  std::size_t state = 0;  ///< index into the states
  int first = 0, second = 0;
  double change = 0.0;  ///< against the reference, m
  double sd = 0.0;      ///< of the change, m
};

/// Distances between reflectors over all states, and their references: the tool is rigid.
struct ToolDistances {
  struct Pair {
    int first = 0, second = 0;
    double reference = 0.0;  ///< weighted mean over unloaded states, those far off the median left out, m
    double reference_sd = 0.0;
    int states = 0;
  };
  std::vector<Pair> pairs;
  std::vector<ToolDistance> distances;
  double limit = 0.0;  ///< of |change| / sd, over all distances

  const Pair* pair(int first, int second) const;
};

/// Whether time_order finds the rows of states in postures that were not read at their times.
bool statesOfOtherPostures(const AuditInput& input);

/// Whether rigid_tool finds reflectors that carry each other's names.
bool reflectorsExchanged(const AuditInput& input);

/// A pair that fewer than three states show is left out.
ToolDistances toolDistances(const std::vector<campaign::StatePoints>& states, int targets,
                            const metrology::TrackerNoise& noise);

/// What the wrist sweep leaves of P_wrist's spheres once the swept axes of the wrist (4-6 of six), which do not quite
/// meet, have their share.
struct WristResiduals {
  double chi2 = 0.0;      ///< by the tracker's noise along each radius; beyond it less what the sag's doubt explains
  int dof = 0;            ///< readings less centre and radii
  double rms = 0.0;       ///< m, over `dof`
  std::size_t worst = 0;  ///< line of the reading that is farthest off, in parts of its noise
};

/// Radial distances of the readings less those that forward kinematics in the swept geometry gives, by one
/// weighted linear least squares in the centre (free), a radius per reflector (free) and the parameters of
/// the wrist's axes, four each, held by the covariance of their own sweeps. That prior makes the sum of squares
/// chi-square with `dof` degrees of freedom: an axis's error is one number for the whole sweep, and added to
/// each reading's variance instead it would be averaged away over a thousand readings that share it. The
/// wrist is measured, its axes are, and the noise is declared.
WristResiduals wristResiduals(const AuditInput& input);

}  // namespace stiffscope::audit
