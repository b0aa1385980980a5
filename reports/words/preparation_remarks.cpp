#include <fmt/format.h>

#include "core/preparation/remarks.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string preparationWords(preparation::RemarkId id, const RemarkValues& values) {
  switch (id) {
    case preparation::RemarkId::at_name:
      return values.name(0);
    case preparation::RemarkId::by_chance:
      return words(values.remark(0)) + kChanceIsShared;
    case preparation::RemarkId::no_point_readings:
      return "no readings of points: measure `circle_sweeps`, `wrist_sweep` or `loading`";
    case preparation::RemarkId::no_loading:
      return "no absolute readings under load: measure `loading`";
    case preparation::RemarkId::no_repeats:
      return "no state was read more than once: measure each at least twice";
    case preparation::RemarkId::tracker_noise_not_declared:
      return "the tracker's noise is not declared: state `tracker` in campaign.xml";
    case preparation::RemarkId::no_floor_nests:
      return "no floor nests: measure three or more before, during and after the day (`nests`)";
    case preparation::RemarkId::too_few_nests:
      return "three nests that do not stand in one line, in two rounds or more, are needed";
    case preparation::RemarkId::too_few_rounds_to_tell:
      return "three rounds of three nests or more are needed to tell a wrong reading from a nest that moved";
    case preparation::RemarkId::beam_lost:
      return "lost beam: the point is (0, 0, 0)";
    case preparation::RemarkId::same_as_line:
      return fmt::format("the same point to the last digit as line {}", values.count(0));
    case preparation::RemarkId::stands_from_state:
      return fmt::format("stands {:.3f} mm from the mean of its state's other repeats", 1e3 * values.number(0));
    case preparation::RemarkId::one_of_round_wrong:
      return "contradicts other nests of its round, and which of them is wrong cannot be told";
    case preparation::RemarkId::stands_from_nest:
      return fmt::format("stands {:.3f} mm from nest {} by what the other nests say of the station",
                         1e3 * values.number(0), values.name(1));
    case preparation::RemarkId::no_such_readings:
      return "none";
    case preparation::RemarkId::readings_at_zero:
      return fmt::format("{} readings at (0, 0, 0): the beam was lost", values.count(0));
    case preparation::RemarkId::readings_repeated:
      return fmt::format(
          "{} readings repeat another's coordinates to the last digit: copied, or the beam still on another reflector",
          values.count(0));
    case preparation::RemarkId::repeats_stand_apart:
      return fmt::format("{} repeats stand apart from the others of their state", values.count(0));
    case preparation::RemarkId::nests_stand_apart:
      return fmt::format("{} readings of nests stand apart from what the nests' other readings say of them",
                         values.count(0));
    case preparation::RemarkId::rounds_of_few_nests:
      return fmt::format(
          "{} of {} rounds have three nests or fewer: of three a reading that is off across their plane cannot be "
          "told, of two none can; measure four, better five",
          values.count(0), values.count(1));
    case preparation::RemarkId::nothing_inside_station:
      return "no reflector stands inside the station";
    case preparation::RemarkId::no_chance_of_same_digits:
      return "no more readings agree to the last digit than chance makes agree";
    case preparation::RemarkId::chi_square_of_repeat:
      return "chi-square of a reading against its state's others, three coordinates";
    case preparation::RemarkId::chi_square_of_nest_reading:
      return "chi-square of a nest's reading against all others, three coordinates";
    case preparation::RemarkId::station_stood_still:
      return fmt::format("{} rounds, the tracker stood still", values.count(0));
    case preparation::RemarkId::nests_deform:
      return "the nests themselves moved against each other, more than one of them: they are no reference";
    case preparation::RemarkId::stations_disagree:
      return "nests moved between the stations: they are no reference";
    case preparation::RemarkId::station_jumped:
      return fmt::format("the tracker moved once, by {:.3f} mm where the arm was read", 1e3 * values.number(0));
    case preparation::RemarkId::station_wandered:
      return fmt::format("the tracker wandered, by {:.3f} mm where the arm was read", 1e3 * values.number(0));
    case preparation::RemarkId::no_motion_beyond_noise:
      return "the nests show no motion of the station beyond their noise";
    case preparation::RemarkId::as_measured_asked_for:
      return "readings as they were measured were asked for";
    case preparation::RemarkId::raw_asked_for:
      return "raw readings were asked for";
    case preparation::RemarkId::noise_not_declared:
      return "the tracker's noise is not declared";
    case preparation::RemarkId::noise_as_declared:
      return "the tracker's declared noise";
    case preparation::RemarkId::noise_as_declared_few_repeats:
      return "the tracker's declared noise, because there are too few repeats to check it";
    case preparation::RemarkId::noise_by_distances:
      if (values.count(2) != 0) {
        return fmt::format(
            "the tracker's declared noise; there are too few repeats to check it, and distances between "
            "reflectors agree with it ({:.2f} of it, {} degrees of freedom)",
            values.number(1), values.count(0));
      }
      return fmt::format(
          "distances between reflectors ({} degrees of freedom), since there are too few repeats: {:.2f} "
          "of the declared noise",
          values.count(0), values.number(1));
    case preparation::RemarkId::noise_by_repeats:
      return fmt::format("repeats ({} degrees of freedom), {:.2f} of the declared noise along the beam, {:.2f} across",
                         values.count(0), values.number(1), values.number(2));
  }
  return {};
}

}  // namespace stiffscope::reports
