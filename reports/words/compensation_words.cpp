#include "reports/words/compensation_words.h"

#include <fmt/format.h>
#include <typeindex>

#include "core/compensation/remarks.h"
#include "core/toolpath/remarks.h"

namespace stiffscope::reports {

namespace {

const char* refusalWords(compensation::RemarkId reason) {
  using enum compensation::RemarkId;
  switch (reason) {
    case unloaded_arm_does_not_rest:
    case loaded_arm_does_not_rest:
      return "the arm does not come to rest";
    case posture_outside_limits:
      return "a joint stands outside its limits";
    case command_outside_limits:
      return "a command would be outside a joint's limits";
    case follower_outside_limits:
      return "an axis that follows others would be outside its limits";
    case balancer_outside_stroke:
      return "a balancer would be outside its stroke";
    case near_singularity:
      return "the posture is too near a singularity";
    case turns_joint_of_negative_k:
      return "the load turns a joint whose stiffness came out negative";
    case turns_joint_of_unknown_k:
      return "the load turns a joint whose stiffness is not known";
    case steps_do_not_converge:
      return "the steps towards the wanted pose do not converge";
    case load_far_beyond:
      return "the load is far beyond those that the stiffnesses come from";
    case posture_far_beyond:
      return "the posture is far from those that the stiffnesses come from";
    case uncertainty_unknown:
      return "the postures are too few for an uncertainty of the deflection";
    case uncertain_as_itself:
      return "the deflection is as uncertain as it is large";
    case load_beyond:
    case torque_beyond:
    case posture_beyond:
    case uncertain:
    case turn_left:
    case position_first:
    case least_turns:
    case implausible_command:
      break;  // no reasons to refuse
  }
  return "";
}

const char* refusalWords(toolpath::RemarkId reason) {
  using enum toolpath::RemarkId;
  switch (reason) {
    case not_reached:
      return "no joint angles hold the tool there";
    case leaves_branch:
      return "the path leads through a singularity";
    case no_feed_direction:
      return "the process load has no direction of feed";
    case arm_does_not_rest:
      return "the arm does not come to rest";
    case fewer_than_six_joints:
      return "the machine has fewer than six joints";
  }
  return "";
}

}  // namespace

std::string refusalWords(const Remark& reason) {
  return reason.family == std::type_index(typeid(toolpath::RemarkId))
             ? refusalWords(static_cast<toolpath::RemarkId>(reason.id))
             : refusalWords(static_cast<compensation::RemarkId>(reason.id));
}

std::string summaryWords(const compensation::CompensationSummary& summary) {
  std::string text = fmt::format("{} of {} postures compensated", summary.compensated, summary.asked);
  if (summary.cautioned > 0) text += fmt::format(", {} of them with cautions", summary.cautioned);
  if (summary.refused.empty()) return text;
  text += fmt::format("; {} refused: ", summary.asked - summary.compensated);
  for (std::size_t i = 0; i < summary.refused.size(); ++i) {
    const auto& [reason, count] = summary.refused[i];
    text += fmt::format("{}{} because {}", i > 0 ? ", " : "", count, refusalWords(reason));
  }
  return text;
}

}  // namespace stiffscope::reports
