// EXIF orientation of PNG and JPEG pictures, and formats that are not read.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "image/open_picture.h"
#include "image/picture.h"
#include "support/inputs.h"
#include "support/picture_bytes.h"
#include "support/test_data.h"

namespace velour::orientation_test {
namespace {

using test::append;
using test::Bytes;

/// A directory of two entries, the second of which is the orientation.
Bytes exif_of(int orientation, bool big) {
  Bytes bytes;
  for (const char c : {big ? 'M' : 'I', big ? 'M' : 'I'}) bytes.push_back(static_cast<uint8_t>(c));
  append(bytes, 42, 2, big);
  append(bytes, 8, 4, big);  // place of the directory
  append(bytes, 2, 2, big);
  for (const auto& [tag, value] : {std::pair(271, 7), std::pair(274, orientation)}) {
    append(bytes, static_cast<uint64_t>(tag), 2, big);
    append(bytes, 3, 2, big);
    append(bytes, 1, 4, big);
    append(bytes, static_cast<uint64_t>(value), 2, big);
    append(bytes, 0, 2, big);
  }
  append(bytes, 0, 4, big);
  return bytes;
}

/// Pixel (0, 0) of the stored rows is where the orientation says (EXIF 2.3, 4.6.4 A), one is beside it along the row.
TEST(PictureOrientation, FollowsExif) {
  test::record_input("PNG", "EXIF orientation", "turned upright");
  struct Ends {
    int orientation, first_x, first_y, step_x, step_y;  // of a picture seen, y from the top
  };
  constexpr int kStoredWidth = 5, kStoredHeight = 3;
  const Ends all[] = {{1, 0, 0, 1, 0}, {2, 4, 0, -1, 0}, {3, 4, 2, -1, 0}, {4, 0, 2, 1, 0},
                      {5, 0, 0, 0, 1}, {6, 2, 0, 0, 1},  {7, 2, 4, 0, -1}, {8, 0, 4, 0, -1}};
  const auto folder = test::scratch_folder();
  Picture picture{kStoredWidth, kStoredHeight, 1, std::vector<float>(kStoredWidth * kStoredHeight, 0.0f)};
  const std::string plain = folder / "plain.png", turned = folder / "turned.png";
  picture.pixels[kStoredWidth * (kStoredHeight - 1)] = 1.0f;            // the upper left one
  picture.pixels[kStoredWidth * (kStoredHeight - 1) + 1] = 0.2140411f;  // beside it
  write_picture(plain, picture);
  for (const Ends& ends : all) {
    SCOPED_TRACE(ends.orientation);
    write_file(turned,
               test::with_chunk(read_file(plain), "eXIf", exif_of(ends.orientation, ends.orientation % 2 == 0)));
    const Picture found = read_picture(turned), header = read_picture_header(turned);
    const bool swapped = ends.orientation > 4;
    ASSERT_EQ(found.width, swapped ? kStoredHeight : kStoredWidth);
    ASSERT_EQ(found.height, swapped ? kStoredWidth : kStoredHeight);
    EXPECT_EQ(header.width, found.width);
    const auto seen = [&](int x, int y) { return found.pixel(x, found.height - 1 - y)[0]; };
    EXPECT_EQ(seen(ends.first_x, ends.first_y), 1.0f);
    EXPECT_NEAR(seen(ends.first_x + ends.step_x, ends.first_y + ends.step_y), 0.2140411f, 0.003f);
    const Picture stored = read_picture(turned, {.as_stored = true});
    EXPECT_EQ(stored.width, kStoredWidth);
    EXPECT_EQ(stored.warnings.size(), ends.orientation == 1 ? 0u : 1u);
  }
}

TEST(PictureOrientation, IsFoundBehindManyChunks) {
  const auto folder = test::scratch_folder();
  const std::string path = folder / "a.png";
  write_picture(path, {2, 1, 1, {0.0f, 1.0f}});
  const Bytes png = test::with_chunk(read_file(path), "eXIf", exif_of(3, true));
  constexpr std::ptrdiff_t kHeaderEnd = 8 + 12 + 13;
  Bytes chunk = test::with_chunk(png, "teSt", {}), result(png.begin(), png.begin() + kHeaderEnd);
  for (int i = 0; i < 5000; ++i)
    result.insert(result.end(), chunk.begin() + kHeaderEnd, chunk.begin() + kHeaderEnd + 12);
  result.insert(result.end(), png.begin() + kHeaderEnd, png.end());
  write_file(path, result);
  EXPECT_EQ(exif_orientation(PictureFormat::png, path), Orientation::turned_180);
}

TEST(PictureOrientation, OfJpeg) {
  test::record_input("JPEG", "EXIF orientation", "turned upright");
  const auto folder = test::scratch_folder();
  const auto written = [&](const Bytes& exif) {
    Bytes jpeg{0xff, 0xd8, 0xff, 0xe0, 0, 4, 9, 9, 0xff, 0xff, 0xe1};  // a segment, a fill byte, EXIF
    append(jpeg, exif.size() + 8, 2, true);
    for (const char c : std::string("Exif\0\0", 6)) jpeg.push_back(static_cast<uint8_t>(c));
    jpeg.insert(jpeg.end(), exif.begin(), exif.end());
    write_file(folder / "a.jpg", jpeg);
    return jpeg;
  };
  written(exif_of(9, false));
  EXPECT_EQ(exif_orientation(PictureFormat::jpeg, folder / "a.jpg"), Orientation::normal);
  written(exif_of(3, false));
  EXPECT_EQ(exif_orientation(PictureFormat::jpeg, folder / "a.jpg"), Orientation::turned_180);
  const Bytes whole = written(exif_of(6, true));
  EXPECT_EQ(exif_orientation(PictureFormat::jpeg, folder / "a.jpg"), Orientation::turned_cw);
  for (size_t size = 0; size < whole.size() - 16; ++size) {
    write_file(folder / "cut", std::span(whole).first(size));
    EXPECT_EQ(exif_orientation(PictureFormat::jpeg, folder / "cut"), Orientation::normal) << size;
  }
}

TEST(PictureFormats, OthersAreRefusedByName) {
  test::record_input("DPX, Cineon, IFF, Photoshop, GIF, WebP, PPM and others", "any", "refused by name");
  const std::string path = test::scratch_folder() / "a.png";
  const std::pair<std::string, std::string> others[] = {
      {"FOR4", "IFF"},   {"SDPX", "DPX"},
      {"XPDS", "DPX"},   {"8BPS", "Photoshop"},
      {"GIF89a", "GIF"}, {"RIFF1234WEBP", "WebP"},
      {"P6\n", "PPM"},   {"nothing at all", "not in a supported image format"},
      {"", "empty file"}};
  for (const auto& [head, name] : others) {
    const std::string text = head.empty() ? head : head + std::string(600, '\0');
    write_file(path, Bytes(text.begin(), text.end()));
    try {
      read_picture(path);
      ADD_FAILURE() << head;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("OpenEXR, Radiance HDR, PNG, JPEG, TIFF or BMP"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace velour::orientation_test
