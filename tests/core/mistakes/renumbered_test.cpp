// Postures whose angles stand in each other's rows, in whatever order: the readings tell which row is whose.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <random>
#include "core/campaign/read_campaign.h"
#include "core/mistakes/find_mistakes.h"
#include "core/mistakes/remarks.h"
#include "reports/words/remark_words.h"

namespace stiffscope {
namespace renumbered_test {

campaign::Campaign goodDay(bool swept) {
  static const campaign::Campaign day =
      campaign::readCampaign(std::filesystem::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active").campaign;
  campaign::Campaign some = day;
  if (!swept) some.circle_sweeps.reset(), some.wrist_sweep.reset();
  return some;
}

/// The day with the angles of posture i in the row of posture to[i], and with the wrenches where `whole`.
campaign::Campaign renumbered(campaign::Campaign day, const std::vector<int>& to, bool whole) {
  const std::vector<campaign::State> as_read = day.states->rows;
  const auto place = [&](int pose) { return static_cast<std::size_t>(pose); };
  for (campaign::State& row : day.states->rows) {
    for (const campaign::State& from : as_read) {
      if (to[place(from.pose)] != row.pose || from.step != row.step) continue;
      row.q = from.q;
      if (whole) row.wrench_in_cell = from.wrench_in_cell;
    }
  }
  return day;
}

std::vector<int> asRead(std::size_t count) {
  std::vector<int> to(count);
  std::iota(to.begin(), to.end(), 0);
  return to;
}

/// The one mistake that is named, in words; empty: none or several.
std::string named(const campaign::Campaign& day) {
  const mistakes::ModelAgreement found = mistakes::findMistakes(day);
  if (found.arm.size() != 1 || !found.loads.empty()) return {};
  const mistakes::Suspected& one = found.arm.front();
  if (one.mistake.name() != "row_order") return {};
  EXPECT_LT(one.after, 0.25 * one.before);
  return fmt::format("{}: {}", reports::words(one.where), reports::words(one.remedy));
}

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

TEST(Renumbered, AnOrderIsNamedAndWithoutItEachPosture) {
  for (const bool swept : {true, false}) {
    const campaign::Campaign good = goodDay(swept);
    const std::size_t count = good.pose_ids.size();
    std::vector<int> to = asRead(count);
    std::reverse(to.begin(), to.end());
    const std::string reversed = named(renumbered(good, to, false));
    EXPECT_TRUE(says(reversed,
                     "angles stand in the rows of other poses, in the reverse order: those of pose 1 in that "
                     "of pose 19, "))
        << reversed;
    EXPECT_TRUE(says(reversed, "states.csv")) << reversed;
    to = asRead(count);
    std::rotate(to.begin(), to.begin() + 5, to.end());
    EXPECT_TRUE(says(named(renumbered(good, to, false)), "5 rows further on, those at the end at the beginning"));
    to = asRead(count);
    std::rotate(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(count) - 4, to.end());
    EXPECT_TRUE(says(named(renumbered(good, to, false)), "4 rows further up, those at the beginning at the end"));
    // Sorted as texts: 1, 10, 11, .. 19, 2, 3, ..; the second of them got the number 2.
    std::vector<int> texts = asRead(count);
    std::sort(texts.begin(), texts.end(), [](int a, int b) { return std::to_string(a + 1) < std::to_string(b + 1); });
    for (std::size_t i = 0; i < count; ++i) to[static_cast<std::size_t>(texts[i])] = static_cast<int>(i);
    const std::string as_texts = named(renumbered(good, to, false));
    EXPECT_TRUE(says(as_texts, "in the order of their names as texts, which has 10 before 2")) << as_texts;
    EXPECT_TRUE(says(as_texts, "those of pose 2 in that of pose 12")) << as_texts;
    to = asRead(count);
    std::shuffle(to.begin(), to.end(), std::mt19937(7));
    const std::string any = named(renumbered(good, to, false));
    EXPECT_TRUE(says(any, fmt::format("other poses: those of pose {} in", to[0] == 0 ? 2 : 1))) << any;
    EXPECT_TRUE(says(any, "put the angles of each pose into its own row")) << any;
  }
}

TEST(Renumbered, ThreePosturesOfMany) {
  std::vector<int> to = asRead(goodDay(true).pose_ids.size());
  to[3] = 8, to[8] = 14, to[14] = 3;
  const std::string text = named(renumbered(goodDay(true), to, false));
  EXPECT_TRUE(says(text,
                   "those of pose 4 in that of pose 9, those of pose 9 in that of pose 15, those of pose 15 in "
                   "that of pose 4: "))
      << text;
}

TEST(Renumbered, WrenchesThatGoAlongMakeItWholeRows) {
  std::vector<int> to = asRead(goodDay(true).pose_ids.size());
  std::reverse(to.begin(), to.end());
  const std::string text = named(renumbered(goodDay(true), to, true));
  EXPECT_TRUE(says(text, "angles and wrenches stand in the rows of other poses, in the reverse order")) << text;
  EXPECT_TRUE(says(text, "number the rows, or the readings, as the others are")) << text;
}

TEST(Renumbered, AGoodDayIsNot) {
  for (const bool swept : {true, false}) {
    const mistakes::ModelAgreement found = mistakes::findMistakes(goodDay(swept));
    EXPECT_TRUE(found.arm.empty());
    EXPECT_FALSE(found.arm_contradicted);
  }
}

}  // namespace renumbered_test
}  // namespace stiffscope
