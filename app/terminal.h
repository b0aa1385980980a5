#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

// How the program speaks to a person at a terminal: colours of verdicts, what is said of the work while it lasts.

namespace CLI {
class App;
}

namespace stiffscope::app {

struct ProgressLine;

enum class Verbosity { quiet, usual, verbose };

/// What the options --color, --quiet and --verbose of any command ask for.
struct Manner {
  std::string colour = "auto";  ///< auto, always, never
  Verbosity verbosity = Verbosity::usual;
};

Manner& manner();

/// Adds these options to every command.
void addMannerOptions(CLI::App& app);

/// Whether what goes to standard output is coloured: as --color says; by itself on a terminal, unless NO_COLOR is set
/// (https://no-color.org) or the terminal is dumb.
bool coloursText();

/// Whether standard output is a terminal that shows UTF-8, by LC_ALL, LC_CTYPE or LANG. Files and pipes keep to what
/// any program reads alike.
bool showsUtf8();

/// The text with its verdicts in colour: `pass` green, `warn` and cautions yellow, `fail` red. Letters stay the same.
std::string withVerdictColours(std::string_view text);

/// A line that fits these columns: of a longer one its head and its end, where the names of files differ.
std::string shortenedLine(std::string text, std::size_t columns);

/// Says on standard error what the program is about, where that is a terminal: one line, from two seconds on, written
/// anew as work goes on, and cleared at the end, by Ctrl-C, too. With --verbose a line of each stage with its time
/// and one of all, wherever standard error goes. With --quiet nothing. One at a time.
class Progress {
 public:
  explicit Progress(const std::string& command);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  std::unique_ptr<ProgressLine> line_;
};

/// What is being done from now on ("diagnosis, campaign 1 of 2"); nothing where no Progress stands. Any thread.
void atWork(const std::string& stage);

/// The same where a share of a known number is done: "cases diagnosed 3 of 60".
void atWork(const std::string& stage, std::size_t done, std::size_t total);

/// Clears the line before something else is printed.
void clearProgress();

}  // namespace stiffscope::app
