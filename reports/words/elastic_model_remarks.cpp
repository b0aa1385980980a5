#include "core/elastic_model/remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/elastic_model/elastic_chain.h"
#include "reports/words/effect_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string elasticModelWords(elastic_model::RemarkId id, const RemarkValues& values) {
  using enum elastic_model::RemarkId;
  const auto effect = [&] {
    const auto known = effects::effectOf(values.name(0));
    return known ? effectName(*known) : values.name(0);
  };
  switch (id) {
    case rigid_not_identifiable:
      return fmt::format("joint {} has no spring: the day does not tell k{}", values.count(0), values.count(0));
    case rigid_negative:
      return fmt::format("joint {} has no spring: k{} came out as {:.3g} Nm/rad, and no spring is negative",
                         values.count(0), values.count(0), values.number(1));
    case effect_of_no_spring:
      return effect() + " is not in the file: no linear springs in series do that";
    case effect_of_measurement:
      return effect() + " is not in the file: a fault of the measurement, the machine does not do it";
    case effect_in_load_point:
      return effect() + ": load_point stands where the load acts as corrected";
    case no_masses:
      return "arm and tool have no weight: the URDF states no masses of the links";
    case no_balancers:
      return fmt::format("no balancer is in the file ({} stated): the arm in it sags as it would without",
                         values.count(0));
    case no_inertia:
      return fmt::format(
          "the URDF states no inertia that a rigid body has for {}: {:g} kg m^2 about every axis stand in, without "
          "effect at rest",
          fmt::join(values.names(0), ", "), elastic_model::kStandInInertia);
    case load_axes_turn_with_link:
      return fmt::format("load_point has the axes of its own link: the load cell's are those of {}, which turns apart",
                         values.name(0));
  }
  return {};
}

}  // namespace stiffscope::reports
