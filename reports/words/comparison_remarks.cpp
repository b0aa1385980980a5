#include "core/comparison/remarks.h"

#include <fmt/format.h>
#include <algorithm>

#include "core/io/units.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string comparisonWords(comparison::RemarkId id, const RemarkValues& values) {
  using enum comparison::RemarkId;
  const auto degrees = [&](std::size_t place) { return values.number(place) / io::kDegree; };
  const auto millimetres = [&](std::size_t place) { return values.number(place) / io::kMillimetre; };
  const auto when = [&](std::size_t place) -> const char* {
    switch (static_cast<comparison::When>(values.count(place))) {
      case comparison::When::before:
        return "before";
      case comparison::When::after:
        return "after";
      case comparison::When::both:
        break;
    }
    return "in either campaign";
  };
  switch (id) {
    case other_joint_count:
      return fmt::format("the URDFs describe different machines: {} joints and {}", values.count(0), values.count(1));
    case axis_turned:
      return fmt::format("the URDFs describe different machines: axis {} is turned by {:.2f} deg", values.count(0),
                         degrees(1));
    case axis_elsewhere:
      return fmt::format("the URDFs describe different machines: axis {} stands {:.1f} mm elsewhere", values.count(0),
                         millimetres(1));
    case other_name:
      return fmt::format("the URDFs name different machines: {} and {}", values.name(0), values.name(1));
    case flange_elsewhere:
      return fmt::format("the URDFs place the flange {:.1f} mm and {:.2f} deg apart", millimetres(0), degrees(1));
    case other_masses:
      return fmt::format("the URDFs' links have different masses, {:.0f} kg and {:.0f} kg in all", values.number(0),
                         values.number(1));
    case other_balancers:
      return fmt::format(
          "the campaigns state different balancers, {} and {} of them: what these change is taken for a change of the "
          "machine where only one statement is right",
          values.count(0), values.count(1));
    case same_encoders:
      return fmt::format("both campaigns were measured with double encoders {}",
                         values.count(0) != 0 ? "active" : "inactive");
    case encoders_swapped:
      return "the first campaign has the double encoders active and the second inactive: the other way round, "
             "`avoided` is what the encoders avoid";
    case few_correspond:
      return fmt::format("only {} of {} postures correspond", values.count(0), values.count(1));
    case other_postures:
      return fmt::format(
          "only {} postures correspond, too few to solve both states from: the differences are of all postures of "
          "each, and what the model misses does not cancel in them but as far as the postures are the same; the "
          "uncertainties hold it as far as it scatters between postures",
          values.count(0));
    case difference_above_noise:
      return fmt::format(
          "changes of joint compliances leave {} per coordinate of the difference between the states, {:.0f} times the "
          "tracker's noise: something else changed too, and does not cancel",
          withMicro(lengthWords(values.number(0), 0)), values.number(0) / values.number(1));
    case geometry_of_other_postures:
      return fmt::format(
          "{} postures correspond, too few to compare on these alone: what the model misses does not cancel, and "
          "counts as scatter between postures in the uncertainties",
          values.count(0));
    case effects_changed:
      return fmt::format(
          "the effects beside the geometry (gears, own weight) are not the same in both days (p {:.4f} of unchanged "
          "ones): each day is fitted with its own, and what looks like a joint's zero may be one of them",
          values.number(0));
    case no_common_reflector:
      return "no reflector has the same id in both campaigns: whether reflectors moved is not asked";
    case zero_1_with_base:
      return "joint 1's zero is not compared: a base that turned about axis 1 looks the same";
    case zero_of_last_with_reflectors:
      return fmt::format("joint {}'s zero is not compared: reflectors that all turned about axis {} look the same",
                         values.count(0), values.count(1));
    case nothing_comparable:
      return fmt::format("{}; {}", words(values.remark(0)), words(values.remark(1)));
    case of_one_campaign:
      return fmt::format("{}: {}", when(0), words(values.remark(1)));
    case not_identifiable:
      return fmt::format("not identifiable {}: {}", when(0), words(values.remark(1)));
    case no_joint_in_both:
      return "no joint is identifiable in both campaigns";
    case no_posture_in_both:
      return "no posture was measured in both campaigns with the same joint angles and load";
    case nothing_moved_before:
      return "nothing moved before: there is no deflection to avoid";
    case wrist_not_measured:
      return fmt::format("P_wrist is not measured {}", when(0));
    case left_out:
      return fmt::format("left out {}: {}", when(0), words(values.remark(1)));
    case not_measured:
      return fmt::format("not measured {}", when(0));
    case no_load_state:
      return fmt::format("no usable load state {} in load step {}", when(0), values.count(1));
    case other_angles:
      return fmt::format("joint {} stands {:.3f} deg apart, at most {:.3f} is the same posture", values.count(0),
                         degrees(1), degrees(2));
    case other_load:
      return fmt::format(
          "the loads differ by {:.1f} % ({:.0f} N before, {:.0f} N after), at most {:.0f} % is the same load",
          100.0 * values.number(0) / std::max(values.number(1), values.number(2)), values.number(1), values.number(2),
          100.0 * values.number(3));
  }
  return {};
}

}  // namespace stiffscope::reports
