#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include "core/campaign/read_campaign.h"
#include "core/io/input_error.h"
#include "tests/fixtures/rejected_campaigns.h"
#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace reject_campaign_test {

void change(const SmallCampaign& files, const Rejected& test) {
  if (test.find == nullptr) {
    files.remove(test.file);
  } else if (*test.find == '\0') {
    files.write(test.file, test.replace);
  } else {
    files.alter(test.file, test.find, test.replace);
  }
}

/// A text of any length as it can stand in a table of Markdown.
std::string cell(const std::string& text) {
  std::string shown;
  for (const char c : io::oneLine(text, 100)) shown += c == '|' ? std::string("\\|") : std::string(1, c);
  return shown;
}

/// The change and the message as one row of bad_inputs.md.
std::string listed(const Rejected& test, const SmallCampaign& files, std::string message) {
  const std::string folder = files.folder().string();
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
    message.replace(at, folder.size(), "campaign");
  }
  const std::string what = test.find == nullptr ? "no such file"
                           : *test.find == '\0' ? "all of it `" + cell(test.replace) + "`"
                                                : "`" + cell(test.find) + "` became `" + cell(test.replace) + "`";
  return "| " + std::string(test.file) + " | " + what + " | " + io::oneLine(message, 1000) + " |\n";
}

std::string expectRejected(const Rejected& test) {
  const SmallCampaign files;
  change(files, test);
  try {
    campaign::readCampaign(files.folder());
    ADD_FAILURE() << "read on instead of: " << test.message;
  } catch (const io::InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(test.message), std::string::npos) << "expected: " << test.message << "\ngot: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_LT(text.size(), 500u) << text;
    return listed(test, files, text);
  }
  return "";
}

// The list is documentation, and this keeps it true: it is made from what the program says. Where it differs, the new
// one is written beside the test program, to be looked at and copied.
TEST(RejectCampaign, SaysWhatTheListOfBadInputsHas) {
  std::string list =
      "# What bad input is told\n\nOne change each to a small campaign that is right, and the message. Made and "
      "checked by "
      "tests/core/campaign/reject_campaign_test.cpp.\n\n| file | change | message |\n|---|---|---|\n";
  for (const Rejected& test : kTables) list += expectRejected(test);
  for (const Rejected& test : kXml) list += expectRejected(test);
  std::ostringstream kept;
  kept << std::ifstream(STIFFSCOPE_SOURCE_DIR "/tests/core/campaign/bad_inputs.md").rdbuf();
  if (kept.str() == list) return;
  const auto made = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bad_inputs.md";
  std::ofstream(made) << list;
  ADD_FAILURE() << "tests/core/campaign/bad_inputs.md is not what the program says now, which is in " << made;
}

TEST(RejectCampaign, NamesTheForcesThatStandWhereAnglesBelong) {
  const SmallCampaign files;
  // Columns swapped in the header: q1..q3 hold forces of more than a kilonewton.
  files.alter("states.csv", "q1_deg,q2_deg,q3_deg", "fx_n,fy_n,fz_n");
  files.alter("states.csv", "fx_n,fy_n,fz_n,mx_nm", "q1_deg,q2_deg,q3_deg,mx_nm");
  files.alter("states.csv", "-538.428", "-1342.240");
  EXPECT_THROW(
      {
        try {
          campaign::readCampaign(files.folder());
        } catch (const io::InputError& error) {
          EXPECT_EQ(error.place().line, 3u);
          EXPECT_EQ(error.place().column, "q1_deg");
          EXPECT_EQ(error.value(), "-1342.240");
          EXPECT_EQ(error.expectation(), "expected an angle in degrees, within +-720");
          throw;
        }
      },
      io::InputError);
}

TEST(RejectCampaign, FollowsNoLinkOutOfTheFolderButTakesOneWithin) {
  const SmallCampaign files;
  const TemporaryFolder elsewhere;
  std::filesystem::rename(files.folder() / "nests.csv", elsewhere.path() / "nests.csv");
  std::filesystem::create_symlink(elsewhere.path() / "nests.csv", files.folder() / "nests.csv");
  try {
    campaign::readCampaign(files.folder());
    ADD_FAILURE() << "read a file outside the folder";
  } catch (const io::InputError& error) {
    EXPECT_EQ(error.expectation(), "expected a file inside the campaign's folder; a link leads out of it");
  }
  std::filesystem::remove(files.folder() / "nests.csv");
  std::filesystem::copy_file(elsewhere.path() / "nests.csv", files.folder() / "real.csv");
  std::filesystem::create_symlink("real.csv", files.folder() / "nests.csv");
  EXPECT_EQ(campaign::readCampaign(files.folder().string() + "/").campaign.nests->rows.size(), 2u);
}

TEST(RejectCampaign, NamesAFolderThatIsNotThere) {
  const TemporaryFolder folder;
  try {
    campaign::readCampaign(folder.path() / "none");
    ADD_FAILURE();
  } catch (const io::InputError& error) {
    EXPECT_EQ(error.what(),
              (folder.path() / "none").string() + ": expected a campaign folder or its campaign.xml; there is none");
  }
}

// Whatever prefix of a table was transferred, it is either refused or warned about, unless it ends with a
// line.
TEST(RejectCampaign, NoticesATableCutShortAnywhere) {
  const SmallCampaign files;
  const std::string whole = files.read("states.csv");
  const std::size_t header_end = whole.find('\n');
  for (std::size_t size = 1; size < whole.size(); ++size) {
    if (size > header_end + 1 && whole[size - 1] == '\n') continue;
    files.write("states.csv", whole.substr(0, size));
    try {
      EXPECT_FALSE(campaign::readCampaign(files.folder()).warnings.empty()) << "first " << size << " bytes";
    } catch (const io::InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace reject_campaign_test
}  // namespace stiffscope
