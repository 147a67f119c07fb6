// The zip's picture libraries, and libtiff, against OpenImageIO: every kind of file gives the same values, or both
// refuse it.
#include <cstdio>  // jpeglib.h needs it
#include <cstring>

#include <jpeglib.h>

#include <png.h>
#include <tiffio.h>
#include <zlib.h>
#include <csetjmp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/error.h"
#include "base/file.h"
#include "base/private_library.h"
#include "image/open_picture.h"
#include "image/openimageio/openimageio_module.h"
#include "math/sphere/random.h"
#include "support/inputs.h"
#include "support/picture_bytes.h"
#include "support/test_data.h"

namespace velour::portable_picture_test {
namespace {

constexpr int kStripRows = 8;
constexpr int kWidth = 45, kHeight = 37;  // no multiple of a tile, a strip or a block of JPEG

struct Decoded {
  int width = 0, height = 0, channels = 0, alpha = -1;
  bool integers = false;
  std::vector<float> values;
  std::string error;
};

Decoded allocated(const PictureHeader& header) {
  return {header.width,
          header.height,
          header.channels,
          header.alpha_channel,
          header.integers,
          std::vector<float>(static_cast<size_t>(header.width * header.height * header.channels)),
          ""};
}

Decoded refused(const std::string& error) {
  Decoded decoded;
  decoded.error = error;
  return decoded;
}

Decoded by_portable(const std::string& path) {
  try {
    const PictureFormat format = picture_format_of(read_file_head(path, kPictureHeadBytes), path);
    const auto picture = format == PictureFormat::tiff ? open_tiff(path) : open_integers(path, format);
    Decoded decoded = allocated(picture->header());
    picture->read(decoded.values);
    return decoded;
  } catch (const Error& error) {
    return refused(error.what());
  }
}

Decoded by_openimageio(const std::string& path, const char* reader) {
  static const auto& library = *new PrivateLibrary("libvelour_openimageio.so", "build all.");
  const OpenImageIoModule& module = *library.function<decltype(velour_openimageio_2)>("velour_openimageio_2")();
  std::string error;
  OpenImageIoModule::File* file = module.open(path, reader, error);
  if (file == nullptr) return refused(error);
  Decoded decoded = allocated(module.header(*file));
  if (!module.read(*file, decoded.values, error)) decoded.error = error.empty() ? "?" : error;
  module.close(file);
  return decoded;
}

void expect_same(const std::string& path, const char* reader, const std::string& what) {
  const Decoded portable = by_portable(path), expected = by_openimageio(path, reader);
  ASSERT_EQ(expected.error, "") << what;
  ASSERT_EQ(portable.error, "") << what;
  EXPECT_EQ(portable.width, expected.width) << what;
  EXPECT_EQ(portable.height, expected.height) << what;
  ASSERT_EQ(portable.channels, expected.channels) << what;
  EXPECT_EQ(portable.alpha, expected.alpha) << what;
  EXPECT_EQ(portable.integers, expected.integers) << what;
  size_t differ = 0;
  float most = 0;
  for (size_t i = 0; i < expected.values.size(); ++i) {
    const float difference = std::abs(portable.values[i] - expected.values[i]);
    differ += difference > 2e-7f * std::max(1.0f, std::abs(expected.values[i]));
    most = std::max(most, difference);
  }
  EXPECT_EQ(differ, 0u) << what << ": " << most;
}

std::vector<uint8_t> random_bytes(size_t count, uint64_t seed) {
  std::vector<uint8_t> bytes(count);
  RandomStream random(seed, 0, 0);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.next() * 256.0f);
  return bytes;
}

/// A smooth picture of 8 bits, as photographs are.
std::vector<uint8_t> gradient(int channels) {
  std::vector<uint8_t> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < channels; ++c)
        values.push_back(static_cast<uint8_t>((x * (5 - c) + y * (c + 1) * 2 + (x * y * (c + 1)) / 40) % 256));
  return values;
}

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

TEST(PortablePicture, TiffIsThatOfOpenImageIo) {
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

TEST(PortablePicture, TiffWhoseZeroIsWhiteIsInvertedAtEveryDepth) {
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
TEST(PortablePicture, CmykKeepsItsColorsBesideFurtherSamples) {
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

TEST(PortablePicture, SamplesBeyondTheColorsAreNoted) {
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

TEST(PortablePicture, PalettesOfBytesAreRead) {
  const auto map = [](TIFF* tiff) {
    std::vector<uint16_t> colors(256, 51);
    TIFFSetField(tiff, TIFFTAG_COLORMAP, colors.data(), colors.data(), colors.data());
  };
  EXPECT_NEAR(first_pixel(written_tiff("bytes", PHOTOMETRIC_PALETTE, 1, map, {7}))[1], 0.2, 1e-6);
}

/// Light of 0.05 to 20 keeps its brightness and its color.
TEST(PortablePicture, LogLuvKeepsItsRange) {
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

TEST(PortablePicture, TheFirstPageOfFullSizeIsRead) {
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
TEST(PortablePicture, TurnedTiffIsReadAsItIsStored) {
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

struct JpegCase {
  const char* name;
  int channels;
  J_COLOR_SPACE from, stored;
  int sampling = 1;  // of the first component along both sides
  bool is_progressive = false;
  unsigned restart = 0;
};

std::string written(const JpegCase& c) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = kWidth;
  info.image_height = kHeight;
  info.input_components = c.channels;
  info.in_color_space = c.from;
  jpeg_set_defaults(&info);
  jpeg_set_colorspace(&info, c.stored);
  jpeg_set_quality(&info, 85, TRUE);
  info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = c.sampling;
  info.restart_interval = c.restart;
  if (c.is_progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  std::vector<uint8_t> pixels = gradient(c.channels);
  for (int y = 0; y < kHeight; ++y) {
    JSAMPROW row = &pixels[static_cast<size_t>(y * kWidth * c.channels)];
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  const std::string path = test::scratch_folder() / (std::string(c.name) + ".jpg");
  write_file(path, std::span(bytes, size));
  std::free(bytes);
  return path;
}

TEST(PortablePicture, JpegIsThatOfOpenImageIo) {
  const JpegCase kCases[] = {
      {"gray", 1, JCS_GRAYSCALE, JCS_GRAYSCALE},
      {"444", 3, JCS_RGB, JCS_YCbCr},
      {"420", 3, JCS_RGB, JCS_YCbCr, 2},
      {"420 progressive", 3, JCS_RGB, JCS_YCbCr, 2, true},
      {"restarts", 3, JCS_RGB, JCS_YCbCr, 2, false, 3},
      {"rgb", 3, JCS_RGB, JCS_RGB},
      {"cmyk", 4, JCS_CMYK, JCS_CMYK},
      {"ycck", 4, JCS_CMYK, JCS_YCCK, 2},
  };
  for (const JpegCase& c : kCases) expect_same(written(c), "jpeg", c.name);
  test::record_input("JPEG", "gray, YCbCr, RGB, CMYK, YCCK; subsampled, progressive, with restarts",
                     "read, by both builds alike");
}

struct PngCase {
  int color_type, bits;
  bool is_interlaced = false, has_transparency = false;
};

std::string written(const PngCase& c, size_t number) {
  const std::string path = test::scratch_folder() / (std::to_string(number) + ".png");
  FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, kWidth, kHeight, c.bits, c.color_type,
               c.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> palette;
  for (int i = 0; i < 1 << std::min(c.bits, 8); ++i) {
    palette.push_back({static_cast<png_byte>(i * 37), static_cast<png_byte>(i * 91), static_cast<png_byte>(255 - i)});
  }
  const bool is_palette = c.color_type == PNG_COLOR_TYPE_PALETTE;
  if (is_palette) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_byte alphas[] = {0, 128};
  png_color_16 clear{};
  if (c.has_transparency) png_set_tRNS(png, info, alphas, is_palette ? 2 : 0, is_palette ? nullptr : &clear);
  png_write_info(png, info);
  std::vector<uint8_t> pixels = random_bytes(png_get_rowbytes(png, info) * kHeight, number);
  std::vector<png_bytep> rows;
  for (int y = 0; y < kHeight; ++y) rows.push_back(&pixels[static_cast<size_t>(y) * png_get_rowbytes(png, info)]);
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return path;
}

TEST(PortablePicture, PngIsThatOfOpenImageIo) {
  std::vector<PngCase> cases;
  const std::pair<int, std::vector<int>> kTypes[] = {{PNG_COLOR_TYPE_GRAY, {1, 2, 4, 8, 16}},
                                                     {PNG_COLOR_TYPE_GRAY_ALPHA, {8, 16}},
                                                     {PNG_COLOR_TYPE_PALETTE, {1, 2, 4, 8}},
                                                     {PNG_COLOR_TYPE_RGB, {8, 16}},
                                                     {PNG_COLOR_TYPE_RGB_ALPHA, {8, 16}}};
  for (const auto& [type, all_bits] : kTypes) {
    for (const int bits : all_bits) {
      cases.push_back({type, bits});
      cases.push_back({type, bits, true});
      if ((type & PNG_COLOR_MASK_ALPHA) == 0) cases.push_back({type, bits, false, true});
    }
  }
  for (size_t i = 0; i < cases.size(); ++i) {
    const PngCase& c = cases[i];
    expect_same(written(c, i), "png",
                "type " + std::to_string(c.color_type) + ", " + std::to_string(c.bits) + " bits" +
                    (c.is_interlaced ? ", interlaced" : "") + (c.has_transparency ? ", tRNS" : ""));
  }
  test::record_input("PNG", "gray, palette, RGB, with alpha or tRNS; 1 to 16 bits, interlaced",
                     "read, by both builds alike");
}

TEST(PortablePicture, AWrongChecksumIsRefused) {
  const std::string path = written({PNG_COLOR_TYPE_RGB, 8}, 999);
  std::vector<uint8_t> bytes = read_file(path);
  bytes[bytes.size() / 2] ^= 1;  // in the pixels
  write_file(path, bytes);
  EXPECT_NE(by_portable(path).error.find("CRC"), std::string::npos);
  EXPECT_NE(by_openimageio(path, "png").error, "");
}

TEST(PortablePicture, DamagedTiffIsRefused) {
  const std::string path = written(TiffCase("whole", PHOTOMETRIC_RGB, 3, 16).packed(COMPRESSION_LZW));
  const std::vector<uint8_t> whole = read_file(path);
  for (size_t size = 0; size < whole.size(); size += std::max<size_t>(1, whole.size() / 50)) {
    write_file(path, std::span(whole).first(size));
    EXPECT_NE(by_portable(path).error, "") << size;
  }
}

/// A strip of 120 MB in a file of a few bytes. libtiff would name the strip that it failed to read into it.
TEST(PortablePicture, TiffOfMoreSamplesThanItsBytesHoldAllocatesNothing) {
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

std::string header_refusal(const std::string& path) {
  try {
    read_picture_header(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// 4096 x 4096 pixels of one color take 2 to 17 KB: DEFLATE packs what a pixel stores, not the colors that it stands
/// for.
TEST(PortablePicture, PngsOfOneIndexedColorAreRead) {
  constexpr int kSide = 4096;
  struct Case {
    int color_type, bits, colors_with_alpha;
  };
  for (const Case& c :
       {Case{PNG_COLOR_TYPE_PALETTE, 8, 0}, Case{PNG_COLOR_TYPE_PALETTE, 1, 2}, Case{PNG_COLOR_TYPE_PALETTE, 4, 2},
        Case{PNG_COLOR_TYPE_GRAY, 2, 0}, Case{PNG_COLOR_TYPE_GRAY, 8, 1}, Case{PNG_COLOR_TYPE_RGB, 8, 0}}) {
    SCOPED_TRACE(std::to_string(c.color_type) + ", " + std::to_string(c.bits) + " bits");
    const size_t pixel_bits = static_cast<size_t>(c.bits) * (c.color_type == PNG_COLOR_TYPE_RGB ? 3 : 1);
    const size_t row = kSide * pixel_bits / 8 + 1;
    std::vector<uint8_t> pixels(row * kSide), data(compressBound(row * kSide));
    auto size = static_cast<uLongf>(data.size());
    ASSERT_EQ(compress2(data.data(), &size, pixels.data(), pixels.size(), 9), Z_OK);
    data.resize(size);
    test::Bytes png;
    test::append(png, "\x89PNG\r\n\x1a\n");
    const auto add = [&](std::string_view type, const test::Bytes& content) {
      test::Bytes chunk(type.begin(), type.end());
      chunk.insert(chunk.end(), content.begin(), content.end());
      test::append(png, content.size(), 4);
      png.insert(png.end(), chunk.begin(), chunk.end());
      test::append(png, test::crc_of(chunk), 4);
    };
    test::Bytes header;
    test::append(header, kSide, 4);
    test::append(header, kSide, 4);
    for (const int field : {c.bits, c.color_type, 0, 0, 0}) header.push_back(static_cast<uint8_t>(field));
    add("IHDR", header);
    const bool is_palette = c.color_type == PNG_COLOR_TYPE_PALETTE;
    if (is_palette) add("PLTE", {10, 20, 30, 40, 50, 60});
    if (c.colors_with_alpha > 0) add("tRNS", test::Bytes(2, 0));
    add("IDAT", data);
    add("IEND", {});
    const std::string path = test::scratch_folder() / "one_color.png";
    write_file(path, png);
    EXPECT_EQ(header_refusal(path), "");
    png[18] = 0x80;  // 32768 x 4096
    write_file(path, png);
    EXPECT_NE(header_refusal(path).find("more than the file can contain"), std::string::npos);
  }
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

TEST(PortablePicture, BlankPagesOfFaxesAreRead) {
  test::record_input("TIFF", "CCITT Group 3 and 4, also blank pages", "read");
  EXPECT_EQ(header_refusal(blank_page(10000, COMPRESSION_CCITTFAX4)), "");
  const Decoded small = by_portable(blank_page(300, COMPRESSION_CCITTFAX4));
  EXPECT_EQ(small.values, std::vector<float>(300 * 300, 1.0f)) << small.error;
  EXPECT_NE(header_refusal(blank_page(30000, COMPRESSION_CCITTFAX4, true)).find("more than the file can contain"),
            std::string::npos);
}

/// One strip of 67 MB in a few KB, which DEFLATE could not reach: of Zstandard a few bytes could be gigabytes.
TEST(PortablePicture, LargeStripsOfOneValueAreReadUnlessTheirCodeIsADenseOne) {
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

TEST(PortablePicture, SamplesOf24BitsAreReadInBothByteOrders) {
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
TEST(PortablePicture, JpegInTiffKeepsItsAlpha) {
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

TEST(PortablePicture, ColorsBeyondThePaletteAreBlack) {
  test::record_input("PNG", "indices beyond the palette", "black");
  constexpr std::ptrdiff_t kPaletteChunk = 12 + 3 * 256;
  for (const bool has_transparency : {false, true}) {
    const std::string path = written({PNG_COLOR_TYPE_PALETTE, 8, false, has_transparency}, 998);
    std::vector<uint8_t> png = read_file(path);
    const auto palette = std::ranges::search(png, std::string_view("PLTE")).begin() - 4;
    png.erase(palette, palette + kPaletteChunk);
    write_file(path, test::with_chunk(png, "PLTE", {10, 20, 30, 40, 50, 60}));
    expect_same(path, "png", has_transparency ? "with tRNS" : "opaque");
    const Decoded decoded = by_portable(path);
    const auto channels = static_cast<size_t>(decoded.channels);
    size_t black = 0;
    for (size_t i = 0; i < decoded.values.size(); i += channels) {
      black += std::all_of(&decoded.values[i], &decoded.values[i] + 3, [](float v) { return v == 0; });
    }
    EXPECT_GT(black, decoded.values.size() / channels * 9 / 10);
  }
}

TEST(PortablePicture, JpegIsRefusedForLostDataOnly) {
  test::record_input("JPEG", "odd parameters of a scan, bytes between segments", "read");
  test::record_input("JPEG", "an early end", "refused");
  const std::string path = written(JpegCase{"warned", 3, JCS_RGB, JCS_YCbCr, 2});
  const std::vector<uint8_t> plain = read_file(path);
  const std::vector<float> expected = by_portable(path).values;
  const auto place_of = [](const std::vector<uint8_t>& bytes, uint8_t marker) {
    const uint8_t text[] = {0xff, marker};
    return std::ranges::search(bytes, text).begin() - bytes.begin();
  };
  std::vector<uint8_t> odd_scan = plain, spaced = plain;
  constexpr std::ptrdiff_t kLastCoefficient = 2 + 2 + 1 + 2 * 3 + 1;  // marker, length, count, three components, first
  uint8_t& last = odd_scan[static_cast<size_t>(place_of(plain, 0xda) + kLastCoefficient)];
  ASSERT_EQ(last, 63);
  last = 0;
  spaced.insert(spaced.begin() + place_of(plain, 0xdb), 3, uint8_t{0});
  for (const std::vector<uint8_t>& bytes : {odd_scan, spaced}) {
    write_file(path, bytes);
    expect_same(path, "jpeg", &bytes == &odd_scan ? "odd scan" : "bytes between segments");
    EXPECT_EQ(by_portable(path).values, expected);
  }
  for (const std::vector<uint8_t>& bytes : {plain, odd_scan, spaced}) {
    write_file(path, std::span(bytes).first(bytes.size() - 100));
    EXPECT_NE(by_portable(path).error, "");
    EXPECT_NE(by_openimageio(path, "jpeg").error, "");
  }
}

}  // namespace
}  // namespace velour::portable_picture_test
