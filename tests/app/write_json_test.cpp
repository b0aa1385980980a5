#include "app/write_json.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

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

std::string jsonText(const JsonDocument& document) {
  std::string text;
  writeJson(document, [&text](std::string_view part) { text += part; });
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

TEST(WriteJson, WritesRowsMadeOnTheWayAsIfTheyHadStoodThere) {
  for (const int count : {0, 1, 499, 2048, 5000}) {
    const JsonRows made{static_cast<std::size_t>(count), [](std::size_t i) { return row(static_cast<int>(i)); }};
    JsonDocument inner(Json{{"a/b~c", 1}, {"first", "x"}});
    inner.setRows("a/b~c", made);  // keys that a pointer has to escape
    JsonDocument document(Json{{"name", "n"}, {"parts", Json::array()}});
    document.set("/parts/0"_json_pointer, inner);
    document.set("/parts/1"_json_pointer, inner);
    document.json["parts"][1]["more"] = true;
    document.setRows("rows", made);
    document.json["end"] = nullptr;

    const Json list = rows(count);
    const Json whole{{"name", "n"},
                     {"parts", {{{"a/b~c", list}, {"first", "x"}}, {{"a/b~c", list}, {"first", "x"}, {"more", true}}}},
                     {"rows", list},
                     {"end", nullptr}};
    EXPECT_EQ(jsonText(document), whole.dump(1) + '\n') << count;
  }
}

}  // namespace
}  // namespace stiffscope
