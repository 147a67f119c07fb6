#include "image/picture.h"

#include <fstream>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "support/inputs.h"
#include "support/picture_bytes.h"
#include "support/test_data.h"

namespace velour::picture_test {
namespace {

Picture gradient(int width, int height, int channels) {
  Picture picture{width, height, channels, {}};
  const int count = width * height * channels;
  for (int i = 0; i < count; ++i) picture.pixels.push_back(static_cast<float>(i) / static_cast<float>(count - 1));
  return picture;
}

std::string refusal(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Picture, ExrKeepsFloats) {
  const std::string path = test::scratch_folder() / "a.exr";
  Picture picture = gradient(7, 5, 3);
  picture.pixels[4] = 1e20f;
  picture.pixels[5] = -2.5f;
  write_picture(path, picture);
  const Picture back = read_picture(path);
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.channels, 3);
  EXPECT_EQ(back.pixels, picture.pixels);
  EXPECT_TRUE(read_picture_header(path).pixels.empty());
  EXPECT_EQ(read_picture_header(path).width, 7);
}

TEST(Picture, ExrKeepsTheOrderOfChannels) {
  const std::string path = test::scratch_folder() / "a.exr";
  for (int channels = 1; channels <= 6; ++channels) {
    write_picture(path, gradient(4, 3, channels));
    EXPECT_EQ(read_picture_channels(path).pixels, gradient(4, 3, channels).pixels) << channels;
    if (channels <= 4) {
      EXPECT_EQ(read_picture(path).pixels, gradient(4, 3, channels).pixels) << channels;
    }
  }
}

TEST(Picture, SamePictureSameBytes) {
  const auto folder = test::scratch_folder();
  write_picture(folder / "a.exr", gradient(16, 16, 4));
  write_picture(folder / "b.exr", gradient(16, 16, 4));
  EXPECT_EQ(read_file(folder / "a.exr"), read_file(folder / "b.exr"));
}

TEST(Picture, PngIsSrgbAndRowZeroIsAtTheBottom) {
  const std::string path = test::scratch_folder() / "a.png";
  Picture picture{1, 2, 3, {0.5f, 0.0f, 1.0f, 0.2140411f, NAN, 7.0f}};
  write_picture(path, picture);
  const auto bytes = read_file(path);
  const Picture back = read_picture(path);
  EXPECT_NEAR(back.pixel(0, 0)[0], 0.5f, 0.004f);
  EXPECT_NEAR(back.pixel(0, 1)[0], 0.2140411f, 0.003f);
  EXPECT_EQ(back.pixel(0, 1)[1], 0.0f);  // not a number
  EXPECT_EQ(back.pixel(0, 1)[2], 1.0f);  // above white
}

TEST(Picture, AlphaStaysLinear) {
  const std::string path = test::scratch_folder() / "a.png";
  write_picture(path, {1, 1, 4, {0.5f, 0.5f, 0.5f, 0.5f}});
  const Picture back = read_picture(path);
  EXPECT_NEAR(back.pixels[0], 0.5f, 0.004f);
  EXPECT_NEAR(back.pixels[3], 0.5f, 0.002f);
}

TEST(Picture, WritesOnlyExrAndPng) {
  const auto folder = test::scratch_folder();
  EXPECT_NE(refusal([&] { write_picture(folder / "a.gif", gradient(2, 2, 3)); }).find("a.gif"), std::string::npos);
  EXPECT_NE(refusal([&] { write_picture(folder / "a.exr", Picture{2, 2, 3, {1.0f}}); }), "");
}

TEST(Picture, RefusesDamage) {
  const auto folder = test::scratch_folder();
  std::vector<const char*> names{"a.exr"};
#ifndef __SANITIZE_ADDRESS__  // libpng leaves OpenImageIO's frames by longjmp, which leaks a string: not ours to mend
  names.push_back("a.png");
#endif
  for (const char* name : names) {
    write_picture(folder / name, gradient(20, 20, 3));
    const auto bytes = read_file(folder / name);
    for (size_t size = 0; size < bytes.size() * 3 / 4; size += 41) {
      write_file(folder / name, std::span(bytes).first(size));
      EXPECT_NE(refusal([&] { read_picture(folder / name); }).find(name), std::string::npos) << size;
    }
  }
  EXPECT_NE(refusal([&] { read_picture(folder / "missing.exr"); }).find("missing.exr"), std::string::npos);
}

TEST(Picture, LyingSizeIsNotAllocated) {
  const std::string path = test::scratch_folder() / "a.hdr";
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n";
  write_file(path, std::vector<uint8_t>(header.begin(), header.end()));
  EXPECT_NE(refusal([&] { read_picture(path); }).find("60000 x 60000"), std::string::npos);
  const std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000 +X 6000\n" + std::string(4096, 'x');
  write_file(path, std::vector<uint8_t>(bytes.begin(), bytes.end()));
  EXPECT_NE(refusal([&] { read_picture(path); }).find("more than the file can contain"), std::string::npos);
}

/// Checksum of a PNG chunk: of its type and data.
uint32_t png_checksum(std::span<const uint8_t> bytes) {
  uint32_t crc = ~0u;
  for (const uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// Eight bits a value bound a picture more tightly than one.
TEST(Picture, LyingPngsAreNotAllocated) {
  constexpr size_t kTypeAt = 12, kSizeAt = 16, kChecksumAt = 29;  // of the chunk of the header
  const std::string path = test::scratch_folder() / "lying.png";
  write_picture(path, gradient(8, 8, 3));
  std::vector<uint8_t> bytes = read_file(path);
  const auto put = [&](size_t at, uint32_t value) {
    for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<uint8_t>(value >> (24 - 8 * i));
  };
  put(kSizeAt, 1000);
  put(kSizeAt + 4, static_cast<uint32_t>(bytes.size()));  // 3000 values a byte
  put(kChecksumAt, png_checksum(std::span(bytes).subspan(kTypeAt, kChecksumAt - kTypeAt)));
  write_file(path, bytes);
  const std::string complaint = refusal([&] { read_picture(path); });
  EXPECT_NE(complaint.find("more than the file can contain"), std::string::npos) << complaint;
}

/// OpenEXR itself would make a table of a gigabyte for them.
TEST(Picture, RowsThatAnExrClaimsAreNotAllocated) {
  const std::string path = test::scratch_folder() / "tall.exr";
  write_picture(path, gradient(4, 4, 3));
  std::vector<uint8_t> bytes = read_file(path);
  const std::string name = "dataWindow";
  const auto at = std::ranges::search(bytes, name).begin();
  ASSERT_NE(at, bytes.end());
  const auto most_y = at + static_cast<std::ptrdiff_t>(name.size() + 1 + std::string("box2i").size() + 1 + 4 + 12);
  ASSERT_EQ(*most_y, 3);
  most_y[3] = 0x3f;
  write_file(path, bytes);
  const std::string complaint = refusal([&] { read_picture_header(path); });
  EXPECT_NE(complaint.find("4 x 1056964612 pixels, more than the file can contain"), std::string::npos) << complaint;
}

TEST(Picture, RefusalsAreOneLine) {
  const std::string path = test::scratch_folder() / "cut.png";
  write_picture(path, gradient(8, 8, 3));
  const std::vector<uint8_t> bytes = read_file(path);
  int refused = 0;
  for (size_t size = 9; size < bytes.size(); size += 5) {
    write_file(path, std::span(bytes).first(size));
    const std::string complaint = refusal([&] { read_picture(path); });
    EXPECT_TRUE(complaint.empty() || complaint.starts_with(path));  // its last words are not missed
    refused += !complaint.empty();
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
  }
  EXPECT_GT(refused, 5);
}

/// 16 x 8 gray pixels made by libjpeg: the upper half 200, the lower 40 of 255.
const std::vector<uint8_t> kJpeg = [] {
  const std::string_view digits =
      "ffd8ffdb0043000201010101010201010102020202020403020202020504040304060506060605060606070908060709070606080b08090a"
      "0a"
      "0a0a0a06080b0c0b0a0c090a0a0affc0000b080008001001011100ffc4001500010100000000000000000000000000000006ffc400181000"
      "02"
      "0300000000000000000000000000001a68a7e5ffda0008010100003f009f6448676267864486762679ffd9";
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < digits.size(); i += 2)
    bytes.push_back(static_cast<uint8_t>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
  return bytes;
}();

TEST(Picture, ReadsJpeg) {
  const std::string path = test::scratch_folder() / "a.jpg";
  write_file(path, kJpeg);
  const Picture picture = read_picture(path, {.curve = {1.0f}});
  ASSERT_EQ(picture.channels, 1);
  ASSERT_EQ(picture.pixels.size(), 128u);
  EXPECT_NEAR(picture.pixel(3, 7)[0], 200.0f / 255.0f, 1.5f / 255.0f);
  EXPECT_NEAR(picture.pixel(12, 0)[0], 40.0f / 255.0f, 1.5f / 255.0f);
}

TEST(Picture, RefusesJpegThatEndsEarly) {
  const std::string path = test::scratch_folder() / "cut.jpg";
  for (size_t size = 1; size + 2 < kJpeg.size(); size += 3) {
    write_file(path, std::span(kJpeg).first(size));
    EXPECT_NE(refusal([&] { read_picture(path); }).find("cut.jpg"), std::string::npos) << size;
  }
}

TEST(Picture, ReadsRadianceHdr) {
  VELOUR_NEED_DATA(path, "hdr/studio_small_03_1k.hdr");
  const Picture picture = read_picture(path);
  EXPECT_EQ(picture.width, 1024);
  EXPECT_EQ(picture.height, 512);
  EXPECT_EQ(picture.channels, 3);
  const float brightest = *std::max_element(picture.pixels.begin(), picture.pixels.end());
  EXPECT_GT(brightest, 10.0f);
}

TEST(PictureDifference, KnownValues) {
  const float a[] = {1.0f, 2.0f, 3.0f, 0.0f}, b[] = {1.0f, 1.0f, 1.0f, 9.0f};
  const auto difference = compare_pictures(a, b, 1, 4);  // the fourth channel does not count
  EXPECT_NEAR(difference.rmse, std::sqrt(5.0 / 3.0), 1e-12);
  EXPECT_NEAR(difference.relmse, 5.0 / 3.0 / 1.01, 1e-12);
  const auto same = compare_pictures(a, a, 1, 4);
  EXPECT_EQ(same.rmse, 0.0);
  EXPECT_EQ(same.relmse, 0.0);
}

TEST(Picture, APngThatPromisesMoreThanItHasIsRefused) {
  const std::string path = test::scratch_folder() / "a.png";
  for (const char* chunk : {"tEXt", "IDAT"}) {
    write_picture(path, gradient(4, 3, 3));
    std::vector<uint8_t> bytes = read_file(path);
    const uint8_t length[] = {0x6f, 0, 0, 0};
    const auto after_header = std::ranges::copy(length, bytes.begin() + 8 + 12 + 13).out;
    std::copy_n(chunk, 4, after_header);
    for (const size_t left : {bytes.size(), size_t{33 + 8}}) {  // the file may end within the chunk's head
      write_file(path, std::span(bytes).first(left));
      const std::string said = refusal([&] { read_picture(path); });
      EXPECT_NE(said.find("the chunk at byte 33 has a length of 1862270976 bytes"), std::string::npos) << said;
    }
  }
}

TEST(Picture, ApplePngsAreRefusedByName) {
  test::record_input("PNG", "Apple-optimized (CgBI)", "refused by name");
  const std::string path = test::scratch_folder() / "a.png";
  write_picture(path, gradient(4, 3, 3));
  const test::Bytes png = read_file(path), behind = test::with_chunk(png, "CgBI", {0x50, 0, 0x20, 2});
  test::Bytes before(png.begin(), png.begin() + 8);
  constexpr std::ptrdiff_t kHeaderEnd = 8 + 12 + 13, kChunkEnd = kHeaderEnd + 12 + 4;
  before.insert(before.end(), behind.begin() + kHeaderEnd, behind.begin() + kChunkEnd);
  before.insert(before.end(), png.begin() + 8, png.end());
  for (const test::Bytes& bytes : {before, behind}) {
    write_file(path, bytes);
    EXPECT_EQ(refusal([&] { read_picture(path); }), path + ": is an Apple-optimized PNG; save it again as a PNG.");
  }
}

}  // namespace
}  // namespace velour::picture_test
