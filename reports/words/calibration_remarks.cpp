#include <fmt/format.h>
#include <array>

#include "core/calibration/remarks.h"
#include "core/io/units.h"
#include "reports/words/entry_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

namespace {

std::string axisParameter(const RemarkValues& values) {
  static constexpr std::array<const char*, 4> kNames{"place (u)", "place (v)", "direction (u)", "direction (v)"};
  return fmt::format("axis {} {}", values.count(0), kNames.at(static_cast<std::size_t>(values.count(1))));
}

}  // namespace

std::string calibrationWords(calibration::RemarkId id, const RemarkValues& values) {
  using calibration::RemarkId;
  switch (id) {
    case RemarkId::no_unloaded_readings:
      return "there are no unloaded postures to calibrate on: measure `loading` with step 0, and `states` with the "
             "joint angles of each posture";
    case RemarkId::too_few_readings:
      return fmt::format("{} readings do not determine {} parameters: measure more postures", values.count(0),
                         values.count(1));
    case RemarkId::not_placed:
      return "the readings do not show where the base stands: they lie on one line, or are fewer than four";
    case RemarkId::not_settling:
      return "the fit did not settle";
    case RemarkId::off_the_model:
      return fmt::format("{:.2f} mm from where the fullest model has it", values.number(0) / io::kMillimetre);
    case RemarkId::choice_of_frame:
      return axisParameter(values) + ": a choice of frame, which the base takes";
    case RemarkId::not_seen:
      return axisParameter(values) + ": these postures and reflectors do not see it; kept as the URDF has it";
    case RemarkId::hardly_seen:
      return values.count(1) < 2 ? fmt::format("{}: known to {:.1f} mm only by these postures", axisParameter(values),
                                               values.number(2) / io::kMillimetre)
                                 : fmt::format("{}: known to {:.2f} deg only by these postures", axisParameter(values),
                                               values.number(2) / io::kDegree);
    case RemarkId::no_masses:
      return "the URDF states no link masses: of the own weight only products of a joint's compliance with a moment "
             "are "
             "seen, and no stiffness can be given";
    case RemarkId::negative_compliance:
      return fmt::format("{} of {} would be negative, which no spring is: left at zero", nameOfId(values.name(0)),
                         values.name(1));
    case RemarkId::too_few_for_effects:
      return fmt::format("no effect was asked for: {} postures, which takes {}", values.count(0), values.count(1));
    case RemarkId::no_effect_predicts:
      return "no effect predicts postures that were held out better than geometry alone";
  }
  return {};
}

}  // namespace stiffscope::reports
