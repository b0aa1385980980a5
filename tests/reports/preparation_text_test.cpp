#include "reports/words/preparation_words.h"

#include <gtest/gtest.h>
#include "core/preparation/remarks.h"

namespace stiffscope {
namespace preparation_text_test {

TEST(PreparationText, NothingDoneSaysWhyNot) {
  preparation::Preparation preparation;
  preparation.drift.reason = Remark(preparation::RemarkId::raw_asked_for);
  EXPECT_EQ(reports::preparationText(preparation),
            "Readings: none left out; no drift of the station taken off: raw readings were asked for.\n");
  preparation.raw = true;
  EXPECT_EQ(reports::preparationText(preparation), "Readings: raw: nothing left out, no drift taken off.\n");
}

TEST(PreparationText, AJumpSaysWhen) {
  preparation::Preparation preparation;
  preparation.drift = {true, {}, 31.4e-3, 0.012, 9000.0, {1019.0}, 1080, 792};
  EXPECT_EQ(reports::preparationWords(preparation),
            "none left out; the station's motion by the floor nests taken off 1080 of them: at most 31.400 mm and "
            "12000 urad, in a jump at about 1019 s; 792 state no time and stay as they were read");
}

TEST(PreparationText, TenReadingsAndTheNumberOfTheRest) {
  preparation::Preparation preparation;
  for (std::size_t line = 2; line < 27; ++line)
    preparation.rejected.push_back({"loading.csv", line, Remark(preparation::RemarkId::beam_lost)});
  const std::string text = reports::preparationText(preparation);
  EXPECT_NE(text.find("25 left out"), std::string::npos) << text;
  EXPECT_NE(
      text.find(
          "  left out: loading.csv:11: lost beam: the point is (0, 0, 0)\n  and 15 more; all of them in --json\n"),
      std::string::npos)
      << text;
  EXPECT_EQ(text.find("loading.csv:12"), std::string::npos) << text;
}

}  // namespace preparation_text_test
}  // namespace stiffscope
