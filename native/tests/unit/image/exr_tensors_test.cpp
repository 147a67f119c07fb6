#include "image/tensors/exr_tensors.h"

#include <gtest/gtest.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStdIO.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "base/error.h"
#include "image/formats/exr_scan.h"
#include "image/tensors/tensor_pack.h"

namespace velour::exr_tensors_test {
namespace {

Tensor ramp(std::vector<uint64_t> shape) {
  uint64_t count = 1;
  for (const uint64_t extent : shape) count *= extent;
  Tensor tensor{std::move(shape), {}};
  for (uint64_t i = 0; i < count; ++i) tensor.data.push_back(static_cast<float>(i) * 0.37f - 3.0f);
  return tensor;
}

// A copy would point to the pixels of the original.
static_assert(!std::is_copy_constructible_v<TensorPixels> && !std::is_copy_assignable_v<TensorPixels>);
static_assert(std::is_nothrow_move_constructible_v<TensorPixels>);

TensorFile sample_file() {
  TensorFile file;
  file.attributes = {{"velour.kind", "test"}, {"velour.note", "Grüße"}};
  file.tensors = {{"cube", ramp({4, 5, 6})}, {"lobes.center", ramp({7, 3})},
                  {"one", ramp({})},         {"rows.of.color", ramp({2, 40, 9, 3})},
                  {"tall", ramp({100, 1})},  {"wide", ramp({1000})}};
  file.tensors["small"] = {{2, 2}, {1, 0.5f, -3, 1024}, Precision::halves};
  return file;
}

void expect_equal(const TensorFile& a, const TensorFile& b) {
  EXPECT_EQ(a.attributes, b.attributes);
  ASSERT_EQ(a.tensors.size(), b.tensors.size());
  for (const auto& [name, tensor] : a.tensors) {
    const auto found = b.tensors.find(name);
    ASSERT_NE(found, b.tensors.end()) << name;
    EXPECT_EQ(tensor.shape, found->second.shape) << name;
    EXPECT_EQ(tensor.precision, found->second.precision) << name;
    EXPECT_EQ(0, std::memcmp(tensor.data.data(), found->second.data.data(), tensor.data.size() * 4)) << name;
  }
}

std::string refusal(const std::vector<uint8_t>& bytes) {
  try {
    decode_tensors(bytes, "hostile.velour");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Byte position just after the first attribute `name` of type `type` and its size field.
size_t value_of(const std::vector<uint8_t>& bytes, const std::string& name, const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  const auto at = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
  EXPECT_NE(at, bytes.end()) << name;
  return static_cast<size_t>(at - bytes.begin()) + key.size() + 4;
}

void put32(std::vector<uint8_t>& bytes, size_t at, uint32_t value) { std::memcpy(&bytes.at(at), &value, 4); }

TensorFile packed_file() {
  TensorFile file = sample_file();
  file.packed = true;
  file.attributes["velour.long"] = std::string(1000, 'x');
  file.tensors["maps"] = {{2, 2, 3}, {0, 1 / 256.0f, 0.5f, 3 / 256.0f, 0, 0.25f, 0, 0, 0, 0, 0, 0}, Precision::bytes};
  return file;
}

/// The same parts, the last one first.
std::vector<uint8_t> reversed(const std::vector<uint8_t>& bytes) {
  Imf::StdISStream from;
  from.str({bytes.begin(), bytes.end()});
  Imf::MultiPartInputFile in(from);
  std::vector<Imf::Header> headers;
  for (int i = in.parts(); i-- > 0;) headers.push_back(in.header(i));
  Imf::StdOSStream to;
  {
    Imf::MultiPartOutputFile out(to, headers.data(), in.parts());
    for (int i = 0; i < in.parts(); ++i) {
      Imf::InputPart part(in, in.parts() - 1 - i);
      Imf::OutputPart(out, i).copyPixels(part);
    }
  }
  const std::string text = to.str();
  return {text.begin(), text.end()};
}

/// Whether Blender has room for all parts where it makes room for the first.
bool first_covers_all(const std::vector<ExrPart>& parts) {
  return std::all_of(parts.begin(), parts.end(), [&](const ExrPart& part) {
    return part.width <= parts[0].width && part.height <= parts[0].height;
  });
}

TEST(ExrTensors, RoundTrip) {
  const auto bytes = encode_tensors(sample_file());
  EXPECT_TRUE(looks_like_exr(bytes));
  expect_equal(sample_file(), decode_tensors(bytes, "test"));
}

TEST(ExrTensors, PackedFilesAreRead) {
  const TensorFile back = decode_tensors(encode_tensors(packed_file()), "test");
  EXPECT_TRUE(back.packed);
  expect_equal(packed_file(), back);
}

TEST(ExrTensors, PartsAreReadInAnyOrder) {  // packs were the last ones once
  for (const TensorFile& file : {sample_file(), packed_file()}) {
    const auto bytes = reversed(encode_tensors(file));
    EXPECT_NE(scan_exr(bytes, "test")[0].name, scan_exr(encode_tensors(file), "test")[0].name);
    const TensorFile back = decode_tensors(bytes, "test");
    EXPECT_EQ(back.packed, file.packed);
    expect_equal(file, back);
  }
}

TEST(ExrTensors, PackedFilesShowTheSmallestTensorAndShortTexts) {
  TensorFile file = sample_file();
  file.packed = true;
  file.attributes["velour.long"] = std::string(257, 'x');
  file.attributes["velour.short"] = std::string(256, 'y');
  const auto bytes = encode_tensors(file);
  const auto parts = scan_exr(bytes, "test");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "pack");
  EXPECT_EQ(parts[0].channels, std::vector<std::string>{"value"});  // which Blender 3.4 leaves out
  EXPECT_EQ(parts[1].name, "one");
  const auto has = [&](const std::string& text) {
    return std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) != bytes.end();
  };
  EXPECT_TRUE(has(file.attributes["velour.short"]));
  EXPECT_FALSE(has(file.attributes["velour.long"]));
}

TEST(ExrTensors, PacksCoverTheTensorBesideThem) {
  for (const std::vector<uint64_t>& shape : {std::vector<uint64_t>{1000}, {500, 2}, {3, 3}, {40, 50, 3}}) {
    TensorFile file;
    file.packed = true;
    file.tensors["beside"] = ramp(shape);
    file.tensors["maps"] = {{1, 1}, {0}, Precision::bytes};
    const auto bytes = encode_tensors(file);
    EXPECT_TRUE(first_covers_all(scan_exr(bytes, "test")));
    expect_equal(file, decode_tensors(bytes, "test"));
  }
  EXPECT_FALSE(first_covers_all(scan_exr(reversed(encode_tensors(packed_file())), "test")));
}

TEST(ExrTensors, RowsOfPacksHoldUpTo16384Words) {
  TensorFile file;
  file.packed = true;
  file.tensors["a"] = ramp({1});
  Tensor& noise = file.tensors["noise"] = {{100000}, {}};
  for (uint32_t i = 0; i < 100000; ++i) noise.data.push_back(static_cast<float>(i * i * 2654435761u));
  const ExrPart pack = scan_exr(encode_tensors(file), "test")[0];
  EXPECT_GT(pack.width, 8192u);
  EXPECT_LE(pack.width, 16384u);
  EXPECT_GT(pack.height, 1u);
  expect_equal(file, decode_tensors(encode_tensors(file), "test"));
}

TEST(ExrTensors, PackedFilesAreSmaller) {
  TensorFile file;
  for (int i = 0; i < 20; ++i) file.tensors["some.tensor." + std::to_string(i)] = ramp({2, 3});
  const size_t parts = encode_tensors(file).size();
  file.packed = true;
  EXPECT_LT(5 * encode_tensors(file).size(), parts);
}

TEST(ExrTensors, BytesNeedAPack) {
  TensorFile file;
  file.tensors["maps"] = {{1, 1}, {0}, Precision::bytes};
  EXPECT_THROW(encode_tensors(file), Error);
}

TEST(ExrTensors, DamagedPacksAreRefused) {
  TensorFile file = sample_file();
  file.packed = true;
  const auto bytes = encode_tensors(file);
  const size_t end =
      bytes.size() - 16 - 4;  // behind the pack is one chunk of one value; its last word may be filled up
  for (size_t at = end - 1000; at < end; at += 7) {
    auto damaged = bytes;
    damaged[at] ^= 0x10;
    EXPECT_NE(refusal(damaged).find("hostile.velour: part 'pack': packed data"), std::string::npos) << at;
  }
}

TEST(ExrTensors, IntegersAreNoTensor) {
  TensorFile file = sample_file();
  file.packed = true;
  auto bytes = encode_tensors(file);
  const size_t at = value_of(bytes, "velour.coding", "string");
  const std::string coding = "velour.coding", shape = "velour.shape";
  const auto name = std::search(bytes.begin(), bytes.end(), coding.begin(), coding.end());
  ASSERT_NE(name, bytes.end());
  std::copy_n("kcap", 4, bytes.begin() + static_cast<std::ptrdiff_t>(at));  // a coding that nobody knows
  const TensorFile back = decode_tensors(bytes, "test");
  EXPECT_FALSE(back.packed);
  EXPECT_EQ(back.tensors.size(), 1u);
}

TEST(ExrTensors, TheFirstPartCoversAllOthersWhereOneDoes) {
  TensorFile file;
  file.tensors = {{"a", ramp({7, 3})}, {"b", ramp({2, 3, 9})}, {"c", ramp({6, 9, 3})}, {"d", ramp({})}};
  const auto parts = scan_exr(encode_tensors(file), "test");
  EXPECT_TRUE(first_covers_all(parts));
  std::string order;
  for (const ExrPart& part : parts) {
    order += part.name;
    EXPECT_NE(part.channels[0].substr(0, 5), "value") << part.name;
  }
  EXPECT_EQ(order, "bacd");
  expect_equal(file, decode_tensors(encode_tensors(file), "test"));
}

TEST(ExrTensors, OnlyPartsWithinTheFirstOneAreForViewers) {
  TensorFile file = sample_file();  // none covers all others; the first is "cube": 6 x 20 pixels
  file.tensors["small.color"] = ramp({5, 3});
  const auto bytes = encode_tensors(file);
  std::map<std::string, std::vector<std::string>> channels;
  for (const ExrPart& part : scan_exr(bytes, "test")) channels[part.name] = part.channels;
  using Texts = std::vector<std::string>;
  for (const char* shown : {"cube", "one", "small"}) EXPECT_EQ(channels.at(shown), Texts{"Y"}) << shown;
  EXPECT_EQ(channels.at("small.color"), (Texts{"B", "G", "R"}));
  for (const char* hidden : {"tall", "wide"}) EXPECT_EQ(channels.at(hidden), Texts{"value"}) << hidden;
  for (const char* hidden : {"lobes.center", "rows.of.color"}) {
    EXPECT_EQ(channels.at(hidden), (Texts{"value_x", "value_y", "value_z"})) << hidden;
  }
}

TEST(ExrTensors, KeepsEveryBit) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  TensorFile file;
  file.tensors["x"] = {{6}, {nan, infinity, -infinity, -0.0f, 1e-45f, std::numeric_limits<float>::max()}};
  expect_equal(file, decode_tensors(encode_tensors(file), "test"));
}

TEST(ExrTensors, HalfFloatsTakeTwoBytesAndKeepTheirBits) {
  const float infinity = std::numeric_limits<float>::infinity();
  TensorFile file;
  file.tensors["halves"] = {{3, 2, 3}, {0, -0.0f, 1, -2.5f, 65504, 6e-8f, infinity, 0.1f, 3.14f}, Precision::halves};
  file.tensors["halves"].data.resize(18, 7.0f / 3.0f);
  for (float& x : file.tensors["halves"].data) x = rounded_to_half(x);
  const TensorFile again = decode_tensors(encode_tensors(file), "test");
  expect_equal(file, again);
  EXPECT_EQ(encode_tensors(again), encode_tensors(file));

  const auto size = [](Precision precision) {
    TensorFile noise;
    noise.tensors["noise"] = {{1000}, {}, precision};
    for (uint32_t i = 0; i < 1000; ++i)
      noise.tensors["noise"].data.push_back(rounded_to_half(static_cast<float>(i * 2654435761u % 65521u) / 7.0f));
    return static_cast<int>(encode_tensors(noise).size());
  };
  EXPECT_LT(size(Precision::halves), 2000 + 600);
  EXPECT_GT(size(Precision::floats) - size(Precision::halves), 500);
}

TEST(ExrTensors, WhatHalfFloatsCannotHoldIsRefused) {
  for (const float value : {1.0f / 3.0f, 1e6f, 1e-30f, std::numeric_limits<float>::quiet_NaN()}) {
    TensorFile file;
    file.tensors["x"] = {{1}, {value}, Precision::halves};
    EXPECT_THROW(encode_tensors(file), Error) << value;
  }
}

TEST(ExrTensors, SinglePartFile) {
  TensorFile file;
  file.attributes["velour.kind"] = "single";
  file.tensors["only"] = ramp({33, 4});
  expect_equal(file, decode_tensors(encode_tensors(file), "test"));
}

TEST(ExrTensors, SameContentSameBytes) { EXPECT_EQ(encode_tensors(sample_file()), encode_tensors(sample_file())); }

TEST(ExrTensors, SmoothDataGetsSmaller) {
  TensorFile file;
  file.tensors["zeros"] = {{512, 512}, std::vector<float>(512 * 512)};
  EXPECT_LT(encode_tensors(file).size(), 20000u);
  expect_equal(file, decode_tensors(encode_tensors(file), "test"));
}

TEST(ExrTensors, RefusesToEncodeNonsense) {
  TensorFile file;
  EXPECT_THROW(encode_tensors(file), Error);
  file.tensors["a"] = {{2, 3}, {1, 2, 3}};
  EXPECT_THROW(encode_tensors(file), Error);
  file.tensors["a"] = {{0, 3}, {}};
  EXPECT_THROW(encode_tensors(file), Error);
}

TEST(ExrTensors, EveryTruncationIsRefused) {
  for (const auto& bytes : {encode_tensors(sample_file()), encode_tensors(packed_file())}) {
    for (size_t size = 0; size < bytes.size(); size += size < 4000 ? 1 : 97) {
      const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_NE(refusal(cut).find("hostile.velour"), std::string::npos) << size;
    }
  }
}

TEST(ExrTensors, LyingDataWindow) {
  const auto good = encode_tensors(sample_file());
  const size_t window = value_of(good, "dataWindow", "box2i");
  for (const uint32_t edge : {1u, 77u, 100000u, 0x3fffffffu, 0x7fffffffu, 0x80000000u, 0xffffffffu})
    for (const size_t offset : {0u, 4u, 8u, 12u}) {
      auto bytes = good;
      put32(bytes, window + offset, edge);
      EXPECT_NE(refusal(bytes), "") << edge << " at " << offset;
    }
}

/// OpenEXR would take what follows the list for the next attribute, and its size for memory.
TEST(ExrTensors, AListOfChannelsFillsItsAttribute) {
  auto bytes = encode_tensors(sample_file());
  bytes[value_of(bytes, "channels", "chlist")] = 0;  // an empty name ends the list
  EXPECT_NE(refusal(bytes).find("channels is longer than its channel list"), std::string::npos) << refusal(bytes);
}

TEST(ExrTensors, LyingShapeNamesTheField) {
  const auto good = encode_tensors(sample_file());
  const size_t shape = value_of(good, "velour.shape", "string");
  for (const std::string text : {"4 5 7", "6 5 4", "a b c", "4,5,6", "4 5 -", "0 5 6"}) {
    auto bytes = good;
    std::copy(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(shape));
    EXPECT_NE(refusal(bytes).find("velour.shape"), std::string::npos) << text << ": " << refusal(bytes);
  }
}

TEST(ExrTensors, OnlyLosslessScanLines) {
  const auto good = encode_tensors(sample_file());
  for (const uint8_t compression : std::initializer_list<uint8_t>{1, 4, 5, 6, 7, 8, 9, 10, 255}) {
    auto bytes = good;
    bytes[value_of(good, "compression", "compression")] = compression;
    EXPECT_NE(refusal(bytes).find("compression is"), std::string::npos) << int{compression};
  }
  auto bytes = good;
  bytes[value_of(good, "type", "string")] = 'd';
  EXPECT_NE(refusal(bytes).find("type is"), std::string::npos);
  bytes = good;
  bytes[5] = 0x08;  // the deep flag
  EXPECT_NE(refusal(bytes).find("version"), std::string::npos);
}

TEST(ExrTensors, HugeAttributeIsNotAllocated) {
  const auto good = encode_tensors(sample_file());
  for (const uint32_t size : {0x7fffffffu, 0xffffffffu, 1u << 20}) {
    auto bytes = good;
    put32(bytes, value_of(good, "velour.note", "string") - 4, size);
    EXPECT_NE(refusal(bytes).find("velour.note"), std::string::npos) << refusal(bytes);
  }
}

TEST(ExrTensors, EmptyChunkCannotClaimPixels) {
  TensorFile file;
  file.tensors["zeros"] = {{64, 4096}, std::vector<float>(64 * 4096)};
  auto bytes = encode_tensors(file);
  // A stored chunk of 16 rows x 16 KiB shrinks to a few hundred bytes; a claim of 1 byte is beyond DEFLATE.
  uint64_t chunk = 0;
  const auto parts = scan_exr(bytes, "test");
  ASSERT_EQ(parts.size(), 1u);
  std::memcpy(&chunk, &bytes.at(value_of(bytes, "velour.shape", "string") + 7 + 1), 8);
  put32(bytes, chunk + 4, 1);
  EXPECT_NE(refusal(bytes).find("too few"), std::string::npos) << refusal(bytes);
}

TEST(ExrTensors, ChunksCannotBeSharedByRows) {
  TensorFile file;
  file.tensors["zeros"] = {{160, 16384}, std::vector<float>(160 * 16384)};
  auto bytes = encode_tensors(file);  // ten chunks of 1 MiB, a kilobyte each in the file
  const size_t table = value_of(bytes, "velour.shape", "string") + 9 + 1, chunk = table + 10 * 8;
  uint64_t first = 0;
  std::memcpy(&first, &bytes.at(table), 8);
  ASSERT_EQ(first, chunk);
  uint32_t stored = 0;
  std::memcpy(&stored, &bytes.at(chunk + 4), 4);
  for (size_t i = 1; i < 10; ++i) std::memcpy(&bytes.at(table + 8 * i), &first, 8);
  bytes.resize(chunk + 8 + stored);
  EXPECT_NE(refusal(bytes).find("are larger than the file"), std::string::npos) << refusal(bytes);
}

TEST(ExrTensors, DamagedPixelsAreRefusedOrRead) {
  const auto packed = encode_tensors(packed_file());
  for (const auto& good : {encode_tensors(sample_file()), packed, reversed(packed)}) {
    for (size_t at = 0; at < good.size(); at += 3) {
      auto bytes = good;
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ 0x55);
      refusal(bytes);  // any sentence or none: what counts is that nothing else happens
    }
  }
}

/// Zeros, which DEFLATE makes a thousandth of, and a packed file twice.
TEST(ExrTensors, WhatNobodyAsksForIsSkippedAndTheRestIsBounded) {
  for (const bool packed : {false, true}) {
    TensorFile file;
    file.packed = packed;
    file.attributes["velour.kind"] = "x";
    file.tensors["known.a"] = {{2, 3}, {1, 2, 3, 4, 5, 6}};
    file.tensors["known.zeros"] = {{200, 1000}, std::vector<float>(200000, 0.0f)};
    file.tensors["other.zeros"] = {{2000, 1000}, std::vector<float>(2000000, 0.0f)};
    const std::vector<uint8_t> bytes = encode_tensors(file);
    ASSERT_LT(bytes.size(), 40000u);
    const TensorFile found = decode_tensors(bytes, "test", {{"known."}, 9000000});
    EXPECT_EQ(found.tensors.size(), 2u);
    EXPECT_EQ(found.tensors.at("known.a").data, file.tensors.at("known.a").data);
    EXPECT_EQ(found.tensors.at("known.zeros").data.size(), 200000u);
    for (const TensorLimits& limits : {TensorLimits{{"known."}, 700000}, TensorLimits{{}, 8000000}}) {
      try {
        decode_tensors(bytes, "test", limits);
        ADD_FAILURE() << packed;
      } catch (const Error& error) {
        EXPECT_EQ(error.status(), Status::bad_data);
        EXPECT_TRUE(std::string(error.what()).starts_with("test")) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace velour::exr_tensors_test
