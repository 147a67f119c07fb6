#include "brdf/formats/tensor_file.h"

#include <gtest/gtest.h>

#include "measurement_support.h"

namespace velour::tensor_file_test {
namespace {

using test::TensorFileBuilder;

TensorFileBuilder two_fields() {
  TensorFileBuilder builder;
  builder.floats("a", {2, 3}, {1, 2, 3, 4, 5, 6}).add("t", 1, {2}, std::vector<uint8_t>{'h', 'i'});
  return builder;
}

std::string refusal_of_bytes(const std::vector<uint8_t>& bytes) {
  return test::refusal([&] { TensorContainer(bytes, "x.bsdf"); });
}

TEST(TensorFile, ReadsItsFields) {
  const auto bytes = two_fields().bytes();
  EXPECT_TRUE(looks_like_tensor_file(bytes));
  const TensorContainer file(bytes, "x.bsdf");
  EXPECT_EQ(file.floats("a", 2), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file.shape("a"), (std::vector<uint64_t>{2, 3}));
  EXPECT_EQ(file.text("t"), "hi");
  EXPECT_FALSE(file.has("b"));
}

TEST(TensorFile, NamesTheMissingField) {
  const auto bytes = two_fields().bytes();
  const TensorContainer file(bytes, "x.bsdf");
  EXPECT_NE(test::refusal([&] { file.floats("b", 2); }).find("x.bsdf: field b is missing"), std::string::npos);
  EXPECT_NE(test::refusal([&] { file.floats("a", 3); }).find("2 dimensions, not 3"), std::string::npos);
  EXPECT_NE(test::refusal([&] { file.floats("t", 1); }).find("type 1, not 10"), std::string::npos);
}

TEST(TensorFile, EveryTruncationIsRefused) {
  const auto bytes = two_fields().bytes();
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(refusal_of_bytes({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}).find("x.bsdf"),
              std::string::npos)
        << size;
}

TEST(TensorFile, LyingEntries) {
  std::map<std::string, size_t> at;
  const auto good = two_fields().bytes(&at);
  const auto with = [&](size_t position, uint64_t value, size_t size) {
    auto bytes = good;
    std::memcpy(&bytes.at(position), &value, size);
    return refusal_of_bytes(bytes);
  };
  const size_t rank = at["a"] + 3, type = rank + 2, offset = type + 1, shape = offset + 8;
  for (const uint64_t lie : {uint64_t{7}, uint64_t{1} << 20, uint64_t{1} << 62, ~uint64_t{0}, uint64_t{0}})
    EXPECT_NE(with(shape, lie, 8).find("field a"), std::string::npos) << lie;
  for (const uint64_t lie :
       {uint64_t{0}, uint64_t{17}, good.size() - 23, uint64_t{good.size()}, ~uint64_t{0}, uint64_t{1} << 63})
    EXPECT_NE(with(offset, lie, 8).find("field a"), std::string::npos) << lie;
  for (const uint64_t lie : {0u, 12u, 255u}) EXPECT_NE(with(type, lie, 1).find("field a has type"), std::string::npos);
  EXPECT_NE(with(rank, 0xffff, 2), "");
  EXPECT_NE(with(14, 0xffffffff, 4).find("number of fields"), std::string::npos);
  EXPECT_NE(with(12, 2, 1).find("version is 2"), std::string::npos);
}

TEST(TensorFile, OverlapIsALie) {
  std::map<std::string, size_t> at;
  auto bytes = two_fields().bytes(&at);
  uint64_t offset_a;
  std::memcpy(&offset_a, &bytes[at["a"] + 6], 8);
  std::memcpy(&bytes[at["t"] + 6], &offset_a, 8);
  EXPECT_NE(refusal_of_bytes(bytes).find("inside the header or another field"), std::string::npos);
}

TEST(TensorFile, SameNameTwice) {
  TensorFileBuilder builder = two_fields();
  builder.floats("a", {1}, {1});
  EXPECT_NE(refusal_of_bytes(builder.bytes()).find("occurs more than once"), std::string::npos);
}

}  // namespace
}  // namespace velour::tensor_file_test
