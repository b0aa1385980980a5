#include "reports/words/entry_words.h"

namespace stiffscope::reports {

std::string nameOfId(std::string_view id) {
  std::string name(id);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string shortDetail(const std::string& detail) {
  constexpr std::string_view kJoint = "joint ";
  std::vector<std::string> joints;
  for (std::size_t at = 0; at < detail.size();) {
    const std::size_t end = std::min(detail.find(", ", at), detail.size());
    const std::string one = detail.substr(at, end - at);
    if (one.size() != kJoint.size() + 1 || one.rfind(kJoint, 0) != 0) return detail;
    joints.push_back(one.substr(kJoint.size()));
    at = end + 2;
  }
  if (joints.size() < 2) return detail;
  std::sort(joints.begin(), joints.end());  // they come in the order in which they were found
  bool in_a_row = joints.size() > 2;
  for (std::size_t i = 1; i < joints.size(); ++i) in_a_row = in_a_row && joints[i][0] == joints[i - 1][0] + 1;
  if (in_a_row) return fmt::format("joints {} to {}", joints.front(), joints.back());
  const std::string last = joints.back();
  joints.pop_back();
  return fmt::format("joints {} and {}", fmt::join(joints, ", "), last);
}

}  // namespace stiffscope::reports
