// Color profiles of PNG and JPEG files.
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cmath>

#include "base/file.h"
#include "image/open_picture.h"
#include "image/picture.h"
#include "support/inputs.h"
#include "support/picture_bytes.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::color_space_test {
namespace {

using test::append;
using test::Bytes;
using Primaries = std::array<std::array<double, 3>, 3>;

constexpr Primaries kSrgb = {{{0.4361, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1431, 0.0606, 0.7141}}};
constexpr Primaries kAdobe = {{{0.6097, 0.3111, 0.0195}, {0.2053, 0.6257, 0.0609}, {0.1492, 0.0632, 0.7446}}};

Bytes tag_of(std::string_view type) {
  Bytes tag;
  append(tag, type);
  append(tag, 0, 4);
  return tag;
}

Bytes gamma_curve(double gamma) {
  Bytes tag = tag_of("curv");
  append(tag, 1, 4);
  append(tag, static_cast<uint64_t>(std::lround(gamma * 256)), 2);
  return tag;
}

Bytes table_curve(double gamma) {
  constexpr int kEntries = 256;
  Bytes tag = tag_of("curv");
  append(tag, kEntries, 4);
  for (int i = 0; i < kEntries; ++i)
    append(tag, static_cast<uint64_t>(std::lround(65535 * std::pow(i / (kEntries - 1.0), gamma))), 2);
  return tag;
}

/// The curve of sRGB as a function (IEC 61966-2-1).
Bytes srgb_curve() {
  Bytes tag = tag_of("para");
  append(tag, 3, 2);
  append(tag, 0, 2);
  for (const double parameter : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045})
    append(tag, static_cast<uint64_t>(std::lround(parameter * 65536)), 4);
  return tag;
}

using Tags = std::vector<std::pair<std::string, Bytes>>;

Bytes profile_of(std::string_view space, const std::string& name, Tags tags) {
  Bytes description = tag_of("desc");
  append(description, name.size() + 1, 4);
  append(description, name);
  append(description, 0, 1);
  tags.emplace_back("desc", description);
  Bytes table, data;
  append(table, tags.size(), 4);
  for (const auto& [signature, tag] : tags) {
    append(table, signature);
    append(table, 128 + 4 + 12 * tags.size() + data.size(), 4);
    append(table, tag.size(), 4);
    data.insert(data.end(), tag.begin(), tag.end());
  }
  Bytes profile(16);
  append(profile, space);
  profile.resize(36);
  append(profile, "acsp");
  profile.resize(128);
  profile.insert(profile.end(), table.begin(), table.end());
  profile.insert(profile.end(), data.begin(), data.end());
  return profile;
}

Bytes display(const std::string& name, const Primaries& primaries, const Bytes& curve) {
  Tags tags;
  for (size_t c = 0; c < 3; ++c) {
    Bytes tag = tag_of("XYZ ");
    for (const double value : primaries[c]) append(tag, static_cast<uint64_t>(std::lround(value * 65536)), 4);
    tags.emplace_back(std::string(1, "rgb"[c]) + "XYZ", tag);
    tags.emplace_back(std::string(1, "rgb"[c]) + "TRC", curve);
  }
  return profile_of("RGB ", name, tags);
}

TEST(ColorSpace, ProfilesAreComparedByTheirNumbers) {
  for (const Bytes& curve : {gamma_curve(2.2), table_curve(2.2), srgb_curve()}) {
    EXPECT_EQ(other_color_space(display("My monitor", kSrgb, curve)), "");
    EXPECT_EQ(other_color_space(display("Adobe RGB (1998)", kAdobe, curve)), "'Adobe RGB (1998)'");
  }
  EXPECT_EQ(other_color_space(display("Linear sRGB", kSrgb, gamma_curve(1))), "'Linear sRGB'");
  EXPECT_EQ(other_color_space(profile_of("RGB ", "sRGB v4", {})), "");
  EXPECT_EQ(other_color_space(profile_of("GRAY", "Gamma 2.2", {{"kTRC", gamma_curve(2.2)}})), "");
  EXPECT_EQ(other_color_space(profile_of("GRAY", "Dot Gain 20%", {{"kTRC", gamma_curve(1.75)}})), "'Dot Gain 20%'");
  EXPECT_EQ(other_color_space(profile_of("CMYK", "", {})), "without a name");
}

TEST(ColorSpace, DamagedProfilesAreNone) {
  const Bytes whole = display("Adobe RGB (1998)", kAdobe, gamma_curve(2.2));
  for (size_t size = 0; size < whole.size(); ++size) other_color_space(std::span(whole).first(size));
  EXPECT_EQ(other_color_space(std::span(whole).first(39)), "");
}

class PngColorSpace : public ::testing::Test {
 protected:
  PngColorSpace() {
    write_picture(path_, {2, 2, 3, std::vector<float>(12, 0.5f)});
    plain_ = critical_chunks(read_file(path_));
  }

  /// The value of the warning after chunks of these types were added, the last of them first.
  std::string space_with(std::initializer_list<std::pair<std::string, Bytes>> chunks) {
    Bytes png = plain_;
    for (const auto& [type, data] : chunks) png = test::with_chunk(png, type, data);
    write_file(path_, png);
    const Picture picture = read_picture_header(path_);
    const Warning* found = test::find_warning(picture.warnings, WarningCode::color_space_ignored);
    return found == nullptr ? "" : test::value_of<std::string>(*found, "space");
  }

  /// Without what libraries add.
  static Bytes critical_chunks(const Bytes& png) {
    Bytes result(png.begin(), png.begin() + 8);
    for (size_t at = 8, size; at < png.size(); at += size) {
      size = 12 + (size_t{png[at + 2]} << 8 | png[at + 3]);
      const auto begin = png.begin() + static_cast<std::ptrdiff_t>(at);
      if (std::isupper(png[at + 4]) != 0) result.insert(result.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
    }
    return result;
  }

  static Bytes gamma(uint32_t value) {
    Bytes data;
    append(data, value, 4);
    return data;
  }

  const std::filesystem::path folder_ = test::scratch_folder();
  const std::string path_ = folder_ / "a.png";
  Bytes plain_;
};

TEST_F(PngColorSpace, IsStated) {
  test::record_input("PNG", "color profile other than sRGB (iCCP, gAMA, cHRM, cICP)", "read as sRGB, with a warning");
  EXPECT_EQ(space_with({}), "");
  EXPECT_EQ(space_with({{"gAMA", gamma(45455)}}), "");
  EXPECT_EQ(space_with({{"gAMA", gamma(100000)}}), "of gamma 1");
  EXPECT_EQ(space_with({{"gAMA", gamma(55556)}}), "of gamma 1.8");
  EXPECT_EQ(space_with({{"gAMA", gamma(10000)}}), "of gamma 10");
  EXPECT_EQ(space_with({{"gAMA", gamma(100000)}, {"sRGB", {0}}}), "");
  EXPECT_EQ(space_with({{"cICP", {1, 13, 0, 1}}}), "");
  EXPECT_EQ(space_with({{"cICP", {9, 16, 0, 1}}}), "of code points 9/16");
  Bytes primaries;
  for (const uint32_t value : {31270, 32900, 64000, 33000, 21000, 71000, 15000, 6000}) append(primaries, value, 4);
  EXPECT_EQ(space_with({{"cHRM", primaries}}), "of other primaries (cHRM)");
}

TEST(ColorSpace, OfJpeg) {
  test::record_input("JPEG, TIFF", "color profile other than sRGB", "read as sRGB, with a warning");
  const Bytes profile = display("Adobe RGB (1998)", kAdobe, gamma_curve(2.2));
  const std::string path = test::scratch_folder() / "a.jpg";
  const auto segment = [](uint8_t number, std::span<const uint8_t> part) {
    Bytes bytes{0xff, 0xe2};
    append(bytes, part.size() + 16, 2);
    append(bytes, std::string_view("ICC_PROFILE\0", 12));
    append(bytes, number, 1);
    append(bytes, 2, 1);
    bytes.insert(bytes.end(), part.begin(), part.end());
    return bytes;
  };
  Bytes jpeg{0xff, 0xd8};
  const std::span whole(profile);
  for (const Bytes& part : {segment(2, whole.subspan(100)), segment(1, whole.first(100))})
    jpeg.insert(jpeg.end(), part.begin(), part.end());
  jpeg.resize(jpeg.size() + 20);
  write_file(path, jpeg);
  EXPECT_EQ(other_color_space(PictureFormat::jpeg, path), "'Adobe RGB (1998)'");
  for (size_t size = 0; size < jpeg.size(); size += 7) {
    write_file(path, std::span(jpeg).first(size));
    other_color_space(PictureFormat::jpeg, path);
  }
}

}  // namespace
}  // namespace velour::color_space_test
