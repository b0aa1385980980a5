#include <gtest/gtest.h>

#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/station_day.h"

// A tracker that is carried to another place.

namespace stiffscope {
namespace later_station_test {

const std::filesystem::path kSample = STIFFSCOPE_SOURCE_DIR "/samples/active.xml";

/// The sample's specification with this instead of its tracker's place.
std::string specWith(const std::string& place) {
  std::string text = io::readTextFile(kSample, io::kLargestXml);
  const std::string was = "xyz_mm=\"4000 -1600 1200\" rpy_deg=\"0.3 -0.2 152\"/>";
  const auto at = text.find(was);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, was.size(), place);
}

std::string refusalOf(const std::string& text) {
  try {
    simulation::parseSimulationSpec(text, kSample);
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "not refused";
}

const std::string kFirst = "station=\"A\" xyz_mm=\"4000 -1600 1200\" rpy_deg=\"0.3 -0.2 152\">";
std::string later(const std::string& station, int before_posture) {
  return "<later_station station=\"" + station + "\" before_posture=\"" + std::to_string(before_posture) +
         "\" xyz_mm=\"3600 2400 1150\" rpy_deg=\"0.1 0.2 -140\"/>";
}

TEST(LaterStation, ReadsTheSameArmFromAFrameOfItsOwn) {
  simulation::SimulationSpec spec = carriedDay(3, 0.0), still = spec;
  still.tracker.later.clear();
  const campaign::Campaign carried = simulation::simulate(spec), whole = simulation::simulate(still);
  ASSERT_EQ(carried.stations.size(), 2u);
  EXPECT_EQ(carried.stations[1].id, "B");
  EXPECT_TRUE(whole.stations.empty());
  ASSERT_EQ(carried.loading->rows.size(), whole.loading->rows.size());
  for (std::size_t i = 0; i < whole.loading->rows.size(); ++i) {
    const campaign::LoadingReading &one = carried.loading->rows[i], &other = whole.loading->rows[i];
    ASSERT_EQ(one.station, one.pose < 9 ? 0 : 1);
    const Eigen::Vector3d in_first = one.station == 0 ? one.point : secondStation() * one.point;
    ASSERT_LT((in_first - other.point).norm(), 1e-12);  // rounding of some metres
  }
  // All nests before it is carried away, and again once it stands.
  std::array<int, 2> rounds{};
  for (const campaign::NestReading& row : carried.nests->rows)
    rounds[static_cast<std::size_t>(row.station)] += row.nest == 0;
  EXPECT_GE(rounds[0], 3);
  EXPECT_GE(rounds[1], 2);
}

TEST(LaterStation, IsReadFromTheSpecification) {
  const simulation::SimulationSpec spec =
      simulation::parseSimulationSpec(specWith(kFirst + later("B", 8) + later("C", 14) + "</tracker>"), kSample);
  EXPECT_EQ(spec.tracker.station, "A");
  ASSERT_EQ(spec.tracker.later.size(), 2u);
  EXPECT_EQ(spec.tracker.later[1].id, "C");
  EXPECT_EQ(spec.tracker.later[1].before_posture, 14);
  EXPECT_NEAR(spec.tracker.later[0].base_from_tracker.translation().x(), 3.6, 1e-15);
}

TEST(LaterStation, IsRefusedWhereTheDayCannotHaveIt) {
  const auto refused = [](const std::string& place, const std::string& message) {
    const std::string text = refusalOf(specWith(place));
    EXPECT_NE(text.find(message), std::string::npos) << text;
  };
  refused(kFirst + later("A", 8) + "</tracker>", "station: 'A': expected every station once");
  refused(kFirst + later("B", 1) + "</tracker>", "before_posture: '1': expected a posture after the first");
  refused(kFirst + later("B", 8) + later("C", 8) + "</tracker>", "before_posture: '8': expected a posture after");
  refused(kFirst + "</tracker>", "station: 'A': expected a later_station beside it");
  refused("xyz_mm=\"4000 -1600 1200\" rpy_deg=\"0.3 -0.2 152\">" + later("B", 8) + "</tracker>",
          "station: expected this attribute of <tracker>");
}

}  // namespace later_station_test
}  // namespace stiffscope
