#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "metrology/remark.h"

namespace stiffscope::mistakes {

/// All mistakes that are known by name, in the order of docs/results.md, which says what each is.
inline constexpr std::array<std::string_view, 25> kMistakeIds{"joint_sign",
                                                              "joint_order",
                                                              "joint_zero",
                                                              "joint_coupling",
                                                              "angle_unit",
                                                              "point_unit",
                                                              "point_axes",
                                                              "scale",
                                                              "frame_declared",
                                                              "other_station",
                                                              "reflectors_exchanged",
                                                              "reflectors_on_line",
                                                              "sweeps_exchanged",
                                                              "row_order",
                                                              "robot_unit",
                                                              "robot_origin",
                                                              "wrench_sign",
                                                              "wrench_order",
                                                              "wrench_unit",
                                                              "step_scale",
                                                              "cell_axes",
                                                              "cell_point",
                                                              "not_tared",
                                                              "gravity_sign",
                                                              "noise_declared"};

/// One of them; another does not compile.
class MistakeId {
 public:
  constexpr MistakeId() = default;  ///< of none
  consteval MistakeId(const char* id) : name_(id) {
    if (std::find(kMistakeIds.begin(), kMistakeIds.end(), name_) == kMistakeIds.end())
      throw std::invalid_argument("no id of kMistakeIds");
  }

  constexpr std::string_view name() const { return name_; }

  friend constexpr bool operator==(const MistakeId& id, std::string_view name) { return id.name_ == name; }

 private:
  std::string_view name_;
};

/// A mistake that would explain what the readings show.
struct Suspected {
  MistakeId mistake;
  Remark where;                      ///< instrument, file and columns, or element of campaign.xml
  Remark remedy;                     ///< the change that would mend it
  Remark shown;                      ///< the figure by which it shows, as read and with the remedy
  double before = 0.0, after = 0.0;  ///< that figure
};

}  // namespace stiffscope::mistakes
