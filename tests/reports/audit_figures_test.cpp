#include "reports/words/audit_figures.h"

#include <gtest/gtest.h>
#include "core/io/units.h"

namespace stiffscope {
namespace audit_figures_test {

preparation::AuditCheck checkOf(const char* id, std::optional<double> value, std::optional<double> limit) {
  preparation::AuditCheck check;
  check.id = id;
  check.value = value;
  check.limit = limit;
  return check;
}

TEST(AuditFigures, AreInTheUnitsThatPeopleRead) {
  const reports::AuditFigures arc = reports::figuresOf(checkOf("circle_arc", 120.0 * io::kDegree, 90.0 * io::kDegree));
  EXPECT_DOUBLE_EQ(*arc.value, 120.0);
  EXPECT_DOUBLE_EQ(*arc.limit, 90.0);
  EXPECT_EQ(arc.unit, "deg");
  EXPECT_DOUBLE_EQ(*reports::figuresOf(checkOf("station_drift", 12.5e-6, 1e-5)).value, 12.5);
  EXPECT_DOUBLE_EQ(*reports::figuresOf(checkOf("load_size", 2e5, 5e3)).limit, 5.0);
}

TEST(AuditFigures, AUnitStandsWhereThereIsAFigure) {
  EXPECT_EQ(reports::figuresOf(checkOf("posture_set", {}, 100.0)).unit, "condition number");
  const reports::AuditFigures none = reports::figuresOf(checkOf("posture_set", {}, {}));
  EXPECT_EQ(none.unit, "");
  EXPECT_FALSE(none.value || none.limit);
}

}  // namespace audit_figures_test
}  // namespace stiffscope
