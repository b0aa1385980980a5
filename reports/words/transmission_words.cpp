#include "reports/words/transmission_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <map>

#include "core/identification/remarks.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

const char* keyOf(identification::HeldSide held) {
  switch (held) {
    case identification::HeldSide::link:
      return "link_side";
    case identification::HeldSide::motor:
      return "motor_side";
    case identification::HeldSide::unknown:
      break;
  }
  return "unknown";
}

const char* wordsOf(identification::HeldSide held) {
  switch (held) {
    case identification::HeldSide::link:
      return "link side";
    case identification::HeldSide::motor:
      return "motor";
    case identification::HeldSide::unknown:
      break;
  }
  return "not known";
}

const char* keyOf(identification::GearAgreement agreement) {
  switch (agreement) {
    case identification::GearAgreement::apart:
      return "apart";
    case identification::GearAgreement::structure_seen:
      return "structure_seen";
    case identification::GearAgreement::gear_alone:
      return "gear_alone";
    case identification::GearAgreement::contradicts:
      return "contradicts";
  }
  return "";
}

const char* wordsOf(identification::GearAgreement agreement) {
  switch (agreement) {
    case identification::GearAgreement::apart:
      return "the tracker does not see the gear";
    case identification::GearAgreement::structure_seen:
      return "agree: the tracker sees more than the gear";
    case identification::GearAgreement::gear_alone:
      return "agree: the tracker sees the gear alone";
    case identification::GearAgreement::contradicts:
      return "disagree: the gear alone gives more than the tracker sees";
  }
  return "";
}

std::vector<std::string> transmissionNotes(const identification::Transmission& transmission) {
  std::vector<std::string> notes;
  std::map<std::string, std::vector<int>> not_measured;  // one sentence for joints of one reason
  for (std::size_t j = 0; j < transmission.joints.size(); ++j) {
    const identification::GearTorsion& joint = transmission.joints[j];
    if (!joint.measured) {
      not_measured[words(joint.reason)].push_back(static_cast<int>(j) + 1);
      continue;
    }
    if (!joint.caution.empty()) notes.push_back(words(joint.caution) + ".");
    if (joint.left_out > 0) {
      notes.push_back(fmt::format("Joint {}: {} of {} states left out, whose wind-up disagrees with the others'.",
                                  j + 1, joint.left_out, joint.left_out + joint.states));
    }
    if (joint.lost_motion && std::abs(joint.lost_motion->width) > 3.0 * joint.lost_motion->sd) {
      notes.push_back(fmt::format("Joint {}: lost motion of {:.5f} deg (u {:.5f}) where its torque turns round.", j + 1,
                                  joint.lost_motion->width / io::kDegree, joint.lost_motion->sd / io::kDegree));
    }
  }
  for (const auto& [reason, joints] : not_measured) {
    notes.push_back(
        fmt::format("Not measured: joint{} {}: {}.", joints.size() > 1 ? "s" : "", fmt::join(joints, ", "), reason));
  }
  return notes;
}

}  // namespace stiffscope::reports
