#include <gtest/gtest.h>

#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/io/input_error.h"
#include "tests/fixtures/small_campaign.h"

// The column `station`.

namespace stiffscope {
namespace stations_test {

std::string refusalOf(const SmallCampaign& files) {
  try {
    campaign::readCampaign(files.folder());
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "not refused";
}

/// A column of these cells behind the others; cells that are left out are those of the last.
void addStations(const SmallCampaign& files, const std::string& table, const std::vector<std::string>& cells) {
  std::string text = files.read(table), result;
  std::size_t row = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string cell = row == 0 ? "station" : cells[std::min(row, cells.size()) - 1];
    result += text.substr(at, end - at) + "," + cell + "\n";
    at = end + 1;
    ++row;
  }
  files.write(table, result);
}

std::vector<std::string> namesOf(const campaign::Campaign& campaign) {
  std::vector<std::string> names;
  for (const campaign::StationPlace& station : campaign.stations) names.push_back(station.id);
  return names;
}

TEST(Stations, ADayThatNamesNoneHasOne) {
  const SmallCampaign files;
  EXPECT_TRUE(campaign::readCampaign(files.folder()).campaign.stations.empty());
  addStations(files, "nests.csv", {""});
  const campaign::Campaign blank = campaign::readCampaign(files.folder()).campaign;
  EXPECT_TRUE(blank.stations.empty());
  EXPECT_EQ(blank.nests->rows.front().station, 0);
}

TEST(Stations, AreInTheOrderOfTheTablesTheUnnamedOneFirst) {
  const SmallCampaign files;
  addStations(files, "circle_sweeps.csv", {"B", "A"});
  addStations(files, "wrist_sweep.csv", {"A"});
  addStations(files, "loading.csv", {"B"});
  addStations(files, "nests.csv", {"A", "B"});
  const campaign::Campaign named = campaign::readCampaign(files.folder()).campaign;
  EXPECT_EQ(namesOf(named), (std::vector<std::string>{"B", "A"}));
  EXPECT_EQ(named.circle_sweeps->rows[0].station, 0);
  EXPECT_EQ(named.circle_sweeps->rows[1].station, 1);
  EXPECT_EQ(named.nests->rows[0].station, 1);

  const SmallCampaign some;
  addStations(some, "nests.csv", {"B", ""});
  const campaign::Campaign unnamed = campaign::readCampaign(some.folder()).campaign;
  EXPECT_EQ(namesOf(unnamed), (std::vector<std::string>{"", "B"}));
  EXPECT_EQ(unnamed.nests->rows[0].station, 1);
  EXPECT_EQ(unnamed.nests->rows[1].station, 0);
  EXPECT_EQ(unnamed.loading->rows[0].station, 0);
}

TEST(Stations, AreWrittenAsTheyWereRead) {
  const SmallCampaign files;
  addStations(files, "nests.csv", {"B", ""});
  const campaign::Campaign read = campaign::readCampaign(files.folder()).campaign;
  const TemporaryFolder written;
  campaign::writeCampaign(read, files.folder() / "robot.urdf", written.path() / "copy");
  const campaign::Campaign again = campaign::readCampaign(written.path() / "copy").campaign;
  EXPECT_EQ(namesOf(again), namesOf(read));
  for (std::size_t i = 0; i < read.nests->rows.size(); ++i)
    EXPECT_EQ(again.nests->rows[i].station, read.nests->rows[i].station);
}

TEST(Stations, AreRefusedInDisplacements) {
  const SmallCampaign files;
  addStations(files, "displacements.csv", {"B"});
  EXPECT_NE(refusalOf(files).find("displacements.csv:2: station: 'B': expected no station"), std::string::npos)
      << refusalOf(files);
}

TEST(Stations, AreRefusedInATableInBaseLink) {
  const SmallCampaign files;
  files.alter("campaign.xml", "file=\"nests.csv\"", "file=\"nests.csv\" frame=\"base_link\"");
  addStations(files, "nests.csv", {"", "B"});
  EXPECT_NE(refusalOf(files).find("nests.csv:3: station: 'B': expected no station in a table whose frame is base_link"),
            std::string::npos)
      << refusalOf(files);
}

TEST(Stations, AreRefusedWhereOneReflectorOfAPoseIsFromTwo) {
  const SmallCampaign files;
  std::vector<std::string> cells(20, "B");
  cells[0] = "A";
  addStations(files, "loading.csv", cells);
  const std::string message = refusalOf(files);
  EXPECT_NE(message.find("loading.csv:"), std::string::npos) << message;
  EXPECT_NE(
      message.find("station: 'B': expected all readings of reflector P10 in pose A from one station; line 2 has it "
                   "from 'A'"),
      std::string::npos)
      << message;
}

}  // namespace stations_test
}  // namespace stiffscope
