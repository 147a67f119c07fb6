// Parts of pictures as OpenEXR files: where they lie, and what their headers say.
#include "image/formats/exr_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "image/formats/exr_header_check.h"
#include "support/test_data.h"

namespace velour::exr_part_test {
namespace {

Picture numbered(int width, int height, int channels) {
  Picture picture{width, height, channels, {}};
  for (int i = 0; i < width * height * channels; ++i) picture.pixels.push_back(static_cast<float>(i) / 3.0f);
  return picture;
}

TEST(ExrPart, KeepsPlaceTextsAndPixels) {
  const std::string path = test::scratch_folder() / "part.exr";
  const Picture part = numbered(3, 2, 4);
  const PictureFrame frame{10, 8, 4, 1};
  const PictureTexts texts = {{"velour.samples", "0:8"}, {"velour.words", "R\xc3\xb6hre \"x\"\n"}};
  write_exr_part(path, part, frame, texts);
  const ExrHeader header = read_exr_header(path);
  EXPECT_EQ(header.frame, frame);
  EXPECT_EQ(header.texts, texts);
  EXPECT_EQ(header.width, 3);
  EXPECT_EQ(header.height, 2);
  EXPECT_EQ(header.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_FALSE(header.multi_part);
  EXPECT_EQ(read_picture_channels(path).pixels, part.pixels);
  EXPECT_EQ(read_picture_text(path, "velour.samples"), "0:8");
}

/// The four numbers of a window of the file's header, which OpenEXR counts from the top.
std::array<int32_t, 4> window_in(const std::string& path, const std::string& name) {
  const auto bytes = read_file(path);
  const std::string text(bytes.begin(), bytes.end()), field = name + std::string("\0box2i\0\x10\0\0\0", 11);
  std::array<int32_t, 4> window{};
  const size_t at = text.find(field);
  EXPECT_NE(at, std::string::npos);
  std::memcpy(window.data(), text.data() + at + field.size(), sizeof window);
  return window;
}

TEST(ExrPart, WindowsAreOpenExrs) {
  const std::string path = test::scratch_folder() / "part.exr";
  write_exr_part(path, numbered(3, 2, 1), {10, 8, 4, 1}, {});
  EXPECT_EQ(window_in(path, "displayWindow"), (std::array<int32_t, 4>{0, 0, 9, 7}));
  EXPECT_EQ(window_in(path, "dataWindow"), (std::array<int32_t, 4>{4, 5, 6, 6}));  // rows 1 and 2 of 8 from below
}

TEST(ExrPart, SumsOfAllPassesAreReadAgain) {
  const std::string path = test::scratch_folder() / "part.exr";
  constexpr int kAllPasses = 159;  // with three Cryptomattes of 16 ranks
  const Picture part = numbered(3, 2, kAllPasses);
  write_exr_part(path, part, {3, 2, 0, 0}, {});
  EXPECT_EQ(read_picture_channels(path).pixels, part.pixels);
  write_exr_part(path, numbered(3, 2, kMaxPictureChannels), {3, 2, 0, 0}, {});
  EXPECT_EQ(read_picture_channels_header(path).channels, kMaxPictureChannels);
}

/// 8K frames with many passes. The file's size bounds what is allocated.
TEST(ExrPart, ValuesAreBoundedByTheFileAlone) {
  const std::string path = test::scratch_folder() / "large.exr";
  write_exr_part(path, numbered(4, 1024, 17), {4, 1024, 0, 0}, {});
  std::vector<uint8_t> bytes = read_file(path);
  const std::string field = "dataWindow" + std::string("\0box2i\0\x10\0\0\0", 11);
  const auto window = std::ranges::search(bytes, field).end();
  const auto right = window + 2 * sizeof(int32_t);
  ASSERT_EQ(*right, 3);
  right[0] = right[1] = 0xff;
  write_file(path, bytes);
  EXPECT_THROW(read_picture_channels_header(path), Error);
  std::filesystem::resize_file(path, 8 << 20);
  const Picture picture = read_picture_channels_header(path);
  EXPECT_EQ(picture.width, 65536);
  EXPECT_EQ(picture.channels, 17);
}

TEST(ExrPart, TooManyChannelsAreNamed) {
  const std::string path = test::scratch_folder() / "part.exr";
  write_exr_part(path, numbered(3, 2, kMaxPictureChannels + 1), {3, 2, 0, 0}, {});
  try {
    read_picture_channels(path);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("257 channels, but only 256"), std::string::npos) << error.what();
  }
}

std::string exr_attribute(const std::string& name, const std::string& type, const std::string& value) {
  const auto size = static_cast<uint32_t>(value.size());
  return name + '\0' + type + '\0' + std::string(reinterpret_cast<const char*>(&size), sizeof size) + value;
}

/// An attribute may begin within the megabyte that is checked and end beyond it: then none after it is checked.
TEST(ExrPart, HeadersThatGoOnBeyondTheCheckAreRefused) {
  const std::string path = test::scratch_folder() / "long.exr";
  constexpr size_t kRead = size_t{1} << 20;
  const std::string magic("v/1\x01\x02\0\0\0", 8),
      huge = std::string("\0\0\0\0\0\0\0\0\xff\xff\xff\x7f\xff\xff\xff\x7f", 16);
  const std::string window = exr_attribute("dataWindow", "box2i", huge) + std::string(1, '\0');
  // Bytes of the attribute before the limit: none, then within its name, type and size.
  for (const size_t before : {0u, 5u, 14u, 19u}) {
    const size_t filler = kRead - before - magic.size() - exr_attribute("filler", "string", "").size();
    const std::string bytes = magic + exr_attribute("filler", "string", std::string(filler, ' ')) + window;
    write_file(path, std::vector<uint8_t>(bytes.begin(), bytes.end()));
    try {
      check_exr_header(path);
      ADD_FAILURE() << before << " bytes of an attribute before the limit";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("larger than 1 MB"), std::string::npos) << error.what();
    }
  }
}

TEST(ExrPart, AWholePictureIsItsOwnFrame) {
  const std::string path = test::scratch_folder() / "whole.exr";
  write_picture(path, numbered(5, 4, 3));
  EXPECT_EQ(read_exr_header(path).frame, (PictureFrame{5, 4, 0, 0}));
  EXPECT_TRUE(read_exr_header(path).texts.empty());
}

TEST(ExrPart, RefusesOtherFormatsAndReservedNames) {
  const auto folder = test::scratch_folder();
  const auto written = [&](const char* name, const char* text) {
    write_exr_part(folder / name, numbered(2, 2, 3), {2, 2, 0, 0}, {{text, "x"}});
  };
  EXPECT_THROW(written("part.png", "velour.samples"), Error);
  for (const char* name : {"dataWindow", "channels", "compression", ""}) EXPECT_THROW(written("part.exr", name), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "part.exr"));
  write_picture(folder / "whole.png", numbered(2, 2, 3));
  EXPECT_THROW(read_exr_header(folder / "whole.png"), Error);
}

}  // namespace
}  // namespace velour::exr_part_test
