#include "core/io/csv.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/io/input_error.h"

namespace stiffscope::io {

namespace {

constexpr bool isBlank(char c) { return c == ' ' || c == '\t'; }

const char* endOf(std::string_view text) { return text.data() + text.size(); }

const char* find(const char* begin, const char* end, char wanted) {
  const void* found = begin == end ? nullptr : std::memchr(begin, wanted, static_cast<std::size_t>(end - begin));
  return found == nullptr ? end : static_cast<const char*>(found);
}

void skipBlanks(std::string_view& text) {
  std::size_t blanks = 0;
  while (blanks < text.size() && isBlank(text[blanks])) ++blanks;
  text.remove_prefix(blanks);
}

// Cells have some ten bytes, where a plain loop is quicker than a call of memchr.
std::string_view plainCell(std::string_view& line) {
  std::size_t size = 0;
  while (size < line.size() && line[size] != ',') ++size;
  std::string_view cell = line.substr(0, size);
  line.remove_prefix(size);
  while (!cell.empty() && isBlank(cell.back())) cell.remove_suffix(1);
  return cell;
}

/// The cell without the blanks around it.
std::string_view trimmed(const char* begin, const char* end) {
  const auto beyondBlank = [](char c) { return static_cast<unsigned char>(c) > ' '; };
  if (begin != end && beyondBlank(*begin) && beyondBlank(end[-1]))
    return {begin, static_cast<std::size_t>(end - begin)};
  while (begin != end && isBlank(*begin)) ++begin;
  while (begin != end && isBlank(end[-1])) --end;
  return {begin, static_cast<std::size_t>(end - begin)};
}

/// In blocks that one byte can count: compilers turn such a sum into many at once, and a sum of larger numbers into
/// few.
std::size_t countOf(std::string_view bytes, char wanted) {
  constexpr std::size_t kBlock = 240;
  std::size_t count = 0;
  while (!bytes.empty()) {
    unsigned char in_block = 0;
    for (const char c : bytes.substr(0, kBlock)) in_block = static_cast<unsigned char>(in_block + (c == wanted));
    count += in_block;
    bytes.remove_prefix(std::min(kBlock, bytes.size()));
  }
  return count;
}

}  // namespace

std::size_t linesIn(std::string_view bytes) {
  std::size_t ends = countOf(bytes, '\n');
  for (auto at = bytes.find('\r'); at != std::string_view::npos; at = bytes.find('\r', at + 1)) {
    if (at + 1 == bytes.size() || bytes[at + 1] != '\n') ++ends;
  }
  const bool last_has_no_end = !bytes.empty() && bytes.back() != '\n' && bytes.back() != '\r';
  return ends + (last_has_no_end ? 1 : 0);
}

std::vector<std::string_view> partsOfLines(std::string_view bytes, std::size_t least) {
  std::vector<std::string_view> parts;
  while (!bytes.empty()) {
    const std::size_t last = bytes.find('\n', std::max<std::size_t>(least, 1) - 1);
    parts.push_back(bytes.substr(0, last == std::string_view::npos ? last : last + 1));
    bytes.remove_prefix(parts.back().size());
  }
  return parts;
}

CsvLines::CsvLines(std::string file, std::string_view bytes, std::size_t lines_before)
    : file_(std::move(file)), rest_(bytes), line_(lines_before), marks_(bytes) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (lines_before == 0 && rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  marks_.seek(rest_.data());
  next_lf_ = find(rest_.data(), endOf(rest_), '\n');
}

// Most lines have no quote, an end, and as many cells as the line before, whose places theirs take.
bool CsvLines::nextPlain(std::vector<std::string_view>& cells) {
  const char* const end = endOf(rest_);
  CsvMarks marks = marks_;  // here it stays in registers
  std::size_t count = 0;
  const auto add = [&](const char* begin, const char* mark) {
    if (count < kMostKept) {
      if (count == cells.size()) cells.emplace_back();
      cells[count] = trimmed(begin, mark);
    }
    ++count;
  };
  for (const char* begin = rest_.data();;) {
    const char* const mark = marks.next();
    if (mark == end || *mark == '"') return false;
    if (*mark == ',') {
      add(begin, mark);
      begin = mark + 1;
      continue;
    }
    if (*mark != '\n' && *mark != '\r') continue;
    add(begin, mark);
    begin = mark + 1;
    if (*mark == '\r' && begin != end && *begin == '\n') begin = marks.next() + 1;
    rest_ = {begin, static_cast<std::size_t>(end - begin)};
    marks_ = marks;
    ++line_;
    line_ended_ = true;
    if (count > 1 || !cells.front().empty()) break;
    count = 0;  // a blank line
  }
  cells.resize(std::min(count, kMostKept));
  cell_count_ = count;
  return true;
}

bool CsvLines::nextLine(std::string_view& line) {
  if (rest_.empty()) return false;
  const char* const begin = rest_.data();
  const char* const end = endOf(rest_);
  if (next_lf_ < begin) next_lf_ = find(begin, end, '\n');
  const char* const line_end = find(begin, next_lf_, '\r');
  line = {begin, static_cast<std::size_t>(line_end - begin)};
  line_ended_ = line_end != end;
  const bool crlf = line_ended_ && *line_end == '\r' && line_end + 1 != end && line_end[1] == '\n';
  rest_.remove_prefix(line.size() + (crlf ? 2 : line_ended_ ? 1 : 0));
  ++line_;
  return true;
}

std::string_view CsvLines::quotedCell(std::string_view& line) {
  line.remove_prefix(1);
  bool doubled = false;
  std::size_t size = 0;
  for (;;) {
    size = line.find('"', size);
    if (size == std::string_view::npos) {
      throw InputError({file_, line_, ""}, "\"", "expected a closing quote on the same line");
    }
    if (size + 1 == line.size() || line[size + 1] != '"') break;
    doubled = true;
    size += 2;
  }
  std::string_view cell = line.substr(0, size);
  line.remove_prefix(size + 1);
  skipBlanks(line);
  if (!line.empty() && line.front() != ',') {
    throw InputError({file_, line_, ""}, std::string(line.substr(0, line.find(','))),
                     "expected a comma, or the end of the line, after a closing quote");
  }
  if (!doubled) return cell;
  std::string& text = unescaped_.emplace_back();
  for (std::size_t i = 0; i < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"') ++i;
  }
  return text;
}

bool CsvLines::next(std::vector<std::string_view>& cells) {
  if (!unescaped_.empty()) unescaped_.clear();
  if (nextPlain(cells)) return true;
  cells.clear();
  std::string_view line;
  do {
    if (!nextLine(line)) return false;
    skipBlanks(line);
  } while (line.empty());
  for (cell_count_ = 1;; ++cell_count_) {
    skipBlanks(line);
    const std::string_view cell = !line.empty() && line.front() == '"' ? quotedCell(line) : plainCell(line);
    if (cells.size() < kMostKept) cells.push_back(cell);
    if (unescaped_.size() > kMostKept) unescaped_.pop_back();
    if (line.empty()) break;
    line.remove_prefix(1);
  }
  marks_.seek(rest_.data());
  return true;
}

namespace {

constexpr std::size_t kBlock = 64;

/// The lowest bits of eight bytes as one byte, the first byte's as the lowest.
std::uint64_t bitsOf(const unsigned char* flags) {
  std::uint64_t bits = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags, sizeof eight);
    bits = (eight * 0x0102040810204080ull) >> 56;  // each factor brings one byte's bit to its place at the top
  } else {
    for (std::size_t i = 0; i < 8; ++i) bits |= std::uint64_t{flags[i]} << i;
  }
  return bits;
}

/// Bit i: whether block[i] is no more than a comma. One comparison, which compilers make for many bytes at
/// once.
std::uint64_t marksIn(const char* block) {
  std::array<unsigned char, kBlock> flags;
  for (std::size_t i = 0; i < kBlock; ++i) flags[i] = static_cast<unsigned char>(block[i]) <= ',' ? 1 : 0;
  std::uint64_t marks = 0;
  for (std::size_t i = 0; i < kBlock; i += 8) marks |= bitsOf(flags.data() + i) << i;
  return marks;
}

}  // namespace

std::uint64_t CsvMarks::marksOfBlock(const char* block, const char* end) {
  const auto left = static_cast<std::size_t>(end - block);
  if (left >= kBlock) return marksIn(block);
  std::array<char, kBlock> last;
  last.fill('0');
  if (left > 0) std::memcpy(last.data(), block, left);
  return marksIn(last.data());
}

}  // namespace stiffscope::io
