#include "core/identification/held_out_loads.h"
#include "reports/json/identification_json.h"
#include "reports/words/names.h"

namespace stiffscope::reports {

namespace {

Json loadsJson(const std::vector<identification::HeldOutLoad>& loads) {
  const auto share = [](const std::optional<double>& one) { return one ? number(*one) : Json(nullptr); };
  Json list = Json::array();
  for (const identification::HeldOutLoad& one : loads) {
    Json row;
    if (one.step) row["step"] = *one.step;
    if (one.direction) row["direction"] = nameOfDirection(*one.direction);
    row["states"] = one.states;
    row["mean_force_n"] = number(one.mean_force);
    row["at_wrist"] = share(one.at_wrist);
    row["at_targets"] = share(one.at_targets);
    Json joints = Json::array();
    for (std::size_t j = 0; j < one.not_by_the_others.size(); ++j)
      if (one.not_by_the_others[j]) joints.push_back(j + 1);
    row["joints_not_turned_by_the_others"] = std::move(joints);
    list.push_back(std::move(row));
  }
  return list;
}

}  // namespace

Json withHeldOutLoads(Json json, const identification::HeldOutLoads& loads,
                      const std::vector<identification::Method>& methods) {
  Json levels = Json::object(), directions = Json::object(), states = Json::object();
  for (const identification::Method method : methods) {
    const auto at = static_cast<std::size_t>(method);
    levels[namesOf(method).key] = loadsJson(loads.levels[at]);
    directions[namesOf(method).key] = loadsJson(loads.directions[at]);
  }
  for (std::size_t d = 0; d < identification::kLoadDirections; ++d)
    states[std::string(nameOfDirection(static_cast<identification::LoadDirection>(d)))] = loads.states[d];
  json["held_out_loads"] = {{"levels", levels}, {"directions", directions}, {"states_by_direction", states}};
  return json;
}

}  // namespace stiffscope::reports
