// libtiff, as the zip has it, against OpenImageIO: every kind of file gives the same values, or both refuse it.
#include <tiffio.h>
#include <cstring>

#include <filesystem>
#include <functional>

#include "support/inputs.h"
#include "support/test_data.h"
#include "unit/image/portable_pictures.h"

namespace velour::portable_picture_test {
namespace {

struct TiffCase {
  TiffCase(const char* named, uint16_t meant, uint16_t in_a_pixel, uint16_t wide)
      : name(named), photometric(meant), samples(in_a_pixel), bits(wide) {}
  const char* name;
  uint16_t photometric, samples, bits;
  uint16_t format = SAMPLEFORMAT_UINT, compression = COMPRESSION_NONE, planar = PLANARCONFIG_CONTIG;
  std::optional<uint16_t> extra = std::nullopt;
  uint16_t orientation = ORIENTATION_TOPLEFT;
  bool is_tiled = false, is_big = false, is_wide = false;  // BigTIFF

  TiffCase numbers(uint16_t is) const {
    return with([&](TiffCase& c) { c.format = is; });
  }
  TiffCase packed(uint16_t by) const {
    return with([&](TiffCase& c) { c.compression = by; });
  }
  TiffCase with_extra(uint16_t meaning) const {
    return with([&](TiffCase& c) { c.extra = meaning; });
  }
  TiffCase in_planes() const {
    return with([](TiffCase& c) { c.planar = PLANARCONFIG_SEPARATE; });
  }
  TiffCase in_tiles() const {
    return with([](TiffCase& c) { c.is_tiled = true; });
  }
  TiffCase big_endian() const {
    return with([](TiffCase& c) { c.is_big = true; });
  }
  TiffCase wide() const {
    return with([](TiffCase& c) { c.is_wide = true; });
  }
  TiffCase turned(uint16_t to) const {
    return with([&](TiffCase& c) { c.orientation = to; });
  }

 private:
  TiffCase with(const auto& change) const {
    TiffCase changed = *this;
    change(changed);
    return changed;
  }
};

void set_tags(TIFF* tiff, const TiffCase& c) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, c.samples);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, c.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, c.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, c.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, c.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, c.planar);
  if (c.orientation != ORIENTATION_TOPLEFT) TIFFSetField(tiff, TIFFTAG_ORIENTATION, c.orientation);
  if (c.extra) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &*c.extra);
  if (c.photometric == PHOTOMETRIC_SEPARATED) TIFFSetField(tiff, TIFFTAG_INKSET, INKSET_CMYK);
  if (c.photometric == PHOTOMETRIC_PALETTE) {
    std::vector<uint16_t> map;
    for (int i = 0; i < 3 << c.bits; ++i) map.push_back(static_cast<uint16_t>(i * 7919));
    const size_t entries = size_t{1} << c.bits;
    TIFFSetField(tiff, TIFFTAG_COLORMAP, map.data(), map.data() + entries, map.data() + 2 * entries);
  }
  if (c.is_tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 32);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kStripRows);
  }
}

/// Bytes of any pixels, but floats that are finite and of use.
std::vector<uint8_t> pixels_of(const TiffCase& c, size_t count, uint64_t seed) {
  if (c.format != SAMPLEFORMAT_IEEEFP)
    return c.compression == COMPRESSION_JPEG ? std::vector<uint8_t>(count, 90) : random_bytes(count, seed);
  std::vector<uint8_t> bytes(count);
  for (size_t i = 0; i < count; i += c.bits / 8u) {
    const double value = static_cast<double>((i * 31 + seed) % 977) / 64.0 - 3.0;
    const auto single = static_cast<float>(value);
    if (c.bits == 16) {
      const uint16_t half_bits = static_cast<uint16_t>(0x3000 + (i * 37 + seed) % 0x1800);
      std::memcpy(&bytes[i], &half_bits, 2);
    } else {
      std::memcpy(&bytes[i], c.bits == 32 ? static_cast<const void*>(&single) : &value, c.bits / 8u);
    }
  }
  return bytes;
}

std::string written(const TiffCase& c) {
  const std::string path = test::scratch_folder() / (std::string(c.name) + ".tif");
  TIFF* tiff = TIFFOpen(path.c_str(), (std::string("w") + (c.is_big ? "b" : "l") + (c.is_wide ? "8" : "")).c_str());
  set_tags(tiff, c);
  const uint32_t pieces = c.is_tiled ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  const uint32_t strips = (kHeight + kStripRows - 1) / kStripRows;  // of a plane
  for (uint32_t piece = 0; piece < pieces; ++piece) {
    const bool is_last = piece % strips == strips - 1;
    const tmsize_t size =
        c.is_tiled ? TIFFTileSize(tiff) : TIFFVStripSize(tiff, is_last ? kHeight % kStripRows : kStripRows);
    std::vector<uint8_t> pixels = pixels_of(c, static_cast<size_t>(size), piece + 1);
    c.is_tiled ? TIFFWriteEncodedTile(tiff, piece, pixels.data(), size)
               : TIFFWriteEncodedStrip(tiff, piece, pixels.data(), size);
  }
  TIFFClose(tiff);
  return path;
}

TEST(PortableTiff, TiffIsThatOfOpenImageIo) {
  constexpr uint16_t kGray = PHOTOMETRIC_MINISBLACK, kRgb = PHOTOMETRIC_RGB;
  const TiffCase kRgb8("rgb 8", kRgb, 3, 8), kRgb16("rgb 16", kRgb, 3, 16), kGray2("gray and more", kGray, 2, 8);
  const std::vector<TiffCase> cases = {
      {"gray 1", kGray, 1, 1},
      {"gray 4", kGray, 1, 4},
      {"gray 8", kGray, 1, 8},
      {"gray 12", kGray, 1, 12},
      {"gray 16", kGray, 1, 16},
      {"gray 32", kGray, 1, 32},
      TiffCase("gray signed 16", kGray, 1, 16).numbers(SAMPLEFORMAT_INT),
      kGray2.with_extra(EXTRASAMPLE_UNASSALPHA),
      {"white is zero 1", PHOTOMETRIC_MINISWHITE, 1, 1},
      {"white is zero 8", PHOTOMETRIC_MINISWHITE, 1, 8},
      {"palette 1", PHOTOMETRIC_PALETTE, 1, 1},
      {"palette 4", PHOTOMETRIC_PALETTE, 1, 4},
      {"palette 8", PHOTOMETRIC_PALETTE, 1, 8},
      kRgb8,
      kRgb8.packed(COMPRESSION_LZW),
      kRgb8.packed(COMPRESSION_PACKBITS),
      kRgb8.packed(COMPRESSION_ZSTD),
      kRgb8.packed(COMPRESSION_LZMA),
      kRgb8.packed(COMPRESSION_JPEG),
      kRgb8.in_tiles(),
      kRgb16.big_endian(),
      kRgb16.in_planes(),
      kRgb16.in_planes().in_tiles().packed(COMPRESSION_ADOBE_DEFLATE),
      TiffCase("rgb half", kRgb, 3, 16).numbers(SAMPLEFORMAT_IEEEFP),
      TiffCase("rgb float", kRgb, 3, 32).numbers(SAMPLEFORMAT_IEEEFP).packed(COMPRESSION_ADOBE_DEFLATE),
      TiffCase("rgb double", kRgb, 3, 64).numbers(SAMPLEFORMAT_IEEEFP),
      TiffCase("rgba straight", kRgb, 4, 8).with_extra(EXTRASAMPLE_UNASSALPHA),
      TiffCase("rgba premultiplied", kRgb, 4, 16).with_extra(EXTRASAMPLE_ASSOCALPHA),
      {"cmyk 8", PHOTOMETRIC_SEPARATED, 4, 8},
      {"cmyk 16", PHOTOMETRIC_SEPARATED, 4, 16},
      {"ycbcr", PHOTOMETRIC_YCBCR, 3, 8},
      {"lab", PHOTOMETRIC_CIELAB, 3, 8},
  };
  for (const TiffCase& c : cases) {
    expect_same(written(c), "tiff", std::string(c.name) + ", compression " + std::to_string(c.compression));
  }
  test::record_input("TIFF",
                     "gray, RGB, palette, CMYK, YCbCr, Lab; 1 to 32 bits, half, float, double; strips, tiles, "
                     "planes; both byte orders; LZW, DEFLATE, PackBits, Zstandard, LZMA, JPEG",
                     "read, by both builds alike");
}

TEST(PortableTiff, TiffWhoseZeroIsWhiteIsInvertedAtEveryDepth) {
  for (const uint16_t bits : std::initializer_list<uint16_t>{1, 8, 12, 16, 32}) {
    const Decoded black = by_portable(written({"black is zero", PHOTOMETRIC_MINISBLACK, 1, bits}));
    const Decoded white = by_portable(written({"white is zero", PHOTOMETRIC_MINISWHITE, 1, bits}));
    ASSERT_EQ(white.values.size(), black.values.size());
    for (size_t i = 0; i < white.values.size(); ++i) ASSERT_EQ(white.values[i], 1.0f - black.values[i]) << bits;
  }
}

std::string written_tiff(const char* name, uint16_t photometric, uint16_t samples,
                         const std::function<void(TIFF*)>& more_tags, const std::vector<uint8_t>& row) {
  const std::string path = test::scratch_folder() / (std::string(name) + ".tif");
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  set_tags(tiff, {name, photometric, samples, 8});
  more_tags(tiff);
  std::vector<uint8_t> line;
  for (int x = 0; x < kWidth; ++x) line.insert(line.end(), row.begin(), row.end());
  for (uint32_t y = 0; y < kHeight; ++y) TIFFWriteScanline(tiff, line.data(), y, 0);
  TIFFClose(tiff);
  return path;
}

std::vector<float> first_pixel(const std::string& path) {
  const Decoded decoded = by_portable(path);
  EXPECT_EQ(decoded.error, "");
  return {decoded.values.begin(), decoded.values.begin() + decoded.channels};
}

/// Paper of 8 bits: red 200 / 255.
TEST(PortableTiff, CmykKeepsItsColorsBesideFurtherSamples) {
  const uint16_t extra[] = {EXTRASAMPLE_UNASSALPHA};
  const auto with_alpha = [&](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, extra); };
  const std::vector<float> color =
      first_pixel(written_tiff("cmyka", PHOTOMETRIC_SEPARATED, 5, with_alpha, {55, 0, 255, 0, 51}));
  ASSERT_EQ(color.size(), 4u);
  EXPECT_NEAR(color[0], 200 / 255.0, 1e-6);
  EXPECT_NEAR(color[1], 1, 1e-6);
  EXPECT_NEAR(color[2], 0, 1e-6);
  EXPECT_NEAR(color[3], 0.2, 1e-6);
  const auto other_inks = [](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_INKSET, INKSET_MULTIINK); };
  const std::string refused =
      by_portable(written_tiff("inks", PHOTOMETRIC_SEPARATED, 4, other_inks, {1, 2, 3, 4})).error;
  EXPECT_NE(refused.find("photometric interpretation 5"), std::string::npos) << refused;
  test::record_input("TIFF", "CMYK with alpha", "read");
  test::record_input("TIFF", "other inks, raw colors, depths", "refused");
}

TEST(PortableTiff, SamplesBeyondTheColorsAreNoted) {
  const uint16_t extra[] = {EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNSPECIFIED};
  const auto tags = [&](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 3, extra); };
  const std::string path = written_tiff("passes", PHOTOMETRIC_RGB, 6, tags, {51, 102, 153, 1, 204, 2});
  const std::vector<float> color = first_pixel(path);
  ASSERT_EQ(color.size(), 4u);
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(color[c], 0.2f * static_cast<float>(c + 1), 1e-6);
  const PictureHeader header = open_tiff(path)->header();
  ASSERT_EQ(header.warnings.size(), 1u);
  EXPECT_EQ(header.warnings[0],
            warning<WarningCode::channels_ignored>(
                {{"file", path}, {"layer", ""}, {"channels", std::vector<std::string>{"sample 4", "sample 6"}}}));
  test::record_input("TIFF", "further samples", "alpha is read, others are ignored, said");
}

TEST(PortableTiff, PalettesOfBytesAreRead) {
  const auto map = [](TIFF* tiff) {
    std::vector<uint16_t> colors(256, 51);
    TIFFSetField(tiff, TIFFTAG_COLORMAP, colors.data(), colors.data(), colors.data());
  };
  EXPECT_NEAR(first_pixel(written_tiff("bytes", PHOTOMETRIC_PALETTE, 1, map, {7}))[1], 0.2, 1e-6);
}

/// Light of 0.05 to 20 keeps its brightness and its color.
TEST(PortableTiff, LogLuvKeepsItsRange) {
  for (const bool is_color : {true, false}) {
    const std::string path = test::scratch_folder() / "log.tif";
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    TiffCase c("log", is_color ? PHOTOMETRIC_LOGLUV : PHOTOMETRIC_LOGL, is_color ? 3 : 1, 32);
    c.format = SAMPLEFORMAT_IEEEFP;
    c.compression = COMPRESSION_SGILOG;
    set_tags(tiff, c);
    TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
    for (uint32_t y = 0; y < kHeight; ++y) {
      std::vector<float> line;
      for (int x = 0; x < kWidth; ++x) {
        const float bright = 0.05f * std::pow(400.0f, static_cast<float>(x) / (kWidth - 1));
        for (int channel = 0; channel < c.samples; ++channel) line.push_back(bright);  // X = Y = Z: white
      }
      TIFFWriteScanline(tiff, line.data(), y, 0);
    }
    TIFFClose(tiff);
    const Decoded decoded = by_portable(path);
    ASSERT_EQ(decoded.channels, is_color ? 3 : 1) << decoded.error;
    EXPECT_FALSE(decoded.integers);
    for (int x = 0; x < kWidth; ++x) {
      const float bright = 0.05f * std::pow(400.0f, static_cast<float>(x) / (kWidth - 1));
      for (int channel = 0; channel < decoded.channels; ++channel) {
        const float value = decoded.values[static_cast<size_t>(x * decoded.channels + channel)];
        EXPECT_NEAR(value / bright, 1, 0.02) << x << ' ' << channel;
      }
    }
  }
  test::record_input("TIFF", "LogLuv, LogL", "converted to RGB, with their range");
}

TEST(PortableTiff, TheFirstPageOfFullSizeIsRead) {
  const std::string path = test::scratch_folder() / "pages.tif";
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  for (const uint8_t value : std::initializer_list<uint8_t>{10, 51, 90}) {
    set_tags(tiff, {"page", PHOTOMETRIC_MINISBLACK, 1, 8});
    if (value == 10) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
    std::vector<uint8_t> line(kWidth, value);
    for (uint32_t y = 0; y < kHeight; ++y) TIFFWriteScanline(tiff, line.data(), y, 0);
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
  EXPECT_NEAR(first_pixel(path)[0], 0.2, 1e-6);
  const PictureHeader header = open_tiff(path)->header();
  ASSERT_EQ(header.warnings.size(), 1u);
  EXPECT_EQ(header.warnings[0],
            warning<WarningCode::parts_ignored>({{"file", path}, {"part", "page 1"}, {"parts", uint64_t{2}}}));
  test::record_input("TIFF", "several pages, a thumbnail first", "the first page of full size, said");
}

/// libtiff turns what it converts, but picture.cpp does so for all files.
TEST(PortableTiff, TurnedTiffIsReadAsItIsStored) {
  test::record_input("TIFF", "orientation", "turned upright");
  const TiffCase kinds[] = {{"rgb", PHOTOMETRIC_RGB, 3, 8},
                            {"ycbcr", PHOTOMETRIC_YCBCR, 3, 8},
                            TiffCase("ycbcr tiled", PHOTOMETRIC_YCBCR, 3, 8).in_tiles(),
                            TiffCase("lab wide", PHOTOMETRIC_CIELAB, 3, 8).wide(),
                            TiffCase("lab wide big", PHOTOMETRIC_CIELAB, 3, 8).wide().big_endian()};
  for (const TiffCase& kind : kinds) {
    const std::vector<float> stored = by_portable(written(kind)).values;
    for (uint16_t orientation = 2; orientation <= 8; ++orientation) {
      const std::string path = written(kind.turned(orientation));
      const std::string what = std::string(kind.name) + " " + std::to_string(orientation);
      EXPECT_EQ(by_portable(path).values, stored) << what;
      EXPECT_EQ(static_cast<int>(open_tiff(path)->header().orientation), orientation) << what;
    }
  }
}

TEST(PortableTiff, DamagedTiffIsRefused) {
  const std::string path = written(TiffCase("whole", PHOTOMETRIC_RGB, 3, 16).packed(COMPRESSION_LZW));
  const std::vector<uint8_t> whole = read_file(path);
  for (size_t size = 0; size < whole.size(); size += std::max<size_t>(1, whole.size() / 50)) {
    write_file(path, std::span(whole).first(size));
    EXPECT_NE(by_portable(path).error, "") << size;
  }
}

/// A strip of 120 MB in a file of a few bytes. libtiff would name the strip that it failed to read into it.
TEST(PortableTiff, TiffOfMoreSamplesThanItsBytesHoldAllocatesNothing) {
  const std::string path = test::scratch_folder() / "samples.tif";
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  set_tags(tiff, {"samples", PHOTOMETRIC_RGB, 60000, 8});
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2000);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
  uint8_t pixels[] = {1, 2, 3};
  TIFFWriteRawStrip(tiff, 0, pixels, sizeof pixels);
  TIFFClose(tiff);
  EXPECT_NE(by_portable(path).error.find("the file is damaged"), std::string::npos) << by_portable(path).error;
}

/// A page of `side` x `side` white pixels; only its first rows are stored if `is_cut`.
std::string blank_page(uint32_t side, uint16_t compression, bool is_cut = false) {
  const std::string path = test::scratch_folder() / "page.tif";
  const uint32_t stored = is_cut ? 10 : side;
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  set_tags(tiff, TiffCase("page", PHOTOMETRIC_MINISWHITE, 1, 1).packed(compression));
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, side);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, side);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, side);
  std::vector<uint8_t> rows(size_t{(side + 7) / 8} * stored);
  TIFFWriteEncodedStrip(tiff, 0, rows.data(), static_cast<tmsize_t>(rows.size()));
  TIFFClose(tiff);
  return path;
}

TEST(PortableTiff, BlankPagesOfFaxesAreRead) {
  test::record_input("TIFF", "CCITT Group 3 and 4, also blank pages", "read");
  EXPECT_EQ(header_refusal(blank_page(10000, COMPRESSION_CCITTFAX4)), "");
  const Decoded small = by_portable(blank_page(300, COMPRESSION_CCITTFAX4));
  EXPECT_EQ(small.values, std::vector<float>(300 * 300, 1.0f)) << small.error;
  EXPECT_NE(header_refusal(blank_page(30000, COMPRESSION_CCITTFAX4, true)).find("more than the file can contain"),
            std::string::npos);
}

/// One strip of 67 MB in a few KB, which DEFLATE could not reach: of Zstandard a few bytes could be gigabytes.
TEST(PortableTiff, LargeStripsOfOneValueAreReadUnlessTheirCodeIsADenseOne) {
  constexpr uint32_t kSide = 2900;
  for (const uint16_t compression : {uint16_t{COMPRESSION_ZSTD}, uint16_t{COMPRESSION_LZW}}) {
    const std::string path = test::scratch_folder() / "strip.tif";
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    set_tags(tiff, TiffCase("strip", PHOTOMETRIC_MINISBLACK, 1, 64).numbers(SAMPLEFORMAT_IEEEFP).packed(compression));
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kSide);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kSide);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kSide);
    std::vector<double> pixels(size_t{kSide} * kSide);
    TIFFWriteEncodedStrip(tiff, 0, pixels.data(), static_cast<tmsize_t>(pixels.size() * sizeof(double)));
    TIFFClose(tiff);
    EXPECT_LT(std::filesystem::file_size(path), (uint64_t{64} << 20) / kMaxExpansion) << compression;
    const std::string error = by_portable(path).error;
    EXPECT_EQ(error.find("Save it with DEFLATE") != std::string::npos, compression == COMPRESSION_ZSTD) << error;
  }
}

TEST(PortableTiff, SamplesOf24BitsAreReadInBothByteOrders) {
  test::record_input("TIFF", "24 bits, both byte orders", "read");
  const TiffCase kGray24("gray 24", PHOTOMETRIC_MINISBLACK, 1, 24);
  const std::vector<uint8_t> bytes = random_bytes(size_t{kWidth} * kStripRows * 3, 1);  // the first strip
  for (const TiffCase& c : {kGray24, kGray24.big_endian()}) {
    const Decoded decoded = by_portable(written(c));
    ASSERT_EQ(decoded.error, "");
    for (size_t i = 0; i < bytes.size() / 3; ++i) {
      const int code = bytes[3 * i] | bytes[3 * i + 1] << 8 | bytes[3 * i + 2] << 16;
      ASSERT_NEAR(decoded.values[i], code / 16777215.0, 1e-6) << i << (c.is_big ? " big" : " little");
    }
  }
}

/// The same pixels by JPEG and by LZW.
TEST(PortableTiff, JpegInTiffKeepsItsAlpha) {
  test::record_input("TIFF", "JPEG with alpha", "read");
  struct Case {
    uint16_t photometric, samples;
    std::vector<uint8_t> pixel;
  };
  for (const Case& c : {Case{PHOTOMETRIC_MINISBLACK, 1, {200}}, Case{PHOTOMETRIC_MINISBLACK, 2, {200, 60}},
                        Case{PHOTOMETRIC_RGB, 3, {200, 150, 90}}, Case{PHOTOMETRIC_RGB, 4, {200, 150, 90, 60}}}) {
    const auto read_by = [&](uint16_t compression) {
      const uint16_t straight[] = {EXTRASAMPLE_UNASSALPHA};
      const auto tags = [&](TIFF* tiff) {
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
        if (compression == COMPRESSION_JPEG) TIFFSetField(tiff, TIFFTAG_JPEGQUALITY, 100);
        if (c.samples % 2 == 0) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, straight);
      };
      return first_pixel(written_tiff("alpha", c.photometric, c.samples, tags, c.pixel));
    };
    const std::vector<float> expected = read_by(COMPRESSION_LZW), found = read_by(COMPRESSION_JPEG);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1.5 / 255) << c.samples << ' ' << i;
  }
}

}  // namespace
}  // namespace velour::portable_picture_test
