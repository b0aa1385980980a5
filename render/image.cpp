#include "render/image.h"

#include <libdeflate.h>
#include <png.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace stiffscope::render {

namespace {

void append(png_structp png, png_bytep data, png_size_t length) {
  auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes->insert(bytes->end(), data, data + length);
}

// libpng must not return from its error handler; an exception unwinds through it as well as its longjmp
// would.
void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(fmt::format("cannot encode PNG: {}", message));
}

struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

/// A picture of few colours: an index a pixel.
struct Palettised {
  std::vector<png_color> palette;
  std::vector<std::uint8_t> indices;
};

constexpr unsigned kCells = 1u << 18;  // colours to six bits a channel

unsigned cellOf(const std::uint8_t* rgb) {
  return static_cast<unsigned>(rgb[0] >> 2) << 12 | static_cast<unsigned>(rgb[1] >> 2) << 6 | rgb[2] >> 2;
}

/// Colours that are near each other, by the one that came first; that of a flat area is its own.
struct Cell {
  png_color colour{};
  std::uint32_t pixels = 0;
};

double distance(const png_color& a, const png_color& b) {
  const int red = a.red - b.red, green = a.green - b.green, blue = a.blue - b.blue;
  return std::sqrt(static_cast<double>(red * red + green * green + blue * blue));
}

/// Half of the palette are the most frequent colours; the other half, one by one, those that are farthest from all
/// chosen ones, frequent ones first.
std::vector<png_color> chosenColours(std::vector<Cell> cells) {
  constexpr std::size_t kMost = 256;
  std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.pixels > b.pixels; });
  const std::size_t frequent = cells.size() <= kMost ? cells.size() : kMost / 2;
  std::vector<png_color> palette;
  for (std::size_t i = 0; i < frequent; ++i) palette.push_back(cells[i].colour);
  std::vector<double> away(cells.size(), 0.0);
  for (std::size_t i = frequent; i < cells.size(); ++i) {
    away[i] = distance(cells[i].colour, palette.front());
    for (const png_color& one : palette) away[i] = std::min(away[i], distance(cells[i].colour, one));
  }
  while (palette.size() < std::min(kMost, cells.size())) {
    std::size_t best = frequent;
    double most = -1.0;
    for (std::size_t i = frequent; i < cells.size(); ++i) {
      const double gain = away[i] * std::sqrt(static_cast<double>(cells[i].pixels));
      if (gain > most) best = i, most = gain;
    }
    palette.push_back(cells[best].colour);
    for (std::size_t i = frequent; i < cells.size(); ++i)
      away[i] = std::min(away[i], distance(cells[i].colour, palette.back()));
  }
  return palette;
}

/// Pixels of one colour, one after the other: pictures are drawn in flat colours.
struct Run {
  std::size_t end = 0;  ///< of the pixels
  unsigned cell = 0;
};

std::vector<Run> runsOf(const Image& image) {
  constexpr std::size_t kBlock = 24;  // bytes compared at once
  const std::uint8_t *begin = image.rgb.data(), *end = begin + image.rgb.size();
  std::vector<Run> runs;
  for (const std::uint8_t* at = begin; at < end;) {
    const std::uint8_t* next = at + 3;
    while (end - next >= static_cast<std::ptrdiff_t>(kBlock) && std::memcmp(next - 3, next, kBlock) == 0)
      next += kBlock;
    while (next < end && std::memcmp(at, next, 3) == 0) next += 3;
    runs.push_back({static_cast<std::size_t>(next - begin) / 3, cellOf(at)});
    at = next;
  }
  return runs;
}

Palettised palettisedOf(const Image& image) {
  const std::vector<Run> runs = runsOf(image);
  std::vector<Cell> all(kCells);
  std::size_t from = 0;
  for (const Run& run : runs) {
    Cell& cell = all[run.cell];
    const std::uint8_t* at = &image.rgb[3 * from];
    if (cell.pixels == 0) cell.colour = {at[0], at[1], at[2]};
    cell.pixels += static_cast<std::uint32_t>(run.end - from);
    from = run.end;
  }
  std::vector<Cell> cells;
  std::vector<unsigned> keys;
  for (unsigned key = 0; key < kCells; ++key) {
    if (all[key].pixels == 0) continue;
    cells.push_back(all[key]);
    keys.push_back(key);
  }
  Palettised result{chosenColours(cells), std::vector<std::uint8_t>(image.rgb.size() / 3)};
  std::vector<std::uint8_t> nearest(kCells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto best =
        std::min_element(result.palette.begin(), result.palette.end(), [&](const png_color& a, const png_color& b) {
          return distance(a, cells[i].colour) < distance(b, cells[i].colour);
        });
    nearest[keys[i]] = static_cast<std::uint8_t>(best - result.palette.begin());
  }
  auto at = result.indices.begin();
  for (const Run& run : runs) {
    const auto end = result.indices.begin() + static_cast<std::ptrdiff_t>(run.end);
    std::fill(at, end, nearest[run.cell]);
    at = end;
  }
  return result;
}

/// As zlib has it, by libdeflate: half its time or less, for it has the whole picture at once.
std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  constexpr int kLevel = 6;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  if (!compressor) throw std::runtime_error("cannot encode PNG: libdeflate did not start");
  std::vector<std::uint8_t> out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
  return out;
}

/// Rows of `depth` bytes a pixel; with a palette where that is not empty.
std::vector<std::uint8_t> encoded(const Image& image, const std::uint8_t* rows, std::size_t depth,
                                  const std::vector<png_color>& palette) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  Writer writer;
  if (writer.info == nullptr) throw std::runtime_error("cannot encode PNG: libpng did not start");

  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.rgb.size() / 16);
  png_set_write_fn(writer.png, &bytes, append, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               palette.empty() ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(writer.png, writer.info, palette.data(), static_cast<int>(palette.size()));
  png_write_info(writer.png, writer.info);
  // Flat colours compress best unfiltered, and soonest: before each row stands a zero.
  std::vector<std::uint8_t> unfiltered(height * (depth * width + 1));
  for (std::size_t y = 0; y < height; ++y)
    std::copy_n(rows + depth * width * y, depth * width, &unfiltered[y * (depth * width + 1) + 1]);
  const std::vector<std::uint8_t> data = deflated(unfiltered);
  const auto chunk = [&](const char* name, const std::uint8_t* begin, std::size_t length) {
    png_write_chunk(writer.png, reinterpret_cast<png_const_bytep>(name), begin, length);
  };
  chunk("IDAT", data.data(), data.size());
  chunk("IEND", nullptr, 0);
  return bytes;
}

void requireWhole(const Image& image) {
  const auto pixels =
      static_cast<std::size_t>(std::max(image.width, 0)) * static_cast<std::size_t>(std::max(image.height, 0));
  if (pixels == 0 || image.rgb.size() != 3 * pixels) {
    throw std::invalid_argument(fmt::format("image of {} x {} pixels has {} bytes, expected 3 a pixel", image.width,
                                            image.height, image.rgb.size()));
  }
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Image& image) {
  requireWhole(image);
  return encoded(image, image.rgb.data(), 3, {});
}

std::vector<std::uint8_t> encodeSmallPng(const Image& image) {
  requireWhole(image);
  const Palettised few = palettisedOf(image);
  return encoded(image, few.indices.data(), 1, few.palette);
}

}  // namespace stiffscope::render
