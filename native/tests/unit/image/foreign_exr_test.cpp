// OpenEXR pictures as other programs write them: channel names, windows, parts, tiles, primaries, cube maps, deep data.
#include <gtest/gtest.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "image/picture.h"
#include "support/inputs.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::foreign_exr_test {
namespace {

constexpr int kWidth = 6, kHeight = 4;
using Channels = std::vector<std::pair<std::string, float>>;  // name, value of all of its pixels

/// Each channel has one value, but the pixel at the upper left has a tenth of it.
class Planes {
 public:
  explicit Planes(const Channels& channels, const Imath::Box2i& window) : window_(window) {
    const auto count = static_cast<size_t>((window.max.x - window.min.x + 1) * (window.max.y - window.min.y + 1));
    for (const auto& [name, value] : channels) {
      auto& plane = planes_[name];
      plane.assign(count, value);
      plane[0] = value / 10;
    }
  }

  Imf::FrameBuffer buffer() {
    const int width = window_.max.x - window_.min.x + 1;
    Imf::FrameBuffer result;
    for (auto& [name, plane] : planes_) {
      result.insert(name, Imf::Slice::Make(Imf::FLOAT, plane.data(), window_, sizeof(float),
                                           sizeof(float) * static_cast<size_t>(width)));
    }
    return result;
  }

 private:
  Imath::Box2i window_;
  std::map<std::string, std::vector<float>> planes_;
};

Imf::Header header_of(const Channels& channels, const Imath::Box2i& display, const Imath::Box2i& data) {
  Imf::Header header(display, data);
  for (const auto& [name, value] : channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  return header;
}

const Imath::Box2i kWindow({0, 0}, {kWidth - 1, kHeight - 1});

void write(const std::string& path, const Channels& channels, Imf::Header header) {
  Planes planes(channels, header.dataWindow());
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(planes.buffer());
  file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
}

void write(const std::string& path, const Channels& channels) {
  write(path, channels, header_of(channels, kWindow, kWindow));
}

std::vector<float> pixel_of(const Picture& picture, int x, int y) {
  const float* first = picture.pixel(x, y);
  return {first, first + picture.channels};
}

std::string refusal(const std::string& path, const PictureOptions& options = {}) {
  try {
    read_picture(path, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class ForeignExr : public testing::Test {
 protected:
  std::string path_ = test::scratch_folder() / "picture.exr";
};

TEST_F(ForeignExr, SmallLettersAreColors) {
  test::record_input("OpenEXR", "channels r, g, b", "read");
  write(path_, {{"b", 3}, {"g", 2}, {"r", 1}});
  const Picture picture = read_picture(path_);
  EXPECT_EQ(pixel_of(picture, 1, 1), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(pixel_of(picture, 0, kHeight - 1), (std::vector<float>{0.1f, 0.2f, 0.3f}));
  EXPECT_TRUE(picture.warnings.empty());
}

TEST_F(ForeignExr, PassesAreLeftOutAloud) {
  test::record_input("OpenEXR", "R, G, B with passes beside them", "read; passes are left out and named");
  test::record_input("OpenEXR", "one layer or channel (--layer)", "read");
  write(path_, {{"AO.R", 9}, {"B", 3}, {"G", 2}, {"R", 1}, {"depth.Z", 8}});
  const Picture picture = read_picture(path_);
  EXPECT_EQ(pixel_of(picture, 1, 1), (std::vector<float>{1, 2, 3}));
  ASSERT_EQ(picture.warnings.size(), 1u);
  EXPECT_EQ(picture.warnings[0],
            warning<WarningCode::channels_ignored>(
                {{"file", path_}, {"layer", ""}, {"channels", std::vector<std::string>{"AO.R", "depth.Z"}}}));
  EXPECT_EQ(pixel_of(read_picture(path_, {.layer = "depth"}), 1, 1), std::vector<float>{8});
}

TEST_F(ForeignExr, GrayKeepsItsAlpha) {
  test::record_input("OpenEXR", "Y and A", "read");
  write(path_, {{"A", 0.5f}, {"Y", 4}});
  EXPECT_EQ(pixel_of(read_picture(path_), 1, 1), (std::vector<float>{4, 0.5f}));
}

TEST_F(ForeignExr, LuminanceAndChroma) {
  test::record_input("OpenEXR", "Y, RY, BY", "converted to RGB");
  constexpr int kSide = 16;
  {
    Imf::RgbaOutputFile file(path_.c_str(), kSide, kSide, Imf::WRITE_YC);
    const std::vector<Imf::Rgba> pixels(kSide * kSide, Imf::Rgba(1.0f, 2.0f, 0.5f));
    file.setFrameBuffer(pixels.data(), 1, kSide);
    file.writePixels(kSide);
  }
  const Picture picture = read_picture(path_);
  ASSERT_EQ(picture.channels, 3);
  const std::vector<float> expected{1.0f, 2.0f, 0.5f};
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixel(7, 7)[c], expected[c], 0.01f);
}

/// OpenEXR would read other names as black.
TEST_F(ForeignExr, LuminanceAndChromaOfOtherNamesAreRefused) {
  test::record_input("OpenEXR", "y, ry, by", "refused");
  write(path_, {{"by", 0.0f}, {"ry", 0.0f}, {"y", 2.0f}});
  EXPECT_EQ(refusal(path_), path_ +
                                ": channel y of a luminance and chroma image must be named Y. Rename it, or save the "
                                "image as RGB.");
  write(path_, {{"BY", 0.0f}, {"RY", 0.0f}, {"Y", 2.0f}, {"a", 1.0f}});
  EXPECT_NE(refusal(path_).find("channel a of a luminance and chroma image must be named A"), std::string::npos);
}

TEST_F(ForeignExr, PixelsLieInTheDisplayWindow) {
  test::record_input("OpenEXR", "data window inside of, or beyond, the display window",
                     "placed in the display window, black outside");
  // Data one column left of the display and two rows short of its bottom.
  const Imath::Box2i display({10, 20}, {10 + kWidth - 1, 20 + kHeight - 1}), data({9, 20}, {12, 21});
  const Channels channels{{"B", 3}, {"G", 2}, {"R", 1}};
  write(path_, channels, header_of(channels, display, data));
  const Picture picture = read_picture(path_);
  ASSERT_EQ(picture.width, kWidth);
  ASSERT_EQ(picture.height, kHeight);
  EXPECT_EQ(pixel_of(picture, 0, kHeight - 1), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(pixel_of(picture, 2, kHeight - 2), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(pixel_of(picture, 3, kHeight - 1), (std::vector<float>{0, 0, 0}));
  EXPECT_EQ(pixel_of(picture, 0, kHeight - 3), (std::vector<float>{0, 0, 0}));
  const Picture stored = read_picture(path_, {.as_stored = true});
  EXPECT_EQ(stored.width, 4);
  EXPECT_EQ(stored.height, 2);
  ASSERT_EQ(stored.warnings.size(), 1u);
  EXPECT_EQ(stored.warnings[0],
            warning<WarningCode::window_ignored>({{"file", path_}, {"width", uint64_t{6}}, {"height", uint64_t{4}}}));
}

TEST_F(ForeignExr, AnEmptyDisplayWindowIsNotAllocated) {
  test::record_input("OpenEXR", "a huge display window around a few pixels", "refused");
  const Channels channels{{"Y", 1}};
  write(path_, channels, header_of(channels, {{0, 0}, {60000, 60000}}, kWindow));
  EXPECT_NE(refusal(path_).find("60001 x 60001"), std::string::npos) << refusal(path_);
}

TEST_F(ForeignExr, Tiles) {
  test::record_input("OpenEXR", "tiles, mipmaps", "read");
  const Channels channels{{"B", 3}, {"G", 2}, {"R", 1}};
  Imf::Header header = header_of(channels, kWindow, kWindow);
  header.setTileDescription(Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS));
  {
    Planes planes(channels, kWindow);
    Imf::TiledOutputFile file(path_.c_str(), header);
    file.setFrameBuffer(planes.buffer());
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1, 0);
  }
  EXPECT_EQ(pixel_of(read_picture(path_), 5, 0), (std::vector<float>{1, 2, 3}));
}

/// A file with the parts `parts`, by name.
void write_parts(const std::string& path, const std::vector<std::pair<std::string, Channels>>& parts) {
  std::vector<Imf::Header> headers;
  for (const auto& [name, channels] : parts) {
    headers.push_back(header_of(channels, kWindow, kWindow));
    headers.back().setName(name);
    headers.back().setType(Imf::SCANLINEIMAGE);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (size_t i = 0; i < parts.size(); ++i) {
    Planes planes(parts[i].second, kWindow);
    Imf::OutputPart part(file, static_cast<int>(i));
    part.setFrameBuffer(planes.buffer());
    part.writePixels(kHeight);
  }
}

TEST_F(ForeignExr, ChannelsXyzAreColorsWithAWarning) {
  test::record_input("OpenEXR", "only channels X, Y and Z", "used as red, green and blue, with a warning");
  write_parts(path_, {{"light", {{"X", 7}, {"Y", 8}, {"Z", 9}}}});
  const Picture picture = read_picture(path_);
  EXPECT_EQ(pixel_of(picture, 1, 1), (std::vector<float>{7, 8, 9}));
  ASSERT_EQ(picture.warnings.size(), 1u);
  EXPECT_EQ(picture.warnings[0], warning<WarningCode::xyz_as_rgb>({{"file", path_}}));
  EXPECT_TRUE(read_picture(path_, {.primaries = kCieXyz}).warnings.empty());
}

const Channels kColor{{"B", 3}, {"G", 2}, {"R", 1}}, kOther{{"B", 6}, {"G", 5}, {"R", 4}};

TEST_F(ForeignExr, TheFirstPartWithColors) {
  test::record_input("OpenEXR", "several parts", "the first one with colors, said");
  const std::vector<std::pair<std::string, Channels>> before{{"depth", {{"Z", 9}}},
                                                             {"depthY", {{"Y", 9}}},
                                                             {"normals", {{"X", 7}, {"Y", 8}, {"Z", 9}}},
                                                             {"motion", {{"u", 0}, {"v", 0}}}};
  for (const auto& first : before) {
    SCOPED_TRACE(first.first);
    write_parts(path_, {first, {"beauty", kColor}, {"other", kOther}});
    const Picture picture = read_picture(path_);
    EXPECT_EQ(pixel_of(picture, 1, 1), (std::vector<float>{1, 2, 3}));
    ASSERT_EQ(picture.warnings.size(), 1u);
    EXPECT_EQ(picture.warnings[0],
              warning<WarningCode::parts_ignored>({{"file", path_}, {"part", "beauty"}, {"parts", uint64_t{3}}}));
    EXPECT_EQ(pixel_of(read_picture(path_, {.layer = "Other"}), 1, 1), (std::vector<float>{4, 5, 6}));
  }
  write_parts(path_, {{"depth", {{"Z", 9}}}, {"mask", {{"Y", 5}}}});
  EXPECT_EQ(pixel_of(read_picture(path_), 1, 1), std::vector<float>{5});
  try {
    read_picture(path_, {.layer = "sky"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("Its parts are depth, mask."), std::string::npos) << error.what();
  }
}

/// The memory that a picture takes is asked for by all channels, which need not have its resolution.
TEST_F(ForeignExr, LuminanceAndChromaHaveASize) {
  Imf::Header header(kWidth, kHeight);
  {
    Imf::RgbaOutputFile file(path_.c_str(), header, Imf::WRITE_YC);
    std::vector<Imf::Rgba> pixels(kWidth * kHeight, Imf::Rgba(0.5f, 0.5f, 0.5f));
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
  }
  EXPECT_EQ(read_picture_channels_header(path_).width, kWidth);
  EXPECT_EQ(read_picture_text(path_, "any"), std::nullopt);
  EXPECT_THROW(read_picture_channels(path_), Error);
}

/// The same light in other primaries is the same picture.
TEST_F(ForeignExr, PrimariesAreConverted) {
  test::record_input("OpenEXR", "chromaticities of CIE XYZ or Rec. 2020", "converted to Rec. 709");
  const std::vector<float> rgb{0.2f, 0.5f, 0.7f};
  const Imf::Chromaticities rec709;
  const std::vector<Imf::Chromaticities> spaces{
      {{1, 0}, {0, 1}, {0, 0}, {1.0f / 3, 1.0f / 3}},                              // CIE XYZ
      {{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f}},  // Rec. 2020
      rec709,
  };
  for (const Imf::Chromaticities& space : spaces) {
    const Imath::M44f to = Imf::RGBtoXYZ(rec709, 1) * Imf::XYZtoRGB(space, 1);
    Imath::V3f there;
    to.multVecMatrix(Imath::V3f(rgb[0], rgb[1], rgb[2]), there);
    const Channels channels{{"B", there.z}, {"G", there.y}, {"R", there.x}};
    Imf::Header header = header_of(channels, kWindow, kWindow);
    Imf::addChromaticities(header, space);
    write(path_, channels, header);
    const Picture picture = read_picture(path_);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixel(2, 2)[c], rgb[static_cast<size_t>(c)], 2e-4) << space.red.x;
    const Picture stored = read_picture(path_, {.as_stored = true});
    EXPECT_FLOAT_EQ(stored.pixel(2, 2)[0], there.x);
    EXPECT_EQ(stored.warnings.size(), space.red.x == rec709.red.x ? 0u : 1u);
  }
}

/// ACES: its white is not D65, and what is neutral there is neutral here.
TEST_F(ForeignExr, NeutralStaysNeutral) {
  test::record_input("OpenEXR", "chromaticities with another white (ACES)",
                     "converted, neutral stays neutral (Bradford)");
  const Channels channels{{"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}};
  Imf::Header header = header_of(channels, kWindow, kWindow);
  Imf::addChromaticities(header, {{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.0770f}, {0.32168f, 0.33767f}});
  write(path_, channels, header);
  const Picture picture = read_picture(path_);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixel(2, 2)[c], 0.5f, 1e-5);
}

TEST_F(ForeignExr, PrimariesThatAreNoneAreRefused) {
  test::record_input("OpenEXR", "chromaticities that are no basis of colors", "refused");
  const Channels channels{{"B", 1}, {"G", 1}, {"R", 1}};
  for (const float x : {0.3f, std::numeric_limits<float>::quiet_NaN()}) {
    Imf::Header header = header_of(channels, kWindow, kWindow);
    Imf::addChromaticities(header, {{x, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}});
    write(path_, channels, header);
    EXPECT_NE(refusal(path_).find("chromaticities"), std::string::npos);
  }
}

/// OpenEXR's reader of luminance and chroma needs a white, and would leak memory without one.
TEST_F(ForeignExr, LuminanceWithoutWhiteIsRefused) {
  Imf::Header header(kWidth, kHeight);
  Imf::addChromaticities(header, Imf::Chromaticities());
  {
    Imf::RgbaOutputFile file(path_.c_str(), header, Imf::WRITE_YC);
    const std::vector<Imf::Rgba> pixels(kWidth * kHeight, Imf::Rgba(0.5f, 0.5f, 0.5f));
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
  }
  std::vector<uint8_t> bytes = read_file(path_);
  constexpr std::string_view kName("chromaticities\0chromaticities\0", 30);
  const auto name = std::ranges::search(bytes, kName).end();
  std::fill_n(name + 4 + 7 * sizeof(float), sizeof(float), uint8_t{0});  // size, then four pairs: white's y
  write_file(path_, bytes);
  EXPECT_NE(refusal(path_).find("white.y"), std::string::npos) << refusal(path_);
}

TEST_F(ForeignExr, InfiniteSunsStayBright) {
  test::record_input("OpenEXR", "infinite texels, NaN", "the largest finite value, 0; counted");
  const float inf = std::numeric_limits<float>::infinity();
  write(path_, {{"B", inf}, {"G", 2}, {"R", std::numeric_limits<float>::quiet_NaN()}});
  const Picture picture = read_picture(path_);
  EXPECT_EQ(pixel_of(picture, 1, 1), (std::vector<float>{0, 2, 65504}));
  ASSERT_EQ(picture.warnings.size(), 2u);
  EXPECT_EQ(picture.warnings[0], warning<WarningCode::infinite_values>(
                                     {{"file", path_}, {"values", uint64_t{24}}, {"replacement", 65504.0}}));
  EXPECT_EQ(picture.warnings[1], warning<WarningCode::nan_values>({{"file", path_}, {"values", uint64_t{24}}}));
}

TEST_F(ForeignExr, CubeMapsAreRefused) {
  test::record_input("OpenEXR", "cube map", "refused");
  const Channels channels{{"B", 1}, {"G", 1}, {"R", 1}};
  Imf::Header header = header_of(channels, {{0, 0}, {3, 23}}, {{0, 0}, {3, 23}});
  Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
  write(path_, channels, header);
  EXPECT_NE(refusal(path_).find("is a cube map"), std::string::npos);
}

TEST_F(ForeignExr, DeepPicturesAreRefused) {
  test::record_input("OpenEXR", "deep picture", "refused");
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  {
    std::vector<unsigned int> counts(kWidth * kHeight, 1);
    std::vector<float> values(kWidth * kHeight, 2.0f);
    std::vector<float*> pointers;
    for (float& value : values) pointers.push_back(&value);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned int),
                                             sizeof(unsigned int) * kWidth));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                      sizeof(float*) * kWidth, sizeof(float)));
    Imf::DeepScanLineOutputFile file(path_.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(kHeight);
  }
  EXPECT_NE(refusal(path_).find("is a deep image"), std::string::npos) << refusal(path_);
}

/// OpenEXR reads values by their types and takes what follows for the next attribute, whose size it then allocates.
TEST_F(ForeignExr, AttributesWhoseSizesAreNotTheirContentsAreRefused) {
  Imf::Header header = header_of({{"R", 1}, {"G", 2}, {"B", 3}}, kWindow, kWindow);
  header.insert("views", Imf::StringVectorAttribute({"left", "right"}));
  header.setPreviewImage(Imf::PreviewImage(3, 2));
  header.insert("place", Imf::Box2iAttribute(kWindow));
  write(path_, {{"R", 1}, {"G", 2}, {"B", 3}}, header);
  EXPECT_EQ(read_picture(path_).channels, 3);
  const std::vector<uint8_t> whole = read_file(path_);
  for (const std::string name : {"views", "preview", "place", "channels"}) {
    std::vector<uint8_t> bytes = whole;
    const std::string field = name + std::string(1, '\0');
    auto at = std::ranges::search(bytes, field).begin() + static_cast<std::ptrdiff_t>(field.size());
    at = std::find(at, bytes.end(), 0) + 1;  // after the type
    ++*at;                                   // the size
    write_file(path_, bytes);
    const std::string said = refusal(path_);
    EXPECT_NE(said.find("attribute " + name), std::string::npos) << said;
  }
}

/// OpenEXR unpacks sixteen rows at once, whether the picture has them or not.
TEST_F(ForeignExr, BlocksManyTimesAsLargeAsThePictureAreRefused) {
  Imf::Header header = header_of({{"R", 1}, {"G", 2}, {"B", 3}}, kWindow, kWindow);
  header.compression() = Imf::ZIP_COMPRESSION;
  write(path_, {{"R", 1}, {"G", 2}, {"B", 3}}, header);
  std::vector<uint8_t> bytes = read_file(path_);
  const std::string name = std::string("dataWindow\0box2i\0", 17);
  const auto window = std::ranges::search(bytes, name).begin() + static_cast<std::ptrdiff_t>(name.size() + 4);
  const int32_t wide[] = {0, 0, 2'299'999, 0};
  std::memcpy(&*window, wide, sizeof wide);
  write_file(path_, bytes);
  EXPECT_NE(refusal(path_).find("2300000 x 1 pixels, more than the file can contain"), std::string::npos);
  bytes.resize(40'000);
  write_file(path_, bytes);
  EXPECT_NE(refusal(path_).find("in compression blocks that are many times as large"), std::string::npos)
      << refusal(path_);
}

/// Without a size, OpenEXR takes 64 x 64 pixels, and tiles of any size.
TEST_F(ForeignExr, HeadersWithoutASizeOrACompressionAreRefused) {
  write(path_, {{"R", 1}}, header_of({{"R", 1}}, kWindow, kWindow));
  const std::vector<uint8_t> whole = read_file(path_);
  for (const std::string name : {"dataWindow", "compression"}) {
    std::vector<uint8_t> bytes = whole;
    *std::ranges::search(bytes, name).begin() = 'X';
    write_file(path_, bytes);
    EXPECT_NE(refusal(path_).find("attribute " + name + " is missing"), std::string::npos) << refusal(path_);
  }
}

}  // namespace
}  // namespace velour::foreign_exr_test
