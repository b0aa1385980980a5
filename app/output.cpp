#include "app/output.h"

#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/terminal.h"
#include "core/identification/motor_side.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "core/numerics/parallel.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

std::string textOf(const reports::Json& json) {
  return json.dump(1, ' ', false, reports::Json::error_handler_t::replace);
}

namespace {

using Place = reports::Json::json_pointer;

/// Elements from which on a list is shared among the cores: rows of a posture each, which take some 20 us.
constexpr std::size_t kLong = 500;

/// Whether a list that is long, or not made yet, is in `value` or is it.
bool hasLongList(const reports::JsonDocument& document, const reports::Json& value, const Place& place) {
  if (document.rowsAt(place) != nullptr) return true;
  if (value.is_array()) {
    if (value.size() >= kLong) return true;
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_structured() && hasLongList(document, value[i], place / i)) return true;
    }
  } else if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      if (hasLongList(document, inner, place / key)) return true;
    }
  }
  return false;
}

/// A value that stands `depth` deep, as dump(1) writes it there.
void addShort(const reports::Json& value, std::size_t depth, std::string& text) {
  const std::string own = textOf(value);
  for (std::size_t from = 0; from < own.size();) {
    const std::size_t end = std::min(own.find('\n', from), own.size() - 1) + 1;
    text.append(own, from, end - from);
    if (end < own.size()) text.append(depth, ' ');
    from = end;
  }
}

/// The text on its way to a sink.
class JsonWriter {
 public:
  JsonWriter(const reports::JsonDocument& document, const io::ByteSink& sink) : document_(document), sink_(sink) {}

  void addAll() {
    add(document_.json, Place(), 0);
    text_ += '\n';
    handOn();
  }

 private:
  void add(const reports::Json& value, const Place& place, std::size_t depth) {
    if (const reports::JsonRows* rows = document_.rowsAt(place)) {
      addRows(rows->count, depth,
              [rows](std::size_t i, std::size_t deep, std::string& text) { addShort(rows->row(i), deep, text); });
    } else if (!hasLongList(document_, value, place)) {
      addShort(value, depth, text_);
    } else if (value.is_object()) {
      addObject(value, place, depth);
    } else if (value.size() >= kLong) {
      addRows(value.size(), depth,
              [&value](std::size_t i, std::size_t deep, std::string& text) { addShort(value[i], deep, text); });
    } else {
      addList(value, place, depth);
    }
  }

  template <class AddRow>
  void addRows(std::size_t count, std::size_t depth, const AddRow& addRow) {
    constexpr std::size_t kBlock = 64, kBlocksTogether = 32;
    if (count == 0) {
      text_ += "[]";
      return;
    }
    std::vector<std::string> blocks(kBlocksTogether);
    text_ += '[';
    for (std::size_t from = 0; from < count; from += kBlock * kBlocksTogether) {
      numerics::onAllCores(kBlocksTogether, [&](std::size_t block) {
        blocks[block].clear();
        const std::size_t first = from + block * kBlock, end = std::min(count, first + kBlock);
        for (std::size_t i = first; i < end; ++i) {
          blocks[block].append(i == 0 ? "\n" : ",\n").append(depth + 1, ' ');
          addRow(i, depth + 1, blocks[block]);
        }
      });
      handOn();
      for (const std::string& block : blocks) sink_(block);
    }
    endOf(']', depth);
  }

  void addList(const reports::Json& list, const Place& place, std::size_t depth) {
    text_ += '[';
    for (std::size_t i = 0; i < list.size(); ++i) {
      text_.append(i == 0 ? "\n" : ",\n").append(depth + 1, ' ');
      add(list[i], place / i, depth + 1);
    }
    endOf(']', depth);
  }

  void addObject(const reports::Json& object, const Place& place, std::size_t depth) {
    text_ += '{';
    const char* between = "\n";
    for (const auto& [key, value] : object.items()) {
      text_.append(between).append(depth + 1, ' ').append(textOf(reports::Json(key))).append(": ");
      add(value, place / key, depth + 1);
      between = ",\n";
    }
    endOf('}', depth);
  }

  void endOf(char closing, std::size_t depth) { text_.append("\n").append(depth, ' ') += closing; }

  void handOn() {
    sink_(text_);
    text_.clear();
  }

  const reports::JsonDocument& document_;
  const io::ByteSink& sink_;
  std::string text_;  ///< not handed on yet
};

}  // namespace

void writeJson(const reports::JsonDocument& document, const io::ByteSink& sink) { JsonWriter(document, sink).addAll(); }

campaign::Campaign openCampaign(const std::string& folder_or_xml, campaign::Hashes hashes) {
  atWork("reading " + folder_or_xml);
  campaign::CampaignReading reading = campaign::readCampaign(folder_or_xml, hashes);
  printWarnings(reading.warnings);
  atWork("computing");
  return identification::referredToMotors(std::move(reading.campaign));
}

void printWarnings(const std::vector<std::string>& warnings) {
  if (manner().verbosity == Verbosity::quiet || warnings.empty()) return;
  clearProgress();
  for (const std::string& warning : warnings) std::fprintf(stderr, "stiffscope: warning: %s\n", warning.c_str());
}

namespace {

bool isSameFile(const io::FileStamp& a, const io::FileStamp& b) { return a.device == b.device && a.inode == b.inode; }

struct ::stat standardOutput() {
  struct ::stat status {};
  ::fstat(STDOUT_FILENO, &status);
  return status;
}

/// Also of what has no name of its own, a pipe behind /dev/stdout.
bool isSameFile(const std::string& a, const std::string& b) {
  const auto there_a = io::stampOf(a), there_b = io::stampOf(b);
  if (there_a && there_b) return isSameFile(*there_a, *there_b);
  std::error_code none;
  const auto named = [&](const std::string& file) {
    const std::filesystem::path path = std::filesystem::weakly_canonical(std::filesystem::absolute(file, none), none);
    return none ? std::filesystem::path(file).lexically_normal() : path;
  };
  return named(a) == named(b);
}

}  // namespace

bool isStandardOutput(const std::string& file) {
  if (file == "-") return true;
  const auto there = io::stampOf(file);
  return there && isSameFile(*there, io::stampFrom(standardOutput()));
}

void requireOwnFiles(const std::vector<ResultFile>& files) {
  const auto is_json = [](const ResultFile& one) { return one.option == "--json"; };
  for (const ResultFile& one : files) {
    if (one.file.empty()) continue;
    if (!is_json(one) && one.file == "-")
      throw std::runtime_error(fmt::format("-: expected the name of a file for {}", one.option));
    // A file that is replaced is no longer what standard output writes to: the text would be lost.
    if (!is_json(one) && isStandardOutput(one.file) && S_ISREG(standardOutput().st_mode))
      throw std::runtime_error(
          fmt::format("{}: expected another file for {}: standard output goes there", one.file, one.option));
    for (const ResultFile& other : files) {
      if (&other == &one) break;
      const bool printed = is_json(one) && isStandardOutput(one.file);
      if (other.file.empty() || !(printed ? isStandardOutput(other.file) : isSameFile(one.file, other.file))) continue;
      throw std::runtime_error(
          fmt::format("{}: expected another file for {} than for {}", one.file, one.option, other.option));
    }
  }
}

void deliver(const std::function<reports::JsonDocument()>& json, const std::function<std::string()>& text,
             const std::string& json_file) {
  deliverPieces(
      json, [&text](const io::ByteSink& sink) { sink(text()); }, json_file);
}

void deliverPieces(const std::function<reports::JsonDocument()>& json, const io::ByteSource& text,
                   const std::string& json_file) {
  if (!json_file.empty() && isStandardOutput(json_file)) return writeJson(json(), printBytes);
  if (!json_file.empty()) {
    io::requireNotRead(json_file);
    const reports::JsonDocument values = json();
    io::writeFileWhole(json_file, [&values](const io::ByteSink& sink) { writeJson(values, sink); });
  }
  text([](std::string_view piece) { printText(reports::microUnits(std::string(piece))); });
}

Outlet commandLineOutlet(const std::string& json_file) {
  return {[json_file](const auto& json, const auto& text) { deliver(json, text, json_file); },
          [](const std::string& warning) { printWarnings({warning}); },
          [](const std::string& line) {
            clearProgress();
            std::fprintf(stderr, "stiffscope: %s\n", line.c_str());
          }};
}

void printText(std::string_view text) {
  clearProgress();
  std::string clean = io::withoutControls(text);
  if (showsUtf8()) clean = reports::plusMinusSigns(clean);
  printBytes(coloursText() ? withVerdictColours(clean) : clean);
}

void printBytes(std::string_view text) {
  errno = 0;
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(std::string("standard output: cannot be written: ") + std::strerror(errno));
}

}  // namespace stiffscope::app
