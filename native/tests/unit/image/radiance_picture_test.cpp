// Radiance HDR pictures: orientations, exposures, primaries, encodings of scan lines, damage.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "image/picture.h"
#include "support/inputs.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::radiance_picture_test {
namespace {

constexpr int kHdrWidth = 12, kHdrHeight = 9;
using Rgbe = std::array<uint8_t, 4>;

/// A picture with another color at each pixel, counted from the upper left.
Rgbe color_at(int x, int y) { return {static_cast<uint8_t>(128 + x), static_cast<uint8_t>(y + 3), 200, 129}; }

float value_of(uint8_t mantissa) { return std::ldexp(static_cast<float>(mantissa), 129 - 136); }

enum class Lines { flat, runs, old_runs };

/// As stored along scan lines of `columns` columns (lines of X first), from the given ends.
std::vector<uint8_t> file_of(const std::string& variables, const std::string& resolution, Lines lines = Lines::flat) {
  const std::string head = "#?RADIANCE\n" + variables + "\n" + resolution + "\n";
  std::vector<uint8_t> bytes(head.begin(), head.end());
  const bool columns = resolution[1] == 'X';
  const size_t second = resolution.find(' ', 3) + 1;
  const char x_sign = columns ? resolution[0] : resolution[second],
             y_sign = columns ? resolution[second] : resolution[0];
  const int line_count = columns ? kHdrWidth : kHdrHeight, length = columns ? kHdrHeight : kHdrWidth;
  for (int line = 0; line < line_count; ++line) {
    std::vector<Rgbe> pixels;
    for (int i = 0; i < length; ++i) {
      const int x = columns ? line : i, y = columns ? i : line;
      pixels.push_back(color_at(x_sign == '+' ? x : kHdrWidth - 1 - x, y_sign == '-' ? y : kHdrHeight - 1 - y));
    }
    if (lines == Lines::runs) {
      bytes.insert(bytes.end(), {2, 2, 0, static_cast<uint8_t>(length)});
      for (size_t c = 0; c < 4; ++c) {
        if (c >= 2) {  // one value
          bytes.insert(bytes.end(), {static_cast<uint8_t>(128 + length), pixels[0][c]});
          continue;
        }
        bytes.push_back(static_cast<uint8_t>(length));
        for (const Rgbe& pixel : pixels) bytes.push_back(pixel[c]);
      }
      continue;
    }
    for (const Rgbe& pixel : pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.end());
  }
  return bytes;
}

void expect_the_picture(const Picture& picture, float scale = 1) {
  ASSERT_EQ(picture.width, kHdrWidth);
  ASSERT_EQ(picture.height, kHdrHeight);
  ASSERT_EQ(picture.channels, 3);
  for (int y = 0; y < kHdrHeight; ++y)
    for (int x = 0; x < kHdrWidth; ++x) {
      const Rgbe color = color_at(x, y);
      for (size_t c = 0; c < 3; ++c)
        ASSERT_FLOAT_EQ(picture.pixel(x, kHdrHeight - 1 - y)[c], scale * value_of(color[c])) << x << ' ' << y;
    }
}

class RadiancePicture : public testing::Test {
 protected:
  std::string path_ = test::scratch_folder() / "a.hdr";

  std::string refusal() const {
    try {
      read_picture(path_);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(RadiancePicture, AllEightOrientations) {
  test::record_input("Radiance HDR", "all eight orders of pixels", "turned upright");
  for (const char* x : {"+X 12", "-X 12"})
    for (const char* y : {"-Y 9", "+Y 9"})
      for (const bool x_first : {false, true}) {
        const std::string resolution = x_first ? std::string(x) + " " + y : std::string(y) + " " + x;
        SCOPED_TRACE(resolution);
        write_file(path_, file_of("FORMAT=32-bit_rle_rgbe\n", resolution));
        expect_the_picture(read_picture(path_));
        const bool usual = resolution == "-Y 9 +X 12";
        EXPECT_EQ(read_picture(path_, {.as_stored = true}).warnings.size(), usual ? 0u : 1u);
      }
}

TEST_F(RadiancePicture, ScanLinesOfRuns) {
  test::record_input("Radiance HDR", "run lengths", "read");
  write_file(path_, file_of("FORMAT=32-bit_rle_rgbe\n", "-Y 9 +X 12", Lines::runs));
  expect_the_picture(read_picture(path_));
}

TEST_F(RadiancePicture, OldRuns) {
  test::record_input("Radiance HDR", "old run lengths, across scan lines", "read");
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 10 +X 30\n";
  std::vector<uint8_t> bytes(head.begin(), head.end());
  // One pixel, 0x12b = 299 times more: the low digit, then the high one.
  bytes.insert(bytes.end(), {128, 64, 32, 129, 1, 1, 1, 0x2b, 1, 1, 1, 0x01});
  write_file(path_, bytes);
  const Picture picture = read_picture(path_);
  ASSERT_EQ(picture.pixels.size(), 900u);
  for (size_t i = 0; i < 900; i += 3) ASSERT_EQ(picture.pixels[i], 1.0f);
}

TEST_F(RadiancePicture, ExposuresAreUndone) {
  test::record_input("Radiance HDR", "EXPOSURE, COLORCORR", "divided out");
  write_file(path_, file_of("EXPOSURE=2\nEXPOSURE= 0.5e1\nFORMAT=32-bit_rle_rgbe\n", "-Y 9 +X 12"));
  expect_the_picture(read_picture(path_), 0.1f);
  const Picture stored = read_picture(path_, {.as_stored = true});
  expect_the_picture(stored);
  EXPECT_EQ(stored.warnings.size(), 1u);
  write_file(path_, file_of("COLORCORR=1 2 4\n", "-Y 9 +X 12"));
  const Picture picture = read_picture(path_);
  EXPECT_FLOAT_EQ(picture.pixel(0, 8)[1], value_of(3) / 2);
  EXPECT_FLOAT_EQ(picture.pixel(0, 8)[2], value_of(200) / 4);
}

/// 2^126 / 1e-10 is beyond a float; the other pixel is then the brightest.
TEST_F(RadiancePicture, ExposuresThatMakeColorsInfiniteAreCounted) {
  const std::string head = "#?RADIANCE\nEXPOSURE=1e-10\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  std::vector<uint8_t> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), {128, 128, 128, 255, 128, 128, 128, 129});
  write_file(path_, bytes);
  const Picture picture = read_picture(path_);
  for (int x = 0; x < 2; ++x) EXPECT_FLOAT_EQ(picture.pixel(x, 0)[0], 1e10f) << x;
  const Warning* found = test::find_warning(picture.warnings, WarningCode::infinite_values);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(test::value_of<uint64_t>(*found, "values"), 3u);
  EXPECT_TRUE(std::isinf(read_picture(path_, {.keeps_not_finite = true}).pixel(0, 0)[0]));
}

TEST_F(RadiancePicture, NeedsNoFormatAndAnyLengthOfComments) {
  test::record_input("Radiance HDR", "no FORMAT line, long comments", "read");
  write_file(path_, file_of("# " + std::string(5000, 'x') + "\nVIEW= -vtv\n", "-Y 9 +X 12"));
  expect_the_picture(read_picture(path_));
}

/// D65 white of luminance 1 in CIE XYZ is white.
TEST_F(RadiancePicture, Xyze) {
  test::record_input("Radiance HDR", "XYZE", "converted to Rec. 709");
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
  std::vector<uint8_t> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), {122, 128, 139, 129});  // 0.9505 1 1.089 within a 256th
  write_file(path_, bytes);
  const Picture picture = read_picture(path_);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixel(0, 0)[c], 1.0f, 0.02f) << c;
}

TEST_F(RadiancePicture, PrimariesAreConverted) {
  test::record_input("Radiance HDR", "PRIMARIES", "converted to Rec. 709");
  const std::string rec2020 = "PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290\nFORMAT=32-bit_rle_rgbe\n";
  const std::string head = "#?RADIANCE\n" + rec2020 + "\n-Y 1 +X 2\n";
  std::vector<uint8_t> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), {128, 128, 128, 129, 128, 0, 0, 129});
  write_file(path_, bytes);
  const Picture picture = read_picture(path_);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixel(0, 0)[c], 1.0f, 1e-4f) << c;
  // ITU-R BT.2407: the red of Rec. 2020 in Rec. 709.
  EXPECT_NEAR(picture.pixel(1, 0)[0], 1.6605f, 1e-3f);
  EXPECT_NEAR(picture.pixel(1, 0)[1], -0.1246f, 1e-3f);
  EXPECT_NEAR(picture.pixel(1, 0)[2], -0.0182f, 1e-3f);
}

TEST_F(RadiancePicture, PrimariesOfZerosSayNothing) {
  test::record_input("Radiance HDR", "PRIMARIES of zeros (Photoshop)", "taken as Rec. 709");
  write_file(path_, file_of("GAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\nFORMAT=32-bit_rle_rgbe\n", "-Y 9 +X 12"));
  expect_the_picture(read_picture(path_));
}

TEST_F(RadiancePicture, RefusesDamage) {
  test::record_input("Radiance HDR", "cut or damaged", "refused");
  const auto whole = file_of("FORMAT=32-bit_rle_rgbe\n", "-Y 9 +X 12", Lines::runs);
  for (size_t size = 0; size < whole.size(); size += 7) {
    write_file(path_, std::span(whole).first(size));
    EXPECT_NE(refusal().find("a.hdr"), std::string::npos) << size;
  }
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"FORMAT=something\n", "something"}, {"EXPOSURE=0\n", "EXPOSURE"},        {"EXPOSURE=x\n", "EXPOSURE"},
      {"PRIMARIES=1 2\n", "PRIMARIES"},    {"COLORCORR=1 -1 1\n", "COLORCORR"}, {"EXPOSURE=1e-60\n", "EXPOSURE"}};
  for (const auto& [variables, field] : wrong) {
    write_file(path_, file_of(variables, "-Y 9 +X 12"));
    EXPECT_NE(refusal().find(field), std::string::npos) << variables << refusal();
  }
  for (const char* resolution : {"-Y 9", "+Y 9 +Y 12", "-Y 0 +X 12", "-Y 9 +X -3", "9 12", "-Y 99999999999 +X 2"}) {
    const std::string text = "#?RADIANCE\n\n" + std::string(resolution) + "\n";
    write_file(path_, std::vector<uint8_t>(text.begin(), text.end()));
    EXPECT_NE(refusal().find("resolution"), std::string::npos) << resolution << refusal();
  }
}

}  // namespace
}  // namespace velour::radiance_picture_test
