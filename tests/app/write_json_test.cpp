#include "app/write_json.h"

#include <gtest/gtest.h>

namespace stiffscope {
namespace {

Json row(int i) {
  return {{"pose", "p" + std::to_string(i)}, {"text", "two\nlines, \"quoted\", \xC2\xB5m"}, {"value", 1.0 / (i + 3)},
          {"none", nullptr},  {"empty", Json::array()}, {"direction", {i, -i, {{"deep", {1, 2}}}}}};
}

Json rows(int count) {
  Json list = Json::array();
  for (int i = 0; i < count; ++i) list.push_back(row(i));
  return list;
}

std::string jsonText(const Json& json) {
  std::string text;
  writeJson(json, [&text](std::string_view part) { text += part; });
  return text;
}

TEST(WriteJson, WritesWhatDumpGives) {
  for (const int count : {0, 1, 499, 500, 512, 2000, 2048, 2049, 5000}) {
    const Json list = rows(count);
    const Json object{{"name", "a"}, {"rows", list}, {"key \"\n", {{"deeper", {{"rows", list}, {"", 1}}}, {"x", Json::object()}}}};
    for (const Json& json : {list, object, Json{{"lists", {list, list}}}}) EXPECT_EQ(jsonText(json), json.dump(1) + '\n');
  }
  for (const Json& json : {Json(nullptr), Json("a\nb"), Json(2.5), Json::object()}) EXPECT_EQ(jsonText(json), json.dump(1) + '\n');
}

}  // namespace
}  // namespace stiffscope
