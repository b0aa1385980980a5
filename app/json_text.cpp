#include "app/json_text.h"

#include <algorithm>
#include <cstddef>
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

void add(const Json& value, std::size_t depth, std::string& text);

void addLongList(const Json& list, std::size_t depth, std::string& text) {
  constexpr std::size_t kBlock = 64;
  std::vector<std::string> blocks((list.size() + kBlock - 1) / kBlock);
  onAllCores(blocks.size(), [&](std::size_t block) {
    const std::size_t end = std::min(list.size(), (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) {
      blocks[block].append(i == 0 ? "\n" : ",\n").append(depth + 1, ' ');
      addShort(list[i], depth + 1, blocks[block]);
    }
  });
  text += '[';
  for (const std::string& block : blocks) text += block;
  text.append("\n").append(depth, ' ') += ']';
}

void addObject(const Json& object, std::size_t depth, std::string& text) {
  text += '{';
  const char* between = "\n";
  for (const auto& [key, value] : object.items()) {
    text.append(between).append(depth + 1, ' ').append(Json(key).dump()).append(": ");
    add(value, depth + 1, text);
    between = ",\n";
  }
  text.append("\n").append(depth, ' ') += '}';
}

void add(const Json& value, std::size_t depth, std::string& text) {
  if (!hasLongList(value)) {
    addShort(value, depth, text);
  } else if (value.is_array()) {
    addLongList(value, depth, text);
  } else {
    addObject(value, depth, text);
  }
}

}  // namespace

std::string jsonText(const Json& json) {
  std::string text;
  add(json, 0, text);
  text += '\n';
  return text;
}

}  // namespace stiffscope
