#pragma once

#include "core/extended_model/hidden_effects.h"
#include "core/identification/identification.h"

namespace stiffscope::extended_model {

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

}  // namespace stiffscope::extended_model
