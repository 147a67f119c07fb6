#include "btf/fit/btf_fitter.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace velour::fit_memory_test {
namespace {

FitExtent usual_extent() {
  return {.texels = 128 * 128,
          .pyramid_texels = 21845,
          .pairs = 6561,
          .lights = 81,
          .sides = 1,
          .points = 400,
          .point_pairs = 900,
          .coefficients = 112,
          .threads = 2};
}

std::string refusal(uint64_t memory, const FitExtent& extent) {
  try {
    search_points_within(memory, extent);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::unsupported);
    return error.what();
  }
  return "";
}

TEST(FitMemory, TakesFewerPointsWhereThereIsLess) {
  EXPECT_EQ(search_points_within(uint64_t{1} << 30, usual_extent()), 64u);
  const uint32_t fewer = search_points_within(uint64_t{256} << 20, usual_extent());
  EXPECT_LT(fewer, 64u);
  EXPECT_GE(fewer, 8u);
}

TEST(FitMemory, KnowsWhatAllPointsTake) {
  const uint64_t all = memory_for_all_points(usual_extent());
  EXPECT_EQ(search_points_within(all, usual_extent()), 64u);
  EXPECT_EQ(search_points_within(all - 1, usual_extent()), 63u);
}

/// The least that a refusal names is enough.
TEST(FitMemory, NamesTheLeastThatWouldDo) {
  const std::string sentence = refusal(50'000'000, usual_extent());
  const size_t at = sentence.find("at least ");
  ASSERT_NE(at, std::string::npos) << sentence;
  const auto least = std::stoull(sentence.substr(at + 9)) * 1'000'000;
  EXPECT_GE(search_points_within(least, usual_extent()), 8u);
  EXPECT_NE(refusal(least - 2'000'000, usual_extent()), "");
}

TEST(FitMemory, OfComponentsGrowsWithThem) {
  FitExtent extent = usual_extent();
  extent.coefficients = 512;
  const uint64_t some = components_within(uint64_t{256} << 20, 1, extent);
  EXPECT_GT(some, 1u);
  ASSERT_LT(some, 512u);
  extent.coefficients = some;
  require_components(uint64_t{256} << 20, extent);
  ++extent.coefficients;
  EXPECT_THROW(require_components(uint64_t{256} << 20, extent), Error);
  EXPECT_THROW(components_within(1'000'000, 1, extent), Error);
  EXPECT_EQ(components_within(uint64_t{256} << 20, some, extent), some);
  EXPECT_THROW(components_within(uint64_t{256} << 20, some + 1, extent), Error);
}

constexpr uint64_t kEntries = 64 * 64 * 3;  // of a slice

std::string tensor_refusal(uint64_t memory) {
  try {
    tensor_allowance(memory, usual_extent(), kEntries);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::unsupported);
    return error.what();
  }
  return "";
}

TEST(FitMemory, OfTensorsTakesFewerFunctionsThenFewerTexels) {
  const TensorAllowance all = tensor_allowance(0, usual_extent(), kEntries);
  const TensorAllowance some = tensor_allowance(uint64_t{1} << 30, usual_extent(), kEntries);
  const TensorAllowance least = tensor_allowance(uint64_t{256} << 20, usual_extent(), kEntries);
  EXPECT_LT(some.functions, all.functions);
  EXPECT_LE(least.functions, some.functions);
  EXPECT_LT(least.slices, all.slices);
  EXPECT_LT(least.point_floats, all.point_floats);
}

TEST(FitMemory, OfTensorsLeavesTheRestToInverses) {
  const uint64_t memory = uint64_t{1} << 30;
  const TensorAllowance some = tensor_allowance(memory, usual_extent(), kEntries);
  EXPECT_EQ(memory_for_tensors(usual_extent(), kEntries, some) + some.inverse_bytes, memory);
}

TEST(FitMemory, OfTensorsNamesTheLeastThatWouldDo) {
  const std::string sentence = tensor_refusal(50'000'000);
  const size_t at = sentence.find("at least ");
  ASSERT_NE(at, std::string::npos) << sentence;
  const auto least = std::stoull(sentence.substr(at + 9)) * 1'000'000;
  EXPECT_EQ(tensor_refusal(least), "");
  EXPECT_NE(tensor_refusal(least - 2'000'000), "");
}

/// What is told before a fit is what it is refused by.
TEST(FitMemory, LeastIsEnoughAndNoLessIs) {
  const uint64_t of_tensors = memory_for_tensors(usual_extent(), kEntries, least_tensor_allowance());
  EXPECT_EQ(tensor_refusal(of_tensors), "");
  EXPECT_NE(tensor_refusal(of_tensors - 1), "");
  const uint64_t of_points = memory_for_least_points(usual_extent());
  EXPECT_EQ(refusal(of_points, usual_extent()), "");
  EXPECT_NE(refusal(of_points - 1, usual_extent()), "");
}

}  // namespace
}  // namespace velour::fit_memory_test
