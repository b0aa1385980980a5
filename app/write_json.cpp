#include "app/write_json.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

/// Elements from which on a list is shared among the cores: rows of a posture each, which take some 20 us.
constexpr std::size_t kLong = 500;

/// Whether there is a long list in it, which is looked for where results have them: not inside of another
/// list.
bool hasLongList(const Json& value) {
  if (value.is_array()) return value.size() >= kLong;
  return value.is_object() && std::any_of(value.begin(), value.end(), hasLongList);
}

/// A value that stands `depth` deep, as dump(1) writes it there.
void addShort(const Json& value, std::size_t depth, std::string& text) {
  const std::string own = value.dump(1);
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
  explicit JsonWriter(const ByteSink& sink) : sink_(sink) {}

  void add(const Json& value, std::size_t depth) {
    if (!hasLongList(value)) {
      addShort(value, depth, text_);
    } else if (value.is_array()) {
      addLongList(value, depth);
    } else {
      addObject(value, depth);
    }
  }

  void end() {
    text_ += '\n';
    sink_(text_);
    text_.clear();
  }

 private:
  void addLongList(const Json& list, std::size_t depth) {
    constexpr std::size_t kBlock = 64, kBlocksTogether = 32;
    std::vector<std::string> blocks(kBlocksTogether);
    text_ += '[';
    for (std::size_t from = 0; from < list.size(); from += kBlock * kBlocksTogether) {
      onAllCores(kBlocksTogether, [&](std::size_t block) {
        blocks[block].clear();
        const std::size_t first = from + block * kBlock, end = std::min(list.size(), first + kBlock);
        for (std::size_t i = first; i < end; ++i) {
          blocks[block].append(i == 0 ? "\n" : ",\n").append(depth + 1, ' ');
          addShort(list[i], depth + 1, blocks[block]);
        }
      });
      sink_(text_);
      text_.clear();
      for (const std::string& block : blocks) sink_(block);
    }
    text_.append("\n").append(depth, ' ') += ']';
  }

  void addObject(const Json& object, std::size_t depth) {
    text_ += '{';
    const char* between = "\n";
    for (const auto& [key, value] : object.items()) {
      text_.append(between).append(depth + 1, ' ').append(Json(key).dump()).append(": ");
      add(value, depth + 1);
      between = ",\n";
    }
    text_.append("\n").append(depth, ' ') += '}';
  }

  const ByteSink& sink_;
  std::string text_;  ///< not handed on yet
};

}  // namespace

void writeJson(const Json& json, const ByteSink& sink) {
  JsonWriter writer(sink);
  writer.add(json, 0);
  writer.end();
}

}  // namespace stiffscope
