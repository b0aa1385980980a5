#include <gtest/gtest.h>

#include <stdexcept>

#include "core/comparison/remarks.h"
#include "core/compensation/remarks.h"
#include "core/diagnosis/remarks.h"
#include "core/extended_model/remarks.h"
#include "core/identification/remarks.h"
#include "core/io/units.h"
#include "core/planning/remarks.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

// Remarks in SI units come out as sentences in mm, um and degrees.

namespace stiffscope {
namespace result_remarks_test {

TEST(ResultRemarks, OfADiagnosis) {
  using enum diagnosis::RemarkId;
  const Remark backlash(fitted_part, std::string("joint 3"), std::string("rad"), std::vector<double>{2e-5, 0.1234567});
  const Remark point(fitted_part, std::string(), std::string("m"), std::vector<double>{0.05, -0.001});
  const Remark both(fitted_parts, std::vector<Remark>{backlash, point});
  EXPECT_EQ(reports::words(both), "joint 3: 2e-05, 0.1235 rad; 50, -1 mm");
  EXPECT_EQ(
      reports::words(Remark(follows_from_geometry, std::string("load_point_error"), both)),
      "Besides, what looks like load point error (joint 3: 2e-05, 0.1235 rad; 50, -1 mm) is no more than the wrong "
      "geometry puts there.");
  EXPECT_EQ(reports::words(Remark(axes_off_nominal, 0.0012345, 0.002)),
            "axes up to 1.234 mm and 2.000 mrad from the nominal ones");
  EXPECT_EQ(
      reports::words(Remark(left_by_stiffnesses, 30.04e-6, 5e-6, 36.0, false, false)),
      "Stiffnesses alone leave 30.0 um rms per coordinate of the deflection, noise alone 5.0 um (chi2 per equation "
      "36.00).");
  EXPECT_EQ(reports::words(Remark(left_by_stiffnesses, 30e-6, 5e-6, 360.0, true, true)).substr(82),
            "5.0 um (chi2 per equation of deflections and positions with the station's motion taken off 360).");
  EXPECT_EQ(
      reports::words(Remark(
          posture_that_separates,
          std::vector<double>{0.0, 10 * io::kDegree, -90 * io::kDegree, 0.0, 45 * io::kDegree, 180 * io::kDegree},
          2000.0, 1, 9.0, 4.0, 8.25)),
      "a posture at (0, 10, -90, 0, 45, 180) deg, pulled by 2000 N along y0: it raises the least separation (chi2, "
      "9 tells apart) from 4.0 to 8.2");
}

TEST(ResultRemarks, OfAModelAndItsUse) {
  EXPECT_EQ(reports::words(
                Remark(extended_model::RemarkId::diagnosis_has_no_gap, Remark(diagnosis::RemarkId::no_usable_posture))),
            "the diagnosis has no gap to look at, so nothing is added: no posture has readings unloaded and under load "
            "that can be brought into the robot's frame");
  EXPECT_EQ(reports::words(Remark(extended_model::RemarkId::taken_of_a_class, std::string("hysteresis"),
                                  std::vector<std::string>{"backlash", "load_cell_bias"})),
            "hysteresis is added because it fits best; this data cannot tell it from backlash or load cell bias");
  EXPECT_EQ(
      reports::words(Remark(extended_model::RemarkId::residual_beyond_noise, 4.104, 6.9, true, 0.0)),
      "more than noise is left in the readings: 4.1 times its chi-square, 6.9 by springs alone; no effect that is "
      "known here explains it, and the stiffnesses are apparent ones");
  // A chi-square in whose noise that is would say that nothing is left.
  EXPECT_EQ(
      reports::words(Remark(extended_model::RemarkId::residual_beyond_noise, 0.945, 0.945, true, 54.3e-6)),
      "more than the tracker's noise is left in the readings: once a posture 54.3 µm at the largest load; no effect "
      "that is known here explains it, and the stiffnesses are apparent ones");
  EXPECT_EQ(reports::words(Remark(extended_model::RemarkId::changes_over_the_day, -0.042, -7.31)),
            "all joints give 4.2 % less at the end of the day than at its beginning (7.3 standard uncertainties): "
            "stiffness here is the day's mean, and its change is in the uncertainty");
  EXPECT_EQ(reports::words(Remark(extended_model::RemarkId::moves_while_load_stands, 0.0123)),
            "readings under a standing load move on by 1.2 % of the displacement from the first repeat to the last: "
            "stiffness here is that of loads that stand as long, and what came before is in its uncertainty");
  EXPECT_EQ(reports::words(Remark(compensation::RemarkId::command_outside_limits, 2, 190.25 * io::kDegree, -io::kDegree,
                                  180 * io::kDegree)),
            "joint 2 would have to go to 190.250 deg, outside its limits -1.0 to 180.0 deg");
  EXPECT_EQ(reports::words(Remark(compensation::RemarkId::turns_joint_of_unknown_k, 4, 123.4)),
            "the load turns axis 4 by 123 Nm and k4 is not known: the deflection shown lacks its part");
  EXPECT_EQ(reports::words(Remark(planning::RemarkId::reflectors_on_ring, 0.25, 0.05)).substr(0, 80),
            "three reflectors on a ring of 250 mm radius, 50 mm ahead of the flange: the camp");
  EXPECT_EQ(reports::words(Remark(planning::RemarkId::load_where_measured, std::vector<double>{0.1, -0.02, 0.3})),
            "the load acts at 100 -20 300 mm on the flange, where the measured wrenches have it");
}

TEST(ResultRemarks, OfAComparison) {
  using enum comparison::RemarkId;
  EXPECT_EQ(reports::words(Remark(axis_turned, 3, 0.5 * io::kDegree)),
            "the URDFs describe different machines: axis 3 is turned by 0.50 deg");
  EXPECT_EQ(
      reports::words(Remark(nothing_comparable, Remark(no_posture_in_both), Remark(no_joint_in_both))),
      "no posture was measured in both campaigns with the same joint angles and load; no joint is identifiable in "
      "both campaigns");
  EXPECT_EQ(reports::words(Remark(wrist_not_measured, comparison::When::after)), "P_wrist is not measured after");
  EXPECT_EQ(reports::words(Remark(other_postures, 3)).rfind("only 3 postures correspond", 0), 0u);
  EXPECT_EQ(reports::words(Remark(difference_above_noise, 80e-6, 10e-6))
                .rfind("changes of joint compliances leave 80 \u00b5m per coordinate of the difference between the "
                       "states, 8 times",
                       0),
            0u)
      << reports::words(Remark(difference_above_noise, 80e-6, 10e-6));
  EXPECT_EQ(reports::words(Remark(other_load, 100.0, 1000.0, 1100.0, 0.02)),
            "the loads differ by 9.1 % (1000 N before, 1100 N after), at most 2 % is the same load");
}

TEST(ResultRemarks, WhyAJointIsNotSeenFitsACell) {
  using enum identification::RemarkId;
  const auto cell = [](const Remark& reason) { return reports::unseenWords({.reason = reason}); };
  EXPECT_EQ(cell(Remark(load_hangs, 1, 4.7, 0.0)), "not seen: the load only hangs");
  EXPECT_EQ(cell(Remark(load_turns_too_little, 6, 1.0, 3.0, 0.8)), "not seen: hardly loaded");
  EXPECT_EQ(cell(Remark(points_on_axis, 6, 1e-4)), "not seen: points stand on its axis");
  EXPECT_EQ(cell(Remark(two_joints_combined)), "not seen apart from others");
  EXPECT_EQ(cell(Remark()), "not seen");
}

TEST(ResultRemarks, NothingToSayHasNoWordsAndAMissingValueIsAnError) {
  EXPECT_EQ(reports::words(Remark()), "");
  EXPECT_THROW(reports::words(Remark(comparison::RemarkId::axis_turned)), std::logic_error);
}

}  // namespace result_remarks_test
}  // namespace stiffscope
