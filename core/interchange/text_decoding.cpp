#include "core/interchange/point_reading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iconv.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>

#include "core/io/input_error.h"
#include "core/io/xml.h"

namespace stiffscope::interchange {

namespace {

struct EncodingName {
  Encoding encoding;
  const char* name;  ///< iconv knows them by the same
};

constexpr std::array<EncodingName, 5> kEncodings{{{Encoding::utf8, "utf-8"},
                                                  {Encoding::utf16_le, "utf-16le"},
                                                  {Encoding::utf16_be, "utf-16be"},
                                                  {Encoding::cp1252, "cp1252"},
                                                  {Encoding::cp932, "cp932"}}};

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF", kLittleMark = "\xFF\xFE", kBigMark = "\xFE\xFF";

/// A conversion of iconv to UTF-8.
class Converter {
 public:
  explicit Converter(Encoding from) : handle_(::iconv_open("UTF-8", nameOf(from).c_str())) {
    if (handle_ == reinterpret_cast<iconv_t>(-1)) throw std::runtime_error("iconv knows no " + nameOf(from));
  }
  ~Converter() { ::iconv_close(handle_); }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  /// What the bytes stand for; `rest` is what is left of them from the first that stands for nothing.
  std::string converted(std::string_view bytes, std::string_view& rest) const {
    std::string text;
    std::array<char, 1 << 16> part{};
    char* in = const_cast<char*>(bytes.data());
    std::size_t in_left = bytes.size();
    while (in_left > 0) {
      char* out = part.data();
      std::size_t out_left = part.size();
      const std::size_t before = in_left;
      const bool full =
          ::iconv(handle_, &in, &in_left, &out, &out_left) == static_cast<std::size_t>(-1) && errno == E2BIG;
      text.append(part.data(), part.size() - out_left);
      if (!full || in_left == before) break;
    }
    rest = bytes.substr(bytes.size() - in_left);
    return text;
  }

 private:
  iconv_t handle_;
};

/// Zeros at all even or all odd places of what is ASCII text otherwise.
std::optional<Encoding> utf16WithoutMark(std::string_view bytes) {
  constexpr std::size_t kLook = 4096;
  std::array<std::size_t, 2> zeros{};
  const std::size_t looked = std::min(bytes.size(), kLook);
  for (std::size_t i = 0; i < looked; ++i) zeros[i % 2] += bytes[i] == '\0' ? 1 : 0;
  const std::size_t most = looked / 2, many = most - most / 4;
  if (most == 0) return std::nullopt;
  if (zeros[1] >= many && zeros[0] == 0) return Encoding::utf16_le;
  if (zeros[0] >= many && zeros[1] == 0) return Encoding::utf16_be;
  return std::nullopt;
}

/// Place of the first character beyond ASCII that is UTF-8; npos where there is none.
std::size_t findUtf8Character(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if ((bytes[i] & 0x80) == 0) continue;
    const auto lead = static_cast<unsigned char>(bytes[i]);
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (i + length <= bytes.size() && io::findNotUtf8(bytes.substr(i, length)) == std::string_view::npos) return i;
  }
  return std::string_view::npos;
}

[[noreturn]] void refuse(const std::string& file, std::string_view bytes, std::size_t at, const std::string& why) {
  throw io::InputError({file, io::lineOf(bytes, at), ""},
                       fmt::format("byte 0x{:02X}", static_cast<unsigned char>(bytes[at])), why);
}

/// What the bytes show; nullopt: they are no UTF-8, nor marked as anything.
std::optional<Encoding> shownEncoding(std::string_view bytes) {
  if (bytes.starts_with(kUtf8Mark)) return Encoding::utf8;
  if (bytes.starts_with(kLittleMark)) return Encoding::utf16_le;
  if (bytes.starts_with(kBigMark)) return Encoding::utf16_be;
  if (const auto found = utf16WithoutMark(bytes)) return found;
  return io::findNotUtf8(bytes) == std::string_view::npos ? std::optional(Encoding::utf8) : std::nullopt;
}

/// Bytes that CP1252 has no character for start characters of CP932, among them its punctuation and most signs.
bool isJapanese(std::string_view bytes) {
  constexpr std::string_view kNotWestern = "\x81\x8D\x8F\x90\x9D";
  if (bytes.find_first_of(kNotWestern) == std::string_view::npos) return false;
  std::string_view rest;
  Converter(Encoding::cp932).converted(bytes, rest);
  return rest.empty();
}

Encoding encodingOf(const std::string& file, std::string_view bytes, std::optional<Encoding> wanted) {
  const std::optional<Encoding> shown = shownEncoding(bytes);
  const std::size_t utf8_at = findUtf8Character(bytes), other_at = io::findNotUtf8(bytes);
  // ASCII alone is the same in UTF-8 and the code pages.
  const bool plain = shown == Encoding::utf8 && utf8_at == std::string_view::npos;
  const bool bytewise = wanted == Encoding::cp1252 || wanted == Encoding::cp932;
  if (wanted && shown && *wanted != *shown && !(plain && bytewise)) {
    throw io::InputError({file, 0, "encoding"}, nameOf(*wanted),
                         fmt::format("expected {}, which the bytes of this file show", nameOf(*shown)));
  }
  if (wanted == Encoding::utf8 && !shown)
    refuse(file, bytes, other_at, "expected UTF-8; this byte is none of it, the file may be cp1252");
  if (wanted && (*wanted == Encoding::utf16_le || *wanted == Encoding::utf16_be) && !shown)
    refuse(file, bytes, other_at, "expected UTF-16, which has a byte-order mark or a zero in every second byte");
  // Pairs of Japanese bytes may look like characters of UTF-8.
  if (!shown && (!wanted || wanted == Encoding::cp932) && isJapanese(bytes)) return Encoding::cp932;
  if (!shown && utf8_at != std::string_view::npos) {
    refuse(file, bytes, other_at,
           fmt::format("expected one encoding; this byte is no UTF-8, and line {} has a character of it: two files put "
                       "together?",
                       io::lineOf(bytes, utf8_at)));
  }
  if (wanted) return *wanted;
  return shown ? *shown : Encoding::cp1252;
}

std::string_view withoutMark(std::string_view bytes) {
  for (const std::string_view mark : {kUtf8Mark, kLittleMark, kBigMark}) {
    if (bytes.starts_with(mark)) return bytes.substr(mark.size());
  }
  return bytes;
}

}  // namespace

const std::vector<std::string>& encodingNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const EncodingName& one : kEncodings) all.emplace_back(one.name);
    return all;
  }();
  return names;
}

std::string nameOf(Encoding encoding) { return kEncodings[static_cast<std::size_t>(encoding)].name; }

Encoding encodingNamed(const std::string& name, const std::string& option) {
  for (const EncodingName& one : kEncodings) {
    if (name == one.name) return one.encoding;
  }
  throw io::InputError(
      {option}, name,
      fmt::format("expected {}{}", fmt::join(encodingNames(), ", "), io::nearestNameHint(name, encodingNames())));
}

DecodedText decodeText(const std::string& file, std::string_view bytes, std::optional<Encoding> wanted) {
  DecodedText decoded;
  decoded.encoding = encodingOf(file, bytes, wanted);
  decoded.own = withoutMark(bytes);
  if (decoded.encoding != Encoding::utf8) {
    std::string_view rest;
    decoded.converted = Converter(decoded.encoding).converted(decoded.own, rest);
    if (!rest.empty()) {
      throw io::InputError({file, io::lineOf(decoded.converted, decoded.converted.size()), ""},
                           fmt::format("byte 0x{:02X}", static_cast<unsigned char>(rest.front())),
                           fmt::format("expected {}; nothing is written so there", nameOf(decoded.encoding)));
    }
  }
  const std::size_t zero = decoded.text().find('\0');
  if (zero != std::string_view::npos)
    throw io::InputError({file, io::lineOf(decoded.text(), zero), ""}, "", "expected text; this file holds a byte 0");
  return decoded;
}

}  // namespace stiffscope::interchange
