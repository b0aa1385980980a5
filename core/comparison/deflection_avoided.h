#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/comparison/matched_postures.h"
#include "metrology/remark.h"

namespace stiffscope::comparison {

/// One posture's |displacement| in both campaigns, m.
struct PostureDeflection {
  std::string pose;
  double before = 0.0, after = 0.0;
  double share() const { return 1.0 - after / before; }
};

/// The share of the deflection that the second campaign no longer has (paper, IV.E): 1 - sum |after| / sum
/// |before| over matched postures. Negative where it has more.
struct DeflectionAvoided {
  bool available = false;
  Remark reason;
  double share = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval; not a number with fewer than five postures
  std::vector<PostureDeflection> postures;
};

struct BootstrapOptions {
  int samples = 4000;  ///< 2.5 % of them are 100: the ends of the interval settle to a twentieth of its width
  std::uint64_t seed = 1;
};

/// At P_wrist; unavailable, with the reason, where it is not measured in both campaigns.
DeflectionAvoided deflectionAvoidedAtWrist(const identification::Identification& before,
                                           const identification::Identification& after, const MatchedPostures& matched,
                                           const BootstrapOptions& options = {});

/// At the reflectors, the mean over those of a posture.
DeflectionAvoided deflectionAvoidedAtTargets(const identification::Identification& before,
                                             const identification::Identification& after,
                                             const MatchedPostures& matched, const BootstrapOptions& options = {});

/// How much of the deflection at the reflectors a stiffer joint avoids: the share avoided by a unit of
/// c_before
/// - c_after, 1/(rad/Nm), joint by joint. With d the displacements of a reflector and e = (d_b + d_a) / (|d_b| +
/// |d_a|),
///   |d_b| - |d_a| = e . (d_b - d_a), exactly, and d_b - d_a = sum_j A_j (c_b,j - c_a,j) + rest,
/// A the mean of the method's equations of both states, so that with u_j = sum e . A_j / sum |d_b| over postures (and
/// the mean over reflectors) sum_j u_j (c_b,j - c_a,j) and a rest make up the share avoided. The rest is noise, what
/// loads and postures differ in, and what is no joint spring. Zero where no posture corresponds, or the method's
/// equations are not of all load cases. The method must be available.
JointVector avoidedByUnit(const campaign::Campaign& before_campaign, const identification::Identification& before,
                          const campaign::Campaign& after_campaign, const identification::Identification& after,
                          identification::Method method, const MatchedPostures& matched);

/// The share of sums and its bootstrap over postures (seeded), what other postures would have given: quantiles about
/// the median, as far as few postures ask for (numerics::spreadOfFew), put on the share.
DeflectionAvoided shareAvoided(std::vector<PostureDeflection> postures, const BootstrapOptions& options = {});

}  // namespace stiffscope::comparison
