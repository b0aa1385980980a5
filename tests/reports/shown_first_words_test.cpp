#include <gtest/gtest.h>

#include "core/identification/remarks.h"
#include "core/identification/shown_first.h"
#include "reports/json/identification_json.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace shown_first_words_test {

using identification::Method;

TEST(ShownFirst, SaysWhyAndWhatItCompensatesAtTheOtherPoint) {
  SmallResult small;
  small.method(Method::partial_pose).subsets.at_targets.held_out = {0.85, 0.86, 0.87};
  small.method(Method::decoupled_partial_pose).subsets.at_targets.held_out = {0.83, 0.84, 0.85};
  const auto first = identification::methodShownFirst(small.identification);
  ASSERT_TRUE(first);
  EXPECT_EQ(
      reports::shownFirstWords(small.identification, *first),
      "Shown first: PP, which compensates most of the deflection at the reflectors on postures held out (PP 86.00 "
      "%, DPP 84.00 %). Held out, it compensates 85.00 % at P_wrist.");
  const reports::Json json = reports::shownFirstJson(first);
  EXPECT_EQ(json["method"], "pp");
  EXPECT_EQ(json["judged_at"], "reflectors");
  EXPECT_TRUE(reports::shownFirstJson(std::nullopt).is_null());
}

TEST(ShownFirst, SaysByHowLittleEqualsDiffer) {
  SmallResult small;
  small.method(Method::partial_pose).subsets.at_targets.held_out = {0.85, 0.84, 0.77};
  small.method(Method::decoupled_partial_pose).subsets.at_targets.held_out = {0.80, 0.80, 0.80};
  const auto first = identification::methodShownFirst(small.identification);
  EXPECT_EQ(
      reports::words(first->reason),
      "DPP, as good as PP, which compensates most of the deflection at the reflectors on postures held out (PP "
      "82.00 %, DPP 80.00 %): by 2.00 % more, with a standard deviation of 4.36 % over the subsets; of equals DPP "
      "goes before PP, and PP before CP");
}

TEST(ShownFirst, TheOneThatWasAskedForSaysBothShares) {
  SmallResult small;
  const std::vector<Method> asked{Method::partial_pose};
  const auto first = identification::shownFirstOf(small.identification, asked);
  EXPECT_EQ(reports::shownFirstWords(small.identification, *first),
            "Shown first: PP, as asked. Held out, it compensates 84.00 % at the reflectors and 85.00 % at P_wrist.");
}

}  // namespace shown_first_words_test
}  // namespace stiffscope
