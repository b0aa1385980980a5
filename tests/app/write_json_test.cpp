#include "app/output.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace stiffscope {
namespace write_json_test {

reports::Json row(int i) {
  return {{"pose", "p" + std::to_string(i)}, {"text", "two\nlines, \"quoted\", \xC2\xB5m"},
          {"value", 1.0 / (i + 3)},          {"none", nullptr},
          {"empty", reports::Json::array()}, {"direction", {i, -i, {{"deep", {1, 2}}}}}};
}

reports::Json rows(int count) {
  reports::Json list = reports::Json::array();
  for (int i = 0; i < count; ++i) list.push_back(row(i));
  return list;
}

std::string jsonText(const reports::JsonDocument& document) {
  std::string text;
  app::writeJson(document, [&text](std::string_view part) { text += part; });
  return text;
}

TEST(WriteJson, WritesWhatDumpGives) {
  for (const int count : {0, 1, 499, 500, 512, 2000, 2048, 2049, 5000}) {
    const reports::Json list = rows(count);
    const reports::Json object{{"name", "a"},
                               {"rows", list},
                               {"key \"\n", {{"deeper", {{"rows", list}, {"", 1}}}, {"x", reports::Json::object()}}}};
    for (const reports::Json& json : {list, object, reports::Json{{"lists", {list, list}}}})
      EXPECT_EQ(jsonText(json), json.dump(1) + '\n');
  }
  for (const reports::Json& json :
       {reports::Json(nullptr), reports::Json("a\nb"), reports::Json(2.5), reports::Json::object()})
    EXPECT_EQ(jsonText(json), json.dump(1) + '\n');
}

TEST(WriteJson, WritesRowsMadeOnTheWayAsIfTheyHadStoodThere) {
  for (const int count : {0, 1, 499, 2048, 5000}) {
    const reports::JsonRows made{static_cast<std::size_t>(count),
                                 [](std::size_t i) { return row(static_cast<int>(i)); }};
    reports::JsonDocument inner(reports::Json{{"a/b~c", 1}, {"first", "x"}});
    inner.setRows("a/b~c", made);  // keys that a pointer has to escape
    reports::JsonDocument document(reports::Json{{"name", "n"}, {"parts", reports::Json::array()}});
    document.set("/parts/0"_json_pointer, inner);
    document.set("/parts/1"_json_pointer, inner);
    document.json["parts"][1]["more"] = true;
    document.setRows("rows", made);
    document.json["end"] = nullptr;

    const reports::Json list = rows(count);
    const reports::Json whole{
        {"name", "n"},
        {"parts", {{{"a/b~c", list}, {"first", "x"}}, {{"a/b~c", list}, {"first", "x"}, {"more", true}}}},
        {"rows", list},
        {"end", nullptr}};
    EXPECT_EQ(jsonText(document), whole.dump(1) + '\n') << count;
  }
}

}  // namespace write_json_test
}  // namespace stiffscope
