#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/mistakes/arm_cure.h"
#include "core/mistakes/arm_mistakes.h"
#include "core/mistakes/remarks.h"

namespace stiffscope::mistakes {

/// Cures whose misfits differ by less mend equally well: masses and geometry errors move them by as much.
inline constexpr double kArmAsWell = 1.3;
/// A cure leaves at most this share of what the readings missed the arm by.
inline constexpr double kMends = 0.25;

using Tables = std::vector<SourceTable>;

/// What all searches of searchArm share: the day, its tables, the mistakes that are tried, what was found. The campaign
/// and the day outlive it.
struct SearchedArm {
  /// `found.fit` is that of the day as read; the mistakes are listed where they are searched.
  SearchedArm(const campaign::Campaign& campaign, const ReadingsOfDay& day, const SearchLimits& limits);

  const campaign::Campaign& campaign;
  const ReadingsOfDay& day;
  SearchLimits limits;
  Tables tables;             ///< that have readings
  std::vector<Tables> sets;  ///< all sets of them, the whole first
  std::vector<ArmMistake> mistakes;
  ArmSearch found;

  /// Whether a misfit of all readings, m, is so small that what left it is a cure.
  bool mends(double rms) const;

  /// The day with a mistake taken back in some tables.
  ReadingsOfDay with(const ArmMistake& mistake, const Tables& in) const { return with(day, mistake, in); }
  static ReadingsOfDay with(const ReadingsOfDay& day, const ArmMistake& mistake, const Tables& in);

  Remark whereOf(const ArmMistake& mistake, const Tables& in) const;
  std::vector<std::string> filesOf(const Tables& in, bool of_angles) const;

  /// Takes a cure up, with the figure by which it shows: `before` as read, the misfit of all readings where it is
  /// absent.
  void add(ArmCure cure, RemarkId shows = RemarkId::misses_arm, std::optional<double> before = {});
};

// One group of readings: a posture, the sweep of an axis, a part of the wrist sweep.
const UnloadedReading& firstOf(const ReadingsOfDay& day, int group);
/// How far its readings are from the model, root mean square, m.
double missOfGroup(const NominalFit& fit, const ReadingsOfDay& day, int group);
/// Whether what is left of a group's `before` is so small that what left it is a cure.
bool mendsGroup(const SearchedArm& arm, double after, double before);
Remark whereOfGroup(const campaign::Campaign& campaign, const UnloadedReading& first, const std::string& columns,
                    bool of_angles);

/// Whether it is written in the columns of joint angles, not in those of points or names.
bool isOfAngles(const ArmMistake& mistake);
std::string columnsOf(const ArmMistake& mistake, int joints);
/// "q1_deg to q6_deg" of six joints.
std::string columnsOfAngles(int joints);

// The searches: each adds to `arm.found.cures` what mends.

/// One mistake of the table, in all tables of readings or in some.
void searchTables(SearchedArm& arm);
/// Two of them at once.
void searchPairs(SearchedArm& arm);

/// Two names for one reflector, in a table or at a posture. Returns whether there are.
bool searchReadTwice(SearchedArm& arm);
/// Postures or sweeps that stand apart from the others, which the fit then stands on: one by one, or alike.
void searchGroups(SearchedArm& arm);
/// Rows of joint angles at the wrong postures: two exchanged, one repeated, all from some posture on. `apart`: groups
/// that stand apart. Each returns whether it found some.
bool searchExchangedAngles(SearchedArm& arm, const std::vector<int>& apart);
bool searchRepeatedAngles(SearchedArm& arm, int group);
bool searchLostRow(SearchedArm& arm);
/// Three postures or more whose angles stand in each other's rows: numbered anew, in whatever order. Returns whether it
/// found some.
bool searchRenumbered(SearchedArm& arm);

/// Readings of the sweeps of two axes exchanged, each under the other's angles.
void searchExchangedSweeps(SearchedArm& arm);
/// Sweeps whose label names another axis than the one that turns. Returns whether each is under the axis that does.
bool searchLabels(SearchedArm& arm);

/// A joint's zero, in all tables or in one.
void searchZeros(SearchedArm& arm);
/// The origin of one joint in the URDF: turned by right angles, or shifted.
void searchOrigins(SearchedArm& arm);
/// One table of another scale than the others.
void searchTableScales(SearchedArm& arm);
/// One table read from another station, or from another base: a rigid motion brings it to the others.
void searchStations(SearchedArm& arm);
/// Points and URDF of one shape and another size.
void searchScale(SearchedArm& arm);
/// Masses of the URDF in grams: an arm heavier than any.
void searchMasses(SearchedArm& arm);
/// Points that are declared to be in base_link and are elsewhere.
void searchBase(SearchedArm& arm);

}  // namespace stiffscope::mistakes
