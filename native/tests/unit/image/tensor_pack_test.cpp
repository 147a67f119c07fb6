#include "image/tensors/tensor_pack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "math/sphere/random.h"

namespace velour::tensor_pack_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A map that is smooth but for two bits, noise, and a constant.
Tensor maps_of_bytes(uint64_t rows, uint64_t columns) {
  Tensor tensor{{3, rows, columns}, {}, Precision::bytes};
  RandomStream random(3, rows, columns);
  for (uint64_t i = 0; i < 3 * rows * columns; ++i) {
    const uint64_t x = i % columns, y = i / columns % rows, map = i / columns / rows;
    const float smooth = static_cast<float>((2 * x + 3 * y) / 4 % 250) + std::floor(4 * random.next());
    tensor.data.push_back((map == 0 ? smooth : map == 1 ? std::floor(256 * random.next()) : 255.0f) / 256);
  }
  return tensor;
}

TensorFile sample_pack() {
  TensorFile file;
  file.attributes = {{"velour.note", "Grüße \"\\"}, {"velour.empty", ""}};
  file.tensors["bytes"] = maps_of_bytes(6, 5);
  file.tensors["floats"] = {{2, 3}, {0, -0.0f, 1e-42f, -kInfinity, 3.14f, 1e30f}};
  file.tensors["halves"] = {{5}, {0, -0.0f, 65504, 6e-8f, -2.5f}, Precision::halves};
  for (float& value : file.tensors["halves"].data) value = rounded_to_half(value);
  file.tensors["one"] = {{}, {7}};
  return file;
}

void expect_same_tensors(const TensorFile& a, const TensorFile& b) {
  EXPECT_EQ(a.attributes, b.attributes);
  ASSERT_EQ(a.tensors.size(), b.tensors.size());
  for (const auto& [name, tensor] : a.tensors) {
    const Tensor& other = b.tensors.at(name);
    EXPECT_EQ(tensor.shape, other.shape) << name;
    EXPECT_EQ(tensor.precision, other.precision) << name;
    ASSERT_EQ(tensor.data.size(), other.data.size()) << name;
    EXPECT_EQ(0, std::memcmp(tensor.data.data(), other.data.data(), tensor.data.size() * 4)) << name;
  }
}

std::string refusal(std::span<const uint8_t> bytes) {
  try {
    decode_pack(bytes, "hostile");
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::bad_data);
    return error.what();
  }
  return "";
}

/// A stream of such a list and `zeros` bytes.
std::vector<uint8_t> pack_of(const std::string& list, size_t zeros) {
  const auto size = static_cast<uint32_t>(list.size());
  std::vector<uint8_t> head(4 + list.size());
  std::memcpy(head.data(), &size, 4);
  std::memcpy(head.data() + 4, list.data(), list.size());
  Deflater deflater;
  deflater.write(head);
  deflater.write(std::vector<uint8_t>(zeros));
  return deflater.take();
}

TEST(TensorPack, RoundTrip) {
  expect_same_tensors(sample_pack(), decode_pack(encode_pack(sample_pack()), "test"));
  expect_same_tensors({}, decode_pack(encode_pack({}), "test"));
  EXPECT_EQ(encode_pack(sample_pack()), encode_pack(sample_pack()));
}

TEST(TensorPack, MapsOfEverySizeKeepTheirBytes) {
  for (const auto& [rows, columns] : {std::pair<uint64_t, uint64_t>{64, 48}, {1, 1}, {1, 7}, {5, 1}, {2, 3}}) {
    TensorFile file;
    file.tensors["maps"] = maps_of_bytes(rows, columns);
    expect_same_tensors(file, decode_pack(encode_pack(file), "test"));
  }
}

TEST(TensorPack, MapsTakeWhatNeighborsDoNotTell) {
  const Tensor maps = maps_of_bytes(64, 64);
  const auto size = [&](size_t map, Precision precision) {
    TensorFile file;
    const auto first = maps.data.begin() + static_cast<std::ptrdiff_t>(map * 64 * 64);
    file.tensors["map"] = {{64, 64}, {first, first + 64 * 64}, precision};
    return encode_pack(file).size();
  };
  EXPECT_LT(size(0, Precision::bytes), 64u * 64 / 2);    // smooth
  EXPECT_LT(size(1, Precision::bytes), 64u * 64 + 200);  // noise
  EXPECT_LT(3 * size(0, Precision::bytes), size(0, Precision::halves) * 2);
}

TEST(TensorPack, LongStreamsAreWhole) {
  TensorFile file;
  file.tensors["a"] = maps_of_bytes(400, 300);  // many steps of output, then other strategies
  file.tensors["b"] = {{3 * 400 * 300}, file.tensors["a"].data, Precision::halves};
  file.tensors["c"] = maps_of_bytes(300, 400);
  expect_same_tensors(file, decode_pack(encode_pack(file), "test"));
}

TEST(TensorPack, EveryDamageAndTruncationIsRefused) {
  const auto pack = encode_pack(sample_pack());
  for (size_t size = 0; size < pack.size(); ++size) EXPECT_NE(refusal({pack.data(), size}), "") << size;
  for (size_t at = 0; at < pack.size(); ++at) {
    auto damaged = pack;
    damaged[at] ^= 0x20;
    const std::string why = refusal(damaged);
    if (why.empty())
      expect_same_tensors(sample_pack(), decode_pack(damaged, "test"));  // bits between the end and the checksum
    else
      EXPECT_NE(why.find("hostile"), std::string::npos) << at;
  }
}

TEST(TensorPack, WhatFollowsIsNotLookedAt) {
  auto pack = encode_pack(sample_pack());
  pack.insert(pack.end(), {0, 0, 0});
  expect_same_tensors(sample_pack(), decode_pack(pack, "test"));
}

TEST(TensorPack, ListsThatLieAreRefused) {
  const auto tensor = [](const std::string& of) { return R"({"texts": {}, "tensors": [)" + of + "]}"; };
  const std::string good = R"({"name": "a", "values": "half", "shape": [2, 2]})";
  ASSERT_EQ(refusal(pack_of(tensor(good), 8)), "");
  const std::pair<std::string, std::string> cases[] = {
      {"", "damaged"},
      {"[]", "damaged"},
      {R"({"tensors": []})", "texts"},
      {R"({"texts": {"a": 1}, "tensors": []})", "texts.a"},
      {R"({"texts": {}, "tensors": {}})", "tensors"},
      {tensor("3"), "tensors"},
      {tensor(R"({"name": "a", "values": "half"})"), "tensors.shape"},
      {tensor(R"({"name": "a", "values": "double", "shape": [2, 2]})"), "tensors.values"},
      {tensor(R"({"name": "a", "values": "half", "shape": [-2, 2]})"), "tensors.shape"},
      {tensor(R"({"name": "a", "values": "half", "shape": [0]})"), "tensors.shape"},
      {tensor(R"({"name": "a", "values": "byte", "shape": [8]})"), "tensors.shape"},
      {tensor(R"({"name": "a", "values": "half", "shape": [2, 3]})"), "damaged"},  // more than there is
      {tensor(R"({"name": "a", "values": "half", "shape": [3]})"), "damaged"},     // less
      {tensor(R"({"name": "a", "values": "float", "shape": [1000000, 100000]})"), "damaged"},
      {tensor(R"({"name": "a", "values": "float", "shape": [1000000000, 1000000000]})"), "tensors.shape"},
      {std::string(100000, '['), "damaged"},
  };
  for (const auto& [list, field] : cases) {
    EXPECT_NE(refusal(pack_of(list, 8)).find(field), std::string::npos) << list.substr(0, 100);
  }
}

TEST(MapRest, SmoothMapsLeaveNothing) {
  std::vector<uint8_t> plane;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 9; ++x) plane.push_back(static_cast<uint8_t>(10 + 2 * x + 3 * y));
  auto rests = plane;
  maps_to_rests(rests, 8, 9);
  const std::vector<uint8_t> first_row = {10, 2, 2, 2, 2, 2, 2, 2, 2};
  EXPECT_EQ(std::vector<uint8_t>(rests.begin(), rests.begin() + 9), first_row);
  for (size_t i = 9; i < rests.size(); ++i) EXPECT_LE(rests[i], 3) << i;
  rests_to_maps(rests, 8, 9);
  EXPECT_EQ(rests, plane);
}

}  // namespace
}  // namespace velour::tensor_pack_test
