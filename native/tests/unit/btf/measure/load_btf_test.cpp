#include "btf/formats/load_btf.h"

#include <gtest/gtest.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "btf_support.h"
#include "image/formats/exr_picture.h"
#include "image/picture.h"
#include "support/inputs.h"
#include "support/test_data.h"
#include "support/warnings.h"
#include "ubo_support.h"

namespace velour::load_btf_test {
namespace {

namespace fs = std::filesystem;
using test::message_of;

/// `width` x 2 pixels of 8 bits: stored red, green and blue are all of `code`, one more in the row at the bottom.
void write_bytes(const fs::path& file, uint8_t code, int width = 3) {
  std::vector<uint8_t> pixels(static_cast<size_t>(width) * 6, code);
  std::fill(pixels.begin() + width * 3, pixels.end(), static_cast<uint8_t>(code + 1));
  const auto output = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(width, 2, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", "jpeg:100");
  ASSERT_TRUE(output && output->open(file.string(), spec) &&
              output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close());
}

/// Two views, two lights, pictures of `extension`.
fs::path written_set(const fs::path& folder, const std::string& extension) {
  fs::create_directories(folder);
  uint8_t code = 100;
  for (const char* light : {"tl000 pl000", "tl060 pl090"}) {
    for (const char* view : {"tv000 pv000", "tv045 pv180"}) {
      write_bytes(folder / (std::string(light) + " " + view + extension), code);
      code = static_cast<uint8_t>(code + 20);
    }
  }
  return folder;
}

float value(const BtfMeasurement& btf, uint64_t pair, uint64_t row, uint64_t column = 0) {
  std::vector<HalfBits> halves(btf.grid().texels() * 3);
  btf.read_pairs(pair, 1, halves);
  std::vector<float> floats(halves.size());
  halves_to_floats(halves, floats);
  return floats[(row * btf.grid().width + column) * 3 + 1];
}

double srgb(double code) { return std::pow((code / 255 + 0.055) / 1.055, 2.4); }

std::string detail(const BtfMeasurement& btf, const std::string& key) {
  for (const auto& [name, text] : btf.details())
    if (name == key) return text;
  return "";
}

TEST(LoadBtf, PicturesAreRadianceUnderTheSrgbCurve) {
  for (const char* extension : {".png", ".jpg"}) {
    const auto btf = load_btf(written_set(test::scratch_folder(), extension));
    EXPECT_EQ(btf->provenance().format, "ubo2003");
    ASSERT_EQ(btf->layout().pairs(), 4u);
    EXPECT_EQ(btf->layout().views()[1], (PolarAngles{45, 180}));
    EXPECT_EQ(btf->layout().lights()[1], (PolarAngles{60, 90}));
    EXPECT_EQ(btf->grid(), (TexelGrid{3, 2}));
    const double tolerance = extension[1] == 'p' ? 1e-3 : 2e-2;
    // Pairs run by view, then light; pictures were written by light, then view. Row 0 is at the bottom.
    EXPECT_NEAR(value(*btf, 0, 1) / (srgb(100) / M_PI), 1, tolerance);
    EXPECT_NEAR(value(*btf, 0, 0) / (srgb(101) / M_PI), 1, tolerance);
    EXPECT_NEAR(value(*btf, 1, 1) / (srgb(140) / M_PI / 0.5), 1, tolerance);
    EXPECT_NEAR(value(*btf, 2, 1) / (srgb(120) / M_PI), 1, tolerance);
    EXPECT_EQ(detail(*btf, "values"), "f = number / (pi cos(theta_l))");
    EXPECT_FALSE(btf->all_counts());
  }
}

TEST(LoadBtf, OptionsSayWhatNumbersMean) {
  const auto folder = written_set(test::scratch_folder(), ".png");
  BtfLoadOptions options;
  options.curve.gamma = 1.0f;
  options.values = BtfValues::reflectance;
  EXPECT_NEAR(value(*load_btf(folder, options), 1, 1), 140 / 255.0 / M_PI, 1e-4);
  options.values = BtfValues::brdf;
  options.curve.gamma = 2.2f;
  options.tile_metres = Vec2(0.02f, 0.01f);
  const auto btf = load_btf(folder, options);
  EXPECT_NEAR(value(*btf, 1, 1), std::pow(140 / 255.0, 2.2), 2e-4);
  EXPECT_EQ(btf->grid().tile_metres, Vec2(0.02f, 0.01f));
  EXPECT_NE(btf->provenance().sha256, load_btf(folder)->provenance().sha256);
  options.colors = BtfColors::xyz;
  EXPECT_NEAR(value(*load_btf(folder, options), 1, 1), 0.9484 * std::pow(140 / 255.0, 2.2), 5e-4);
  options.curve.gamma = 0.0f;
  EXPECT_NE(message_of([&] { load_btf(folder, options); }), "");
  options = {};
  options.tile_metres = Vec2(0.0f, 1.0f);
  EXPECT_NE(message_of([&] { load_btf(folder, options); }), "");
}

TEST(LoadBtf, SizesThatNoTileHasAreNotKnown) {
  const auto folder = test::scratch_folder();
  const std::string path = folder / "tl000 pl000 tv000 pv000.exr";
  const Picture picture{2, 1, 3, {1, 1, 1, 1, 1, 1}};
  const auto tile_of = [&](const std::string& text) {
    write_exr_part(path, picture, {2, 1, 0, 0}, {{"velour.tile_metres", text}});
    return load_btf(folder)->grid().tile_metres;
  };
  EXPECT_EQ(tile_of("0.02 0.01"), Vec2(0.02f, 0.01f));
  for (const char* text : {"inf 1", "1 inf", "nan 1", "0 1", "1 -1", "1"})
    EXPECT_EQ(tile_of(text), std::nullopt) << text;
  const std::string file = folder / "a.btf";
  for (const float pixels_per_mm : {0.0f, -1.0f, 1e-42f, 3e38f, INFINITY, NAN}) {
    test::UboExample example;
    example.pixels_per_mm = pixels_per_mm;
    example.randomize(1);
    write_file(file, example.bytes());
    EXPECT_EQ(load_btf(file)->grid().tile_metres, std::nullopt) << pixels_per_mm;
  }
}

TEST(LoadBtf, CsvIndicesMayLackPairs) {
  const auto folder = test::scratch_folder();
  write_bytes(folder / "a.png", 10);
  write_bytes(folder / "b.png", 20);
  write_bytes(folder / "c.png", 30);
  std::ofstream(folder / "btf.csv")
      << "file,theta_l,phi_l,theta_v,phi_v\na.png,10,0,0,0\nb.png,20,0,5,5\nc.png,10,0,5,5\n";
  for (const fs::path& path : {folder, folder / "btf.csv"}) {
    const auto btf = load_btf(path);
    EXPECT_EQ(btf->provenance().format, "csv");
    ASSERT_EQ(btf->layout().pairs(), 3u);
    EXPECT_FALSE(btf->layout().complete());
    EXPECT_NEAR(value(*btf, 1, 1) * M_PI * std::cos(10 * M_PI / 180), srgb(30), 1e-4);
    EXPECT_NEAR(value(*btf, 2, 1) * M_PI * std::cos(20 * M_PI / 180), srgb(20), 1e-4);
  }
}

TEST(LoadBtf, PicturesOfFloatsAreTakenAsTheyAre) {
  const auto folder = test::scratch_folder();
  Picture picture{2, 1, 3, {0.5f, -0.25f, 200000.0f, NAN, 1, 2}};
  write_picture(folder / "tl060 pl000 tv000 pv000.exr", picture);
  const auto btf = load_btf(folder);
  std::vector<HalfBits> halves(6);
  btf->read_pairs(0, 1, halves);
  ValueCounts counts;
  counts.add(halves);
  EXPECT_EQ(counts, (ValueCounts{6, 2, 1}));  // NaN, and what is past the largest half
  std::vector<float> floats(6);
  halves_to_floats(halves, floats);
  EXPECT_NEAR(floats[0], 0.5 / (M_PI * 0.5), 1e-3);
}

TEST(LoadBtf, ValuesAreCountedInAllPairsOrInSome) {
  const auto folder = test::scratch_folder();
  EXPECT_EQ(count_values(*load_btf(written_set(folder / "few", ".png"))).pairs, 4u);
  for (int light = 0; light < 60; light += 3) {
    const std::string name = "tl" + std::to_string(light) + " pl0 tv0 pv0.exr";
    write_picture(folder / name, {1, 1, 3, {1, -1, NAN}});
  }
  fs::remove_all(folder / "few");
  const CountedPairs counted = count_values(*load_btf(folder));
  EXPECT_EQ(counted.pairs, 16u);
  EXPECT_EQ(counted.counts, (ValueCounts{48, 16, 16}));
}

TEST(LoadBtf, DamagedPicturesAreNamed) {
  for (const char* extension : {".png", ".jpg", ".exr"}) {
    const auto folder = written_set(test::scratch_folder(), extension);
    const fs::path picture = folder / ("tl060 pl090 tv000 pv000" + std::string(extension));
    fs::resize_file(picture, fs::file_size(picture) - 40);
    const std::string message = message_of([&] { value(*load_btf(folder), 1, 0); });
    EXPECT_NE(message.find(picture.string() + ": cannot be read as an image"), std::string::npos) << message;
    std::ofstream(picture) << "no picture";
    EXPECT_NE(message_of([&] { load_btf(folder); }).find(picture.string()), std::string::npos);
    write_bytes(picture, 9, 5);
    EXPECT_NE(message_of([&] { load_btf(folder); }).find("All images of the set must have the same size"),
              std::string::npos);
  }
}

TEST(LoadBtf, PicturesThatChangeAfterwardsAreNoticed) {
  const auto folder = written_set(test::scratch_folder(), ".png");
  const auto btf = load_btf(folder);
  write_bytes(folder / "tl000 pl000 tv000 pv000.png", 9, 5);
  EXPECT_NE(message_of([&] { value(*btf, 0, 0); }).find("5 x 2 pixels"), std::string::npos);
}

TEST(LoadBtf, AnglesThatAreNoDirectionsAreRefused) {
  const auto folder = test::scratch_folder();
  write_bytes(folder / "tl090 pl000 tv000 pv000.png", 9);
  EXPECT_NE(message_of([&] { load_btf(folder); }).find("differ from 90 by at least 0.1"), std::string::npos);
}

/// Channels beside R, G and B, of 2 x 2 pixels.
void write_passes(const fs::path& file, const std::vector<std::string>& channels) {
  const auto output = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(2, 2, static_cast<int>(channels.size()), OIIO::TypeDesc::HALF);
  spec.channelnames = channels;
  const std::vector<float> pixels(channels.size() * 4, 0.5f);
  ASSERT_TRUE(output && output->open(file.string(), spec) &&
              output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
}

TEST(LoadBtf, ChannelsLeftOutAreToldOfOnce) {
  test::record_input("BTF images named by angles", "OpenEXR with further channels, layers or parts, or without G or B",
                     "read as without the rest; a warning counts the images");
  const auto folder = test::scratch_folder();
  write_passes(folder / "tl000 pl000 tv000 pv000.exr", {"R", "G", "B"});
  write_passes(folder / "tl010 pl000 tv000 pv000.exr", {"R", "G", "B", "Z"});
  write_passes(folder / "tl020 pl000 tv000 pv000.exr", {"R", "G", "B", "AO.R", "depth"});
  write_passes(folder / "tl030 pl000 tv000 pv000.exr", {"R"});
  const auto btf = load_btf(folder);
  const std::vector<Warning> expected = {
      warning<WarningCode::images_channels_ignored>({{"images", uint64_t{2}},
                                                     {"all", uint64_t{4}},
                                                     {"first", (folder / "tl010 pl000 tv000 pv000.exr").string()},
                                                     {"layer", ""},
                                                     {"channels", std::vector<std::string>{"Z"}}}),
      warning<WarningCode::images_channel_missing>({{"images", uint64_t{1}},
                                                    {"all", uint64_t{4}},
                                                    {"first", (folder / "tl030 pl000 tv000 pv000.exr").string()}})};
  EXPECT_EQ(btf->warnings(), expected);
  nlohmann::ordered_json record;
  put_warnings(btf->warnings(), record);
  EXPECT_EQ(parse_warnings(record, "record"), expected);
}

TEST(LoadBtf, PartsLeftOutAreToldOfOnce) {
  const auto folder = test::scratch_folder();
  for (const char* name : {"tl000 pl000 tv000 pv000.exr", "tl010 pl000 tv000 pv000.exr"}) {
    const auto output = OIIO::ImageOutput::create((folder / name).string());
    std::vector<OIIO::ImageSpec> parts(2, OIIO::ImageSpec(2, 2, 3, OIIO::TypeDesc::HALF));
    parts[0].attribute("oiio:subimagename", "beauty");
    parts[1].attribute("oiio:subimagename", "normal");
    const std::vector<float> pixels(12, 0.5f);
    ASSERT_TRUE(output->open((folder / name).string(), 2, parts.data()));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->open((folder / name).string(), parts[1], OIIO::ImageOutput::AppendSubimage));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
  }
  const std::vector<Warning> told = load_btf(folder)->warnings();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].code, WarningCode::images_parts_ignored);
  EXPECT_EQ(test::value_of<uint64_t>(told[0], "images"), 2u);
  EXPECT_EQ(test::value_of<uint64_t>(told[0], "parts"), 2u);
  EXPECT_EQ(test::value_of<std::string>(told[0], "part"), "beauty");
}

TEST(LoadBtf, OtherFilesAreRefused) {
  const auto folder = test::scratch_folder();
  std::ofstream(folder / "a.txt") << "hello";
  std::ofstream(folder / "a.zip") << "PK\x03\x04 and so on";
  EXPECT_NE(message_of([&] { load_btf(folder / "a.txt"); }).find("is not a BTF"), std::string::npos);
  EXPECT_NE(message_of([&] { load_btf(folder / "a.zip"); }).find("unpack it"), std::string::npos);
  EXPECT_NE(message_of([&] { load_btf(folder / "none"); }).find("No such file"), std::string::npos);
  EXPECT_FALSE(is_btf(folder / "a.txt"));
  EXPECT_TRUE(is_btf(folder));
}

TEST(LoadBtf, OurOwnFolderIsFoundByItsIndexToo) {
  const std::string path = test::scratch_folder() / "tile";
  const test::RandomBtf btf(test::small_index(), 1);
  btf.write(path);
  BtfLoadOptions options;
  options.tile_metres = Vec2(1, 2);
  EXPECT_EQ(test::all_pairs(*load_btf(path)), btf.values);
  EXPECT_EQ(load_btf(path + "/btf.json", options)->grid().tile_metres, Vec2(1, 2));
  EXPECT_TRUE(is_btf(path + "/btf.json"));
}

}  // namespace
}  // namespace velour::load_btf_test
