#include "core/io/write_folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <random>
#include <sstream>

#include "tests/fixtures/small_campaign.h"

namespace stiffscope {
namespace write_folder_test {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

std::size_t entriesIn(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

std::string largeText(int number) {
  std::string large;
  for (int i = 0; i < 20000; ++i) large += std::to_string(number) + '\n';
  return large;
}

/// Two files of one generation, the second large enough to be cut, and handed over in two parts.
std::vector<io::FileToWrite> generation(int number) {
  const auto in_two = [large = largeText(number)](const io::ByteSink& sink) {
    sink(std::string_view(large).substr(0, 1000));
    sink(std::string_view(large).substr(1000));
  };
  return {{"a.txt", std::to_string(number)}, {"b.txt", io::ByteSource(in_two)}};
}

/// The generation that the folder holds, -1 where it holds two or a part of one.
int generationIn(const fs::path& folder) {
  const int number = std::stoi("0" + contentOf(folder / "a.txt"));
  return contentOf(folder / "b.txt") == largeText(number) ? number : -1;
}

TEST(WriteFolder, MakesTheFolderAndLeavesNothingBesideIt) {
  const TemporaryFolder scratch;
  io::writeFolderWhole(scratch.path() / "new" / "report/", generation(3));
  EXPECT_EQ(generationIn(scratch.path() / "new" / "report"), 3);
  EXPECT_EQ(entriesIn(scratch.path() / "new"), 1u);
}

TEST(WriteFolder, KeepsWhatElseTheFolderHolds) {
  const TemporaryFolder scratch;
  const fs::path folder = scratch.path() / "report";
  fs::create_directories(folder / "notes" / "old");
  std::ofstream(folder / "notes" / "old" / "n.txt") << "mine";
  std::ofstream(folder / "a.txt") << "earlier";
  fs::create_symlink("notes", folder / "link");
  fs::permissions(folder, fs::perms::owner_all);
  fs::create_directory_symlink("report", scratch.path() / "by_link");
  io::writeFolderWhole(scratch.path() / "by_link", generation(1));
  EXPECT_EQ(generationIn(folder), 1);
  EXPECT_EQ(contentOf(folder / "link" / "old" / "n.txt"), "mine");
  EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(scratch.path() / "by_link"));
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all);
  EXPECT_EQ(entriesIn(scratch.path()), 2u);
  EXPECT_EQ(entriesIn(folder), 4u);
}

// The current folder must stay the one that the shell stands in, so it is written into and not exchanged.
TEST(WriteFolder, WritesIntoTheCurrentFolderItself) {
  const TemporaryFolder scratch;
  const fs::path before = fs::current_path();
  fs::current_path(scratch.path());
  io::writeFolderWhole(".", generation(2));
  EXPECT_EQ(generationIn("."), 2);
  EXPECT_EQ(entriesIn("."), 2u);
  fs::current_path(before);
  EXPECT_EQ(generationIn(scratch.path()), 2);
}

TEST(WriteFolder, SaysWhichFolderAndWhy) {
  const TemporaryFolder scratch;
  std::ofstream(scratch.path() / "file") << "x";
  const auto why = [](const fs::path& folder) -> std::string {
    try {
      io::writeFolderWhole(folder, generation(1));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why(scratch.path() / "file"),
            (scratch.path() / "file").string() + ": cannot be written: it is no folder; expected the name of one");
  EXPECT_EQ(why(""), ": cannot be written: it names no folder; expected the name of one");
  EXPECT_NE(why(scratch.path() / "file" / "below"), "");
  if (::geteuid() == 0) return;  // root writes everywhere
  fs::create_directory(scratch.path() / "closed");
  fs::permissions(scratch.path() / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(why(scratch.path() / "closed"),
            (scratch.path() / "closed").string() +
                ": cannot be written: Permission denied; expected a folder that can be written");
}

/// Status of a child that runs `work`; what it throws becomes 3.
template <class Work>
int inChild(const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      work();
    } catch (const std::exception&) {
      ::_exit(3);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// A limit on the size of files stands for a full disk: a write stops in the middle of a file.
TEST(WriteFolder, AFullDiskLeavesTheEarlierFiles) {
  for (const bool in_place : {false, true}) {
    const TemporaryFolder scratch;
    const fs::path folder = scratch.path() / "report";
    io::writeFolderWhole(folder, generation(1));
    const int status = inChild([&] {
      if (in_place) fs::current_path(folder);
      ::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{30000, 30000};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      io::writeFolderWhole(folder, generation(2));
    });
    EXPECT_EQ(status, 3);
    EXPECT_EQ(generationIn(folder), 1);
    EXPECT_EQ(entriesIn(folder), 2u);
    EXPECT_EQ(entriesIn(scratch.path()), 1u);
  }
}

// 200 kills within the time of some writes; each leaves one generation whole, and other files where they were.
TEST(WriteFolder, AKillAtAnyMomentLeavesOneGenerationWhole) {
  const TemporaryFolder scratch;
  const fs::path folder = scratch.path() / "report";
  io::writeFolderWhole(folder, generation(0));
  std::ofstream(folder / "mine.txt") << "mine";
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(inChild([&] { io::writeFolderWhole(folder, generation(0)); }), 0);
  const auto took = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
  const auto most = static_cast<std::uint_fast32_t>(std::max<std::int64_t>(2 * took.count(), 8000));
  std::mt19937 random(1);
  int written = 0;
  for (int kill = 0; kill < 200; ++kill) {
    const int before = generationIn(folder);
    const pid_t child = ::fork();
    if (child == 0) {
      for (int number = before + 1;; ++number) io::writeFolderWhole(folder, generation(number));
    }
    ::usleep(static_cast<useconds_t>(random() % most));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const int after = generationIn(folder);
    ASSERT_GE(after, before) << "kill " << kill;
    ASSERT_EQ(contentOf(folder / "mine.txt"), "mine") << "kill " << kill;
    written += after > before ? 1 : 0;
  }
  EXPECT_GT(written, 0);
  io::writeFolderWhole(folder, generation(1));
  EXPECT_EQ(entriesIn(scratch.path()), 1u) << "the next run removes what killed ones left";
}

TEST(WriteFolder, RunsIntoOneFolderLeaveOneWhole) {
  const TemporaryFolder scratch;
  const fs::path folder = scratch.path() / "report";
  std::vector<pid_t> children;
  for (int run = 1; run <= 4; ++run) {
    const pid_t child = ::fork();
    if (child == 0) {
      int status = 0;
      try {
        for (int i = 0; i < 100; ++i) io::writeFolderWhole(folder, generation(run));
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        status = 1;
      }
      ::_exit(status);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_GE(generationIn(folder), 1);
  EXPECT_EQ(entriesIn(scratch.path()), 1u);
}

}  // namespace write_folder_test
}  // namespace stiffscope
