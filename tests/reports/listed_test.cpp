#include "reports/words/listed.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace stiffscope {
namespace listed_test {

std::vector<std::string> squares(int count, std::size_t most = reports::kMostListed) {
  std::vector<int> numbers;
  for (int i = 1; i <= count; ++i) numbers.push_back(i);
  return reports::listed(
      numbers, [](int i) { return std::to_string(i * i); }, reports::kListedInJson, most);
}

TEST(Listed, TenAreShownWhole) {
  EXPECT_TRUE(squares(0).empty());
  EXPECT_EQ(squares(10).size(), 10u);
  EXPECT_EQ(squares(10).back(), "100");
}

TEST(Listed, OfMoreTheNumberAndThePlaceOfTheRest) {
  EXPECT_EQ(squares(11).size(), 11u);
  EXPECT_EQ(squares(11).back(), "and 1 more; all of them in --json");
  EXPECT_EQ(squares(9800).size(), 11u);
  EXPECT_EQ(squares(9800)[9], "100");
  EXPECT_EQ(squares(9800).back(), "and 9790 more; all of them in --json");
  EXPECT_EQ(squares(5, 3), (std::vector<std::string>{"1", "4", "9", "and 2 more; all of them in --json"}));
}

}  // namespace listed_test
}  // namespace stiffscope
