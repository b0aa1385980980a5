#include "core/io/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <clocale>
#include <fstream>
#include <locale>
#include <thread>
#include "core/campaign/read_campaign.h"
#include "core/io/csv.h"
#include "core/io/input_error.h"
#include "core/io/xml.h"
#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace read_file_test {

namespace fs = std::filesystem;

template <class Read>
std::string whyRefusedBy(const Read& read) {
  try {
    read();
  } catch (const io::InputError& error) {
    return error.expectation();
  }
  return "";
}

std::string whyRefused(const fs::path& file, std::size_t largest = io::kLargestTable) {
  return whyRefusedBy([&] { io::readTextFile(file, largest); });
}

TEST(ReadFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(whyRefused(folder.path()), "expected a file; this is a directory");
  EXPECT_EQ(whyRefused(folder.path() / "none"), "expected a file; there is none");
  EXPECT_EQ(whyRefused("/dev/zero"), "expected an ordinary file");
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(whyRefused(folder.path() / "pipe"), "expected an ordinary file");  // and does not wait for a writer
}

// The file is sparse: two gigabytes by its size, nothing on the disk.
TEST(ReadFile, RefusesAFileOfTwoGigabytesBeforeItIsInMemory) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "large.csv";
  std::ofstream(file) << "x";
  fs::resize_file(file, std::uintmax_t{2} << 30);
  EXPECT_EQ(whyRefused(file), "expected a file of at most 1024 MiB; this one has 2048");
  fs::resize_file(file, 17 << 20);
  EXPECT_EQ(whyRefused(file, io::kLargestXml), "expected a file of at most 16 MiB; this one has 17");
}

// Somebody appends without a pause while the file is read again and again: some reading must notice.
TEST(ReadFile, NoticesAFileThatChangesWhileItIsRead) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "growing.csv";
  std::ofstream(file) << std::string(8 << 20, 'x');
  std::atomic<bool> done = false;
  std::thread writer([&] {
    std::ofstream more(file, std::ios::app);
    while (!done) more << "x" << std::flush;
  });
  std::string why;
  for (int i = 0; i < 1000 && why.empty(); ++i) why = whyRefused(file);
  done = true;
  writer.join();
  EXPECT_EQ(why, "expected a file that stays as it is; it changed while it was read");
}

bool isInput(const fs::path& file) {
  try {
    io::requireNotRead(file);
  } catch (const std::runtime_error&) {
    return true;
  }
  return false;
}

// Whoever computes again and again in one process may write anew what an earlier run has read.
TEST(OneRun, HasTheInputsThatAreReadWhileItStands) {
  const TemporaryFolder folder;
  const fs::path before = folder.path() / "before.csv", within = folder.path() / "within.csv",
                 inner = folder.path() / "inner.csv", elsewhere = folder.path() / "elsewhere.csv";
  for (const fs::path& file : {before, within, inner, elsewhere}) std::ofstream(file) << "x";
  io::readTextFile(before);
  EXPECT_TRUE(isInput(before));
  {
    const io::OneRun run;
    EXPECT_FALSE(isInput(before));
    io::readTextFile(within);
    EXPECT_TRUE(isInput(within));
    std::thread([&] { io::readTextFile(elsewhere); }).join();
    EXPECT_TRUE(isInput(elsewhere));  // cores share the work of a run
    {
      const io::OneRun another;
      EXPECT_FALSE(isInput(within));
      io::readTextFile(inner);
    }
    EXPECT_TRUE(isInput(within));
    EXPECT_TRUE(isInput(inner));
    io::readTextFile(before);
    EXPECT_TRUE(isInput(before));
  }
  // The program, which runs once, has them all.
  for (const fs::path& file : {before, within, inner, elsewhere}) EXPECT_TRUE(isInput(file)) << file;
}

TEST(CampaignFiles, NoticesAFileThatChangesBeforeTheLastIsRead) {
  const SmallCampaign files;
  campaign::CampaignFiles reading(files.folder());
  reading.readXml();
  reading.read({"nests.csv", "file", 1}, io::kLargestTable);
  EXPECT_EQ(whyRefusedBy([&] { reading.requireUnchanged(); }), "");
  files.write("nests.csv", files.read("nests.csv") + "3.0,N1,1,2,3\n");
  EXPECT_EQ(whyRefusedBy([&] { reading.requireUnchanged(); }),
            "expected a file that stays as it is; it changed while the campaign was read");
}

TEST(ReadCampaign, NamesItsInputsWithoutHashesWhereTheseAreNotWanted) {
  const SmallCampaign files;
  const std::vector<campaign::InputFile> hashed = campaign::readCampaign(files.folder()).campaign.inputs;
  const std::vector<campaign::InputFile> named =
      campaign::readCampaign(files.folder(), campaign::Hashes::left).campaign.inputs;
  ASSERT_EQ(named.size(), hashed.size());
  for (std::size_t i = 0; i < named.size(); ++i) {
    EXPECT_EQ(named[i].name, hashed[i].name);
    EXPECT_EQ(hashed[i].sha256.size(), 64u);
    EXPECT_EQ(named[i].sha256, "");
  }
}

std::vector<std::vector<std::string>> linesOf(std::string_view bytes) {
  io::CsvLines lines("t.csv", bytes);
  std::vector<std::vector<std::string>> all;
  for (std::vector<std::string_view> cells; lines.next(cells);) all.emplace_back(cells.begin(), cells.end());
  return all;
}

TEST(CsvLines, EndsLinesAtLfCrlfAndCr) {
  const std::vector<std::vector<std::string>> expected{{"a", "b"}, {"1", "2"}, {"3", ""}};
  EXPECT_EQ(linesOf("a,b\n1,2\n3,\n"), expected);
  EXPECT_EQ(linesOf("a,b\r\n1,2\r\n3,"), expected);
  EXPECT_EQ(linesOf("a,b\r1,2\r3,\r"), expected);
  EXPECT_EQ(linesOf("\xEF\xBB\xBF"
                    "a,b\r\r\n\n 1 ,\t2\n3, \r"),
            expected);
}

TEST(CsvLines, UnquotesCells) {
  const std::vector<std::vector<std::string>> expected{{"a,b", "say \"x\"", "", "5\""}};
  EXPECT_EQ(linesOf("\"a,b\" , \"say \"\"x\"\"\",\"\",5\""), expected);
}

// A mark may fall on each of the 64 places that are looked at together, and so may the end of the text.
TEST(CsvLines, CutsTheSameWhereverACellStarts) {
  for (const std::string end : {"\n", "\r\n", "\r", "\n \t\n"}) {
    for (std::size_t size = 0; size < 140; ++size) {
      const std::string name(size, 'x');
      const std::vector<std::vector<std::string>> plain{{name, "2.5 + 1", ""}, {"-1", "b", "!"}, {"c", "", ""}};
      EXPECT_EQ(linesOf(name + ", 2.5 + 1\t," + end + "-1,b,!" + end + "c,,"), plain);
      const std::vector<std::vector<std::string>> quoted{{"a", name + ","}, {"1", "2"}};
      EXPECT_EQ(linesOf("a,\"" + name + ",\"" + end + "1,2" + end), quoted);
    }
  }
}

// The cells of a line stand where those of the line before stood.
TEST(CsvLines, GivesEachLineItsOwnCellsAndNothingBehindTheLast) {
  const std::vector<std::vector<std::string>> expected{{"a", "b", "c"},      {"1"},  {"", ""},
                                                       {"2", "3", "4", "5"}, {"x,"}, {"6"}};
  EXPECT_EQ(linesOf("a,b,c\n1\n,\n\n2,3,4,5\n\"x,\"\n6\n"), expected);
  for (const std::string_view bytes : {"1\n", "1\n\n\n", "1\n\n \n", "1", "1\n\n2"}) {
    io::CsvLines lines("t.csv", bytes);
    std::vector<std::string_view> cells;
    while (lines.next(cells)) EXPECT_EQ(cells.size(), 1u);
    EXPECT_FALSE(lines.next(cells)) << bytes;
  }
}

// A table of commas alone would take sixteen bytes for each of them.
TEST(CsvLines, KeepsTheFirstCellsOfALineThatNoTableHasAndCountsThemAll) {
  for (const std::string cell : {"a", "\"a\"\"b\""}) {
    std::string bytes = cell;
    for (int i = 1; i < 10000; ++i) bytes += "," + cell;
    bytes += "\n1,2\n";
    io::CsvLines lines("t.csv", bytes);
    std::vector<std::string_view> cells;
    ASSERT_TRUE(lines.next(cells));
    EXPECT_EQ(lines.cellCount(), 10000u);
    ASSERT_EQ(cells.size(), io::CsvLines::kMostKept);
    EXPECT_EQ(cells.back(), cell == "a" ? "a" : "a\"b");
    ASSERT_TRUE(lines.next(cells));
    EXPECT_EQ(cells, (std::vector<std::string_view>{"1", "2"}));
    EXPECT_EQ(lines.cellCount(), 2u);
  }
}

// The cost of a line must not grow with the rest of the file, whatever its ends.
TEST(CsvLines, ReadsManyShortLinesOfEveryEndInLinearTime) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string bytes;
    for (int i = 0; i < 500000; ++i) bytes += "1" + end;
    EXPECT_EQ(linesOf(bytes).size(), 500000u);
  }
}

// A locale with a decimal comma and grouped thousands, which need not be installed.
struct CommaPunctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ReadCampaign, IsTheSameInALocaleWithDecimalCommas) {
  const SmallCampaign files;
  const campaign::Campaign plain = campaign::readCampaign(files.folder()).campaign;
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaPunctuation));
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // where it is installed
  const campaign::Campaign comma = campaign::readCampaign(files.folder()).campaign;
  std::locale::global(before);
  std::setlocale(LC_NUMERIC, "C");
  EXPECT_EQ(plain.loading->rows[1].point, comma.loading->rows[1].point);
  EXPECT_EQ(plain.tracker->angle_per_m, comma.tracker->angle_per_m);
  EXPECT_EQ(plain.robot.base_from_flange_at_zero.matrix(), comma.robot.base_from_flange_at_zero.matrix());
}

TEST(XmlFile, KnowsTheFiveReferencesOfXmlAndCharacters) {
  const io::XmlFile xml("x.xml", "<a b=\"&lt;&amp;&#65;&#x42;\"><!-- &c; --><![CDATA[&d;]]></a>");
  EXPECT_EQ(xml.root().requiredAttribute("b"), "<&AB");
  for (const char* text :
       {"<a>&file;</a>", "<a b=\"&x;\"/>", "<a>A & B</a>", "<a>&#;</a>", "<a>&</a>", "<a>&amp</a>"}) {
    EXPECT_EQ(whyRefusedBy([&] { io::XmlFile("x.xml", text); }),
              "expected &amp; for an ampersand; XML without a document type has no entities of its own");
  }
}

}  // namespace read_file_test
}  // namespace stiffscope
