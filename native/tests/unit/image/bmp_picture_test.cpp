// BMP pictures as programs of thirty years write them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "image/picture.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::bmp_picture_test {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kWidth = 5, kHeight = 3;

struct BmpCase {
  uint32_t header = 40;  // bytes
  int bits = 24;
  uint32_t compression = 0;
  std::vector<uint32_t> masks = {};  // red, green, blue, alpha
  bool top_first = false;
  uint32_t colors = 0;  // of the palette; 0: all
  size_t gap = 0;       // bytes between the palette and the pixels
};

void put(Bytes& to, uint64_t value, size_t bytes) {
  for (size_t i = 0; i < bytes; ++i) to.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

/// Pixel codes: their bits are random, but those of palettes lie within it.
uint32_t code_of(const BmpCase& c, int x, int y_from_top) {
  const auto mixed = static_cast<uint32_t>(x * 7919 + y_from_top * 104729 + 12345) * 2654435761u;
  if (c.bits <= 8) return (mixed >> 8) % (c.colors > 0 ? c.colors : 1u << c.bits);
  return c.bits == 32 ? mixed : mixed & ((1u << c.bits) - 1);
}

uint32_t palette_color(uint32_t code) { return (code * 40503u + 77u) & 0xffffffu; }  // 0xRRGGBB

Bytes rows_of(const BmpCase& c) {
  Bytes pixels;
  const size_t row_bytes = static_cast<size_t>((kWidth * c.bits + 31) / 32 * 4);
  for (int stored = 0; stored < kHeight; ++stored) {
    Bytes row(row_bytes, 0);
    for (int x = 0; x < kWidth; ++x) {
      const uint32_t code = code_of(c, x, c.top_first ? stored : kHeight - 1 - stored);
      const auto first = static_cast<size_t>(x * c.bits);
      if (c.bits <= 8) row[first / 8] |= static_cast<uint8_t>(code << (8 - static_cast<size_t>(c.bits) - first % 8));
      for (size_t i = 0; c.bits > 8 && i < static_cast<size_t>(c.bits) / 8; ++i) {
        row[first / 8 + i] = static_cast<uint8_t>(code >> (8 * i));
      }
    }
    pixels.insert(pixels.end(), row.begin(), row.end());
  }
  return pixels;
}

Bytes bytes_of(const BmpCase& c) {
  Bytes header;
  const bool is_short = c.header == 12;
  put(header, c.header, 4);
  put(header, kWidth, is_short ? 2 : 4);
  put(header, static_cast<uint64_t>(c.top_first ? -kHeight : kHeight), is_short ? 2 : 4);
  put(header, 1, 2);
  put(header, static_cast<uint64_t>(c.bits), 2);
  if (!is_short) {
    put(header, c.compression, 4);
    put(header, 0, 12);
    put(header, c.colors, 4);
    put(header, 0, 4);
    for (const uint32_t mask : c.masks) put(header, mask, 4);
  }
  header.resize(std::max<size_t>(header.size(), c.header));
  if (c.bits <= 8) {
    for (uint32_t i = 0; i < (c.colors > 0 ? c.colors : 1u << c.bits); ++i) {
      put(header, palette_color(i), is_short ? 3 : 4);
    }
  }
  header.resize(header.size() + c.gap, 0xab);
  Bytes file{'B', 'M', 0, 0, 0, 0, 0, 0, 0, 0};
  put(file, 14 + header.size(), 4);
  file.insert(file.end(), header.begin(), header.end());
  const Bytes pixels = rows_of(c);
  file.insert(file.end(), pixels.begin(), pixels.end());
  return file;
}

float share(uint32_t code, uint32_t mask) {
  uint64_t value = 0, largest = 0;
  for (int bit = 31; bit >= 0; --bit) {
    if ((mask >> bit & 1) == 0) continue;
    value = value << 1 | (code >> bit & 1);
    largest = largest << 1 | 1;
  }
  return static_cast<float>(static_cast<double>(value) / static_cast<double>(largest));
}

Picture read(const Bytes& bytes) {
  const std::string path = test::scratch_folder() / "picture.bmp";
  write_file(path, bytes);
  return read_picture(path, {.curve = {1.0f}});
}

std::string refusal(const Bytes& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "read";
}

/// `masks`: what the pixels are expected to mean.
void expect_read(const char* name, const BmpCase& c, const std::vector<uint32_t>& masks) {
  SCOPED_TRACE(name);
  const Picture picture = read(bytes_of(c));
  ASSERT_EQ(picture.width, kWidth);
  ASSERT_EQ(picture.height, kHeight);
  ASSERT_EQ(picture.channels, static_cast<int>(masks.size()));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const uint32_t code = code_of(c, x, kHeight - 1 - y), pixel = c.bits <= 8 ? palette_color(code) : code;
      for (size_t i = 0; i < masks.size(); ++i) {
        EXPECT_NEAR(picture.pixel(x, y)[i], share(pixel, masks[i]), 1e-6f) << x << ' ' << y << ' ' << i;
      }
    }
  }
}

const std::vector<uint32_t> kPlain{0xff0000, 0xff00, 0xff};

TEST(BmpPicture, EachKindIsRead) {
  expect_read("24 bits", {}, kPlain);
  expect_read("top row first", {.top_first = true}, kPlain);
  expect_read("32 bits", {.bits = 32}, kPlain);
  expect_read("16 bits", {.bits = 16}, {0x7c00, 0x3e0, 0x1f});
  expect_read("OS/2", {.header = 12}, kPlain);
  expect_read("OS/2 2", {.header = 64}, kPlain);
  expect_read("a gap", {.gap = 9}, kPlain);
  test::record_input("BMP", "16, 24 and 32 bits, headers of OS/2 and Windows, rows from either end", "read");
}

TEST(BmpPicture, PalettesAreRead) {
  for (const int bits : {1, 2, 4, 8}) {
    expect_read("Windows", {.bits = bits}, kPlain);
    expect_read("OS/2", {.header = 12, .bits = bits}, kPlain);
    if (bits > 1) expect_read("few colors", {.bits = bits, .colors = 3, .gap = 1}, kPlain);
  }
  test::record_input("BMP", "palettes of 1, 2, 4 and 8 bits, of OS/2, of fewer colors", "read");
}

TEST(BmpPicture, MasksSayWhereColorsAre) {
  const std::vector<uint32_t> swapped{0xff, 0xff00, 0xff0000}, wide{0x3ff00000, 0xffc00, 0x3ff};
  expect_read("565", {.bits = 16, .compression = 3, .masks = {0xf800, 0x7e0, 0x1f}}, {0xf800, 0x7e0, 0x1f});
  expect_read("swapped, behind the header", {.bits = 32, .compression = 3, .masks = swapped}, swapped);
  expect_read("ten bits", {.bits = 32, .compression = 3, .masks = wide}, wide);
  const std::vector<uint32_t> alpha{0xff, 0xff00, 0xff0000, 0xff000000};
  for (const uint32_t header : {56u, 108u, 124u}) {
    expect_read("alpha", {.header = header, .bits = 32, .compression = 3, .masks = alpha}, alpha);
  }
  expect_read("alpha, behind the header", {.bits = 32, .compression = 6, .masks = alpha}, alpha);
  test::record_input("BMP", "masks of colors, alpha", "read");
}

TEST(BmpPicture, WhatIsNotReadIsRefused) {
  EXPECT_NE(refusal(bytes_of({.bits = 8, .compression = 1})).find("compression 1 are not supported"),
            std::string::npos);
  EXPECT_NE(refusal(bytes_of({.bits = 3})).find("3 bits per pixel"), std::string::npos);
  EXPECT_NE(refusal(bytes_of({.header = 200})).find("a header of 200 bytes"), std::string::npos);
  const Bytes whole = bytes_of({.bits = 8});
  for (size_t size = 2; size < whole.size() - 4; size += 7) {
    const std::string said = refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_NE(said.find("picture.bmp"), std::string::npos) << size;
    EXPECT_NE(said, "read") << size;
  }
  for (size_t i = 14; i < 54; ++i) {  // no claim of a header is believed
    for (const uint8_t value : std::initializer_list<uint8_t>{0x00, 0x7f, 0x80, 0xff}) {
      Bytes damaged = whole;
      damaged[i] = value;
      refusal(damaged);
    }
  }
  test::record_input("BMP", "run lengths", "refused");
}

}  // namespace
}  // namespace velour::bmp_picture_test
