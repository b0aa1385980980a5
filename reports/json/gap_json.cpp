#include "reports/json/gap_json.h"

#include <cmath>

#include "core/io/units.h"
#include "core/numerics/distributions.h"

namespace stiffscope::reports {

Json micrometres(double metres) { return number(metres / io::kMicrometre); }

Json shrinkJson(const diagnosis::Shrink& shrink) {
  return {{"value", number(shrink.value)}, {"low", number(shrink.low)}, {"high", number(shrink.high)}};
}

Json tablesJson(const std::vector<diagnosis::WhereTable>& tables) {
  Json json = Json::object();
  for (const diagnosis::WhereTable& table : tables) {
    Json rows = Json::array();
    for (const diagnosis::WhereRow& row : table.rows) {
      rows.push_back({{"name", row.name},
                      {"rms_um", micrometres(row.rms)},
                      {"noise_um", micrometres(row.noise)},
                      {"share", number(row.share)},
                      {"significance", number(row.significance)},
                      {"significance_at_limit", std::abs(row.significance) >= numerics::kLargestDeviate}});
    }
    json[table.by] = rows;
  }
  return json;
}

Json overlapsJson(const std::vector<diagnosis::WhereTable>& tables) {
  Json json;
  for (const diagnosis::WhereTable& table : tables) {
    if (table.overlaps) json[table.by] = {{"share_together", number(table.explained)}};
  }
  return json;
}

}  // namespace stiffscope::reports
