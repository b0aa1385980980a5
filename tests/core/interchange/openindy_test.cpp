#include <gtest/gtest.h>

#include "core/interchange/point_file.h"
#include "tests/core/interchange/refusal.h"

// One observation in OpenIndy's grammar; its readings are tested with those of the other formats (point_file_test.cpp).

namespace stiffscope {
namespace openindy_test {

using namespace interchange;

/// A project of one Cartesian reading whose observation has these attributes.
std::string project(const std::string& attributes) {
  return "<oiProjectData><stations><station id=\"1\" name=\"S1\"/></stations>\n"
         "<geometries><geometry id=\"2\" name=\"P10\" type=\"point\"/></geometries>\n<observations>\n"
         "<observation id=\"3\" " +
         attributes +
         "><station ref=\"1\"/><reading id=\"4\" type=\"cartesian\"><measurements>"
         "<measurement sigma=\"0\" value=\"1\" type=\"x\"/><measurement sigma=\"0\" value=\"2\" type=\"y\"/>"
         "<measurement sigma=\"0\" value=\"3\" type=\"z\"/></measurements></reading>"
         "<measuredTargetGeometry ref=\"2\"/></observation></observations></oiProjectData>";
}

TEST(OpenIndyValidity, IsWrittenInWordsOrFigures) {
  for (const char* valid : {"isValid=\"1\"", "isValid=\"true\"", ""}) {
    const PointFile file = parsePointFile("day.xml", project(valid), {});
    EXPECT_EQ(file.points.size(), 1u) << valid;
    EXPECT_TRUE(file.skipped.empty()) << valid;
  }
  for (const char* invalid : {"isValid=\"0\"", "isValid=\"false\""}) {
    const PointFile file = parsePointFile("day.xml", project(invalid), {});
    EXPECT_TRUE(file.points.empty()) << invalid;
    ASSERT_EQ(file.skipped.size(), 1u) << invalid;
    EXPECT_EQ(file.skipped[0].reason, Skip::marked_invalid);
  }
  const auto other = [] { parsePointFile("day.xml", project("isValid=\"no\""), {}); };
  interchange_test::expectSays(interchange_test::refusalOf(other), {"day.xml:4", "isValid", "'no'", "1 or true"});
}

}  // namespace openindy_test
}  // namespace stiffscope
