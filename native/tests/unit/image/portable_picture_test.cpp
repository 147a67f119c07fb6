// The zip's libraries for JPEG and PNG against OpenImageIO: every kind of file gives the same values, or both refuse
// it.
#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include <png.h>
#include <zlib.h>
#include <csetjmp>

#include "support/inputs.h"
#include "support/picture_bytes.h"
#include "support/test_data.h"
#include "unit/image/portable_pictures.h"

namespace velour::portable_picture_test {
namespace {

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
