#include "app/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

namespace stiffscope::app {

Manner& manner() {
  static Manner one;
  return one;
}

void addMannerOptions(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    addMannerOptions(*command);
    if (!command->get_subcommands(nullptr).empty() || command->get_name() == "view" || command->get_name() == "help")
      continue;
    command->add_option("--color", manner().colour, "colour verdicts: on a terminal, always, never")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->option_text("auto|always|never")
        ->group("Terminal");
    CLI::Option* quiet = command->add_flag_callback(
        "-q,--quiet", [] { manner().verbosity = Verbosity::quiet; }, "no warnings of the input, no progress");
    CLI::Option* verbose = command->add_flag_callback(
        "-v,--verbose", [] { manner().verbosity = Verbosity::verbose; }, "say each stage of the work with its time");
    quiet->group("Terminal")->excludes(verbose);
    verbose->group("Terminal");
  }
}

namespace {

bool isSet(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool isDumb() {
  const char* const terminal = std::getenv("TERM");
  return terminal == nullptr || std::strcmp(terminal, "dumb") == 0;
}

constexpr const char *kGreen = "\x1b[32m", *kYellow = "\x1b[33m", *kRed = "\x1b[31m", *kPlain = "\x1b[0m";

struct VerdictWord {
  std::string_view word;
  const char* colour;
};
constexpr std::array kVerdictWords{VerdictWord{"pass", kGreen}, VerdictWord{"warn", kYellow}, VerdictWord{"fail", kRed},
                                   VerdictWord{"not testable", kYellow}, VerdictWord{"not_testable", kYellow}};

std::string painted(std::string_view word, const char* colour) {
  return std::string(colour).append(word).append(kPlain);
}

/// "  station drift        ": the first column of a table of checks.
bool isCheckName(std::string_view before) {
  const std::size_t begin = before.find_first_not_of(' ');
  if (begin != 2) return false;
  const std::size_t end = before.find_last_not_of(' ') + 1;
  const std::string_view name = before.substr(begin, end - begin);
  if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_ ") != std::string_view::npos) return false;
  // Words of prose have one blank between them, as a name has that fills its column of 21 letters.
  constexpr std::size_t kVerdictColumn = 23;
  const bool one_word = name.find(' ') == std::string_view::npos;
  return end < before.size() && (one_word || before.size() > end + 1 || before.size() == kVerdictColumn);
}

/// Where a verdict may stand in a line: behind the name of a check in a table, or between "NAME: " and its end or a
/// colon. Anywhere else the words are prose.
std::string paintedLine(std::string_view line) {
  for (const std::string_view caution : {"caution:", "warning:"}) {
    const std::size_t at = line.find_first_not_of(' ');
    if (at != std::string_view::npos && line.substr(at).starts_with(caution))
      return std::string(line.substr(0, at)) + painted(caution, kYellow) +
             std::string(line.substr(at + caution.size()));
  }
  for (const VerdictWord& verdict : kVerdictWords) {
    for (std::size_t at = line.find(verdict.word); at != std::string_view::npos; at = line.find(verdict.word, at + 1)) {
      const std::size_t end = at + verdict.word.size();
      if (end < line.size() && line[end] != ' ' && line[end] != ':') continue;
      const std::string_view before = line.substr(0, at), after = line.substr(end);
      const bool in_table = isCheckName(before) && (after.empty() || after.starts_with("  "));
      const bool in_title =
          !before.starts_with(' ') && before.ends_with(": ") && (after.empty() || after.starts_with(':'));
      if (!in_table && !in_title) continue;
      return std::string(before) + painted(verdict.word, verdict.colour) + std::string(after);
    }
  }
  return std::string(line);
}

}  // namespace

bool coloursText() {
  if (manner().colour != "auto") return manner().colour == "always";
  return isatty(STDOUT_FILENO) != 0 && !isSet("NO_COLOR") && !isDumb();
}

bool showsUtf8() {
  if (isatty(STDOUT_FILENO) == 0) return false;
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {  // the first that is set decides (POSIX)
    if (!isSet(variable)) continue;
    std::string charset(std::getenv(variable));
    std::transform(charset.begin(), charset.end(), charset.begin(), [](unsigned char c) { return std::tolower(c); });
    return charset.ends_with("utf-8") || charset.ends_with("utf8") || charset.find("utf-8@") != std::string::npos;
  }
  return false;
}

std::string withVerdictColours(std::string_view text) {
  std::string coloured;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    coloured += paintedLine(text.substr(begin, end - begin));
    if (end < text.size()) coloured += '\n';
    begin = end + 1;
  }
  return coloured;
}

using Clock = std::chrono::steady_clock;

namespace {

/// Whether a line stands on the terminal that is to be cleared, for who ends the program by a signal.
std::atomic<bool> line_stands = false;

constexpr std::array kEndingSignals{SIGINT, SIGTERM, SIGHUP};

/// Clears the line and ends the program as the signal does without this; what is called here is allowed in a handler.
extern "C" void clearAndEnd(int signal) {
  constexpr std::string_view kClear = "\r\x1b[K";
  if (line_stands.exchange(false) && ::write(STDERR_FILENO, kClear.data(), kClear.size()) < 0) {
  }  // nobody is left to be told
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// Columns of the terminal on standard error, 80 where it does not say.
std::size_t terminalWidth() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string shortenedLine(std::string text, std::size_t columns) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };  // a letter of UTF-8
  const auto letters = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins));
  if (letters <= columns) return text;
  constexpr std::string_view kGap = "...";
  if (columns <= 2 * kGap.size()) return {};
  const std::size_t kept = columns - kGap.size(), head = 2 * kept / 3;
  std::string shortened;
  std::size_t letter = 0;
  for (const char c : text) {
    if (begins(c)) ++letter;
    if (letter == head + 1 && begins(c)) shortened += kGap;
    if (letter <= head || letter > letters - (kept - head)) shortened += c;
  }
  return shortened;
}

/// Written by a thread of its own, so that a computation of minutes shows that it lives.
struct ProgressLine {
  explicit ProgressLine(std::string name) : command(std::move(name)) {
    shown = isatty(STDERR_FILENO) != 0 && !isDumb() && manner().verbosity == Verbosity::usual;
    if (!shown) return;
    for (const int signal : kEndingSignals) {
      struct sigaction own {};
      if (::sigaction(signal, nullptr, &own) == 0 && own.sa_handler == SIG_DFL) std::signal(signal, clearAndEnd);
    }
    writer = std::thread([this] { run(); });
  }

  void run() {
    constexpr std::chrono::milliseconds kSilent{2000}, kEvery{250};
    std::unique_lock lock(mutex);
    auto next = started + kSilent;
    while (!ended.wait_until(lock, next, [this] { return done; })) {
      write();
      next = Clock::now() + kEvery;
    }
  }

  double seconds(Clock::time_point since) const { return std::chrono::duration<double>(Clock::now() - since).count(); }

  void write() {
    std::string text =
        fmt::format("stiffscope {}: {:.0f} s{}{}", command, seconds(started), stage.empty() ? "" : ", ", stage);
    // A line that wraps could not be written anew, nor cleared: there has to be room for the terminal's ^C behind it.
    constexpr std::size_t kRoom = 3;
    text = shortenedLine(std::move(text), std::max(terminalWidth(), kRoom) - kRoom);
    if (written && text == last) return;
    line_stands = true;
    std::fprintf(stderr, "\r\x1b[K%s", text.c_str());
    std::fflush(stderr);
    written = true;
    last = std::move(text);
  }

  void clear() {
    if (written) std::fprintf(stderr, "\r\x1b[K"), std::fflush(stderr);
    written = false;
    line_stands = false;
  }

  /// The time of a stage that was counted is said where it is counted.
  void endStage() const {
    if (manner().verbosity != Verbosity::verbose || stage.empty()) return;
    std::fprintf(stderr, "stiffscope: %s: %.1f s\n", stage.c_str(), seconds(stage_started));
  }

  std::string command, stage, last;
  bool shown = false, written = false, done = false;
  const Clock::time_point started = Clock::now();
  Clock::time_point stage_started = started;
  std::mutex mutex;
  std::condition_variable ended;
  std::thread writer;
};

namespace {

std::mutex standing_mutex;
ProgressLine* standing = nullptr;  ///< null: none stands

}  // namespace

Progress::Progress(const std::string& command) : line_(std::make_unique<ProgressLine>(command)) {
  const std::lock_guard lock(standing_mutex);
  standing = line_.get();
}

Progress::~Progress() {
  {
    const std::lock_guard lock(standing_mutex);
    standing = nullptr;
  }
  {
    const std::lock_guard lock(line_->mutex);
    line_->done = true;
    line_->clear();
    line_->endStage();
    // Of commands without stages this is all there is to say.
    if (manner().verbosity == Verbosity::verbose)
      std::fprintf(stderr, "stiffscope: %s: %.1f s in all\n", line_->command.c_str(), line_->seconds(line_->started));
  }
  line_->ended.notify_all();
  if (line_->writer.joinable()) line_->writer.join();
}

void atWork(const std::string& stage) {
  const std::lock_guard outer(standing_mutex);
  if (standing == nullptr) return;
  const std::lock_guard lock(standing->mutex);
  standing->endStage();
  standing->stage = stage;
  standing->stage_started = Clock::now();
}

void atWork(const std::string& stage, std::size_t done, std::size_t total) {
  const std::lock_guard outer(standing_mutex);
  if (standing == nullptr) return;
  const std::lock_guard lock(standing->mutex);
  if (manner().verbosity == Verbosity::verbose && done == total)
    std::fprintf(stderr, "stiffscope: %s %zu of %zu\n", stage.c_str(), done, total);
  standing->stage = fmt::format("{} {} of {}", stage, done, total);
}

void clearProgress() {
  const std::lock_guard outer(standing_mutex);
  if (standing == nullptr) return;
  const std::lock_guard lock(standing->mutex);
  standing->clear();
}

}  // namespace stiffscope::app
