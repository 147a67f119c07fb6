// Pictures decoded by the zip's picture libraries, and by OpenImageIO.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/private_library.h"
#include "image/open_picture.h"
#include "image/openimageio/openimageio_module.h"
#include "math/sphere/random.h"

namespace velour::portable_picture_test {

inline constexpr int kStripRows = 8;
inline constexpr int kWidth = 45, kHeight = 37;  // no multiple of a tile, a strip or a block of JPEG

struct Decoded {
  int width = 0, height = 0, channels = 0, alpha = -1;
  bool integers = false;
  std::vector<float> values;
  std::string error;
};

inline Decoded allocated(const PictureHeader& header) {
  return {header.width,
          header.height,
          header.channels,
          header.alpha_channel,
          header.integers,
          std::vector<float>(static_cast<size_t>(header.width * header.height * header.channels)),
          ""};
}

inline Decoded refused(const std::string& error) {
  Decoded decoded;
  decoded.error = error;
  return decoded;
}

inline Decoded by_portable(const std::string& path) {
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

inline Decoded by_openimageio(const std::string& path, const char* reader) {
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

inline void expect_same(const std::string& path, const char* reader, const std::string& what) {
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

inline std::vector<uint8_t> random_bytes(size_t count, uint64_t seed) {
  std::vector<uint8_t> bytes(count);
  RandomStream random(seed, 0, 0);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.next() * 256.0f);
  return bytes;
}

/// A smooth picture of 8 bits, as photographs are.
inline std::vector<uint8_t> gradient(int channels) {
  std::vector<uint8_t> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < channels; ++c)
        values.push_back(static_cast<uint8_t>((x * (5 - c) + y * (c + 1) * 2 + (x * y * (c + 1)) / 40) % 256));
  return values;
}

inline std::string header_refusal(const std::string& path) {
  try {
    read_picture_header(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace velour::portable_picture_test
