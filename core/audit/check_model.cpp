#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/audit/checks.h"
#include "core/audit/redundancies.h"
#include "core/audit/remarks.h"
#include "core/campaign/row_names.h"
#include "core/identification/estimate.h"
#include "core/identification/identifiability.h"
#include "core/identification/outliers.h"
#include "core/identification/warnings.h"
#include "core/mistakes/load_search.h"
#include "core/preparation/finding.h"

namespace stiffscope::audit {

namespace {

/// The check that names what no cure does: rows or reflectors that stand under other names.
std::string elsewhere(const AuditInput& input, const std::vector<mistakes::Suspected>& cures) {
  if (!cures.empty()) return {};
  if (statesOfOtherPostures(input)) return "time_order";
  return reflectorsExchanged(input) ? "rigid_tool" : "";
}

preparation::AuditCheck armCheck(const AuditInput& input) {
  const mistakes::ModelAgreement& model = input.model;
  if (!model.arm_miss) return preparation::notTestable("arm_model", Remark(MissingId::no_readings_of_arm));
  preparation::AuditCheck check;
  check.id = "arm_model";
  check.value = *model.arm_miss;
  check.limit = identification::kMissedGeometry;
  check.limit_source = Remark(LimitId::machines_off_drawing);
  check.message = Remark(RemarkId::readings_agree, *model.arm_miss);
  if (!model.arm_contradicted) return check;
  check.verdict = preparation::AuditVerdict::fail;
  check.impossible = true;
  if (model.arm.size() == 1) check.where = model.arm.front().where;
  check.message = Remark(RemarkId::readings_contradict, *model.arm_miss, model.arm.size(), elsewhere(input, model.arm));
  return check;
}

/// Postures whose displacements the springs of the others do not explain by more than chance or an effect makes: a
/// wrench that was not this one's, a state that was.
std::vector<identification::OutlyingPosture> contradicting(const AuditInput& input) {
  const identification::LoadedArm& arm = input.arm;
  if (arm.cases.empty() || !input.campaign.load_cell) return {};
  std::vector<identification::CaseEquations> equations = identification::reflectorEquations(arm);
  const robot::JointMask seen =
      identification::evaluateIdentifiability(arm.geometry, arm.cases, *input.campaign.load_cell, equations).mask();
  equations = identification::byPosture(std::move(equations));
  std::vector<identification::OutlyingPosture> found = identification::outlyingPostures(equations, seen);
  // So rarely by chance that the chance of a false finding over all checks stays what it is.
  constexpr double kByChance = 0.01 * preparation::kLevel;
  constexpr double kOfItsOwn = 0.25;  // of its displacements: backlash and joints that stiffen leave a posture as much
  std::erase_if(found, [&](const identification::OutlyingPosture& one) {
    const auto own = std::find_if(equations.begin(), equations.end(), [&](const identification::CaseEquations& other) {
      return other.posture == one.posture;
    });
    const double moved = own->right.norm() / std::sqrt(static_cast<double>(own->right.size()));
    return one.p_value > kByChance || one.rms < kOfItsOwn * moved;
  });
  return found;
}

preparation::AuditCheck loadCheck(const AuditInput& input) {
  const mistakes::ModelAgreement& model = input.model;
  if (!model.loads_left) return preparation::notTestable("load_model", Remark(MissingId::few_loads_of_model));
  constexpr double kSimulated = 0.15;  // largest share of 116 simulated machines with every effect
  preparation::AuditCheck check;
  check.id = "load_model";
  check.value = *model.loads_left;
  check.limit = mistakes::kContradicts;
  check.limit_source = Remark(LimitId::machines_leave, kSimulated);
  check.message = Remark(RemarkId::springs_agree, *model.loads_left);
  if (!model.loads_contradicted) {
    const std::vector<identification::OutlyingPosture> postures = contradicting(input);
    if (postures.empty()) return check;
    check.verdict = preparation::AuditVerdict::warn;
    if (postures.size() == 1)
      check.where = Remark(RemarkId::at_pose, campaign::poseName(input.campaign, postures.front().posture));
    check.message = identification::outlyingWarning(input.campaign, postures, false);
    return check;
  }
  check.verdict = preparation::AuditVerdict::fail;
  check.impossible = true;
  if (model.loads.size() == 1) check.where = model.loads.front().where;
  check.message =
      Remark(RemarkId::springs_contradict, *model.loads_left, model.loads.size(), elsewhere(input, model.loads));
  return check;
}

}  // namespace

Findings checkModel(const AuditInput& input) { return {armCheck(input), loadCheck(input)}; }

}  // namespace stiffscope::audit
