#include "reports/words/interchange_words.h"

namespace stiffscope::reports {

std::string skipWords(interchange::Skip reason) {
  using interchange::Skip;
  switch (reason) {
    case Skip::lost_beam:
      return "0 0 0: the beam was lost";
    case Skip::marked_invalid:
      return "marked as invalid by the program that wrote it";
    case Skip::no_point:
      return "a reading of something else than a point";
    case Skip::another_point:
      return "its name is none of the day's";
    case Skip::in_motion:
      return "the joints moved";
    case Skip::outside_log:
      return "outside the time of the joints' log";
    case Skip::no_readings:
      return "nothing was read there";
    case Skip::joints_not_given:
      return "a target in space, without joint angles";
    case Skip::repeated_row:
      return "says the same as an earlier row of its pose and step";
    case Skip::in_instruction:
      return "a joint target in an instruction, which has no name";
    case Skip::joints_computed:
      return "a joint target that is computed, given in part or handed on";
  }
  return {};
}

}  // namespace stiffscope::reports
