// Memory that may lie in a file.
#include "base/memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <numeric>
#include <span>

#include "base/error.h"
#include "base/process.h"
#include "support/test_data.h"

namespace velour::scratch_pages_test {
namespace {

constexpr uint64_t kBytes = 64 << 20;

std::span<uint64_t> numbers(const ScratchPages& pages) {
  return {static_cast<uint64_t*>(pages.data()), kBytes / sizeof(uint64_t)};
}

void expect_keeps(const ScratchPages& pages) {
  const std::span<uint64_t> kept = numbers(pages);
  for (uint64_t value : kept) ASSERT_EQ(value, 0u);
  std::iota(kept.begin(), kept.end(), 1);
  pages.release();
  for (size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(kept[i], i + 1);
}

TEST(ScratchPages, KeepsWhatIsInMemory) {
  const ScratchPages pages(kBytes, kBytes, "/there/is/no/such/folder");
  EXPECT_FALSE(pages.in_file());
  expect_keeps(pages);
}

TEST(ScratchPages, KeepsWhatIsInAFileWithoutAName) {
  const auto folder = test::scratch_folder();
  const ScratchPages pages(kBytes, kBytes - 1, folder);
  EXPECT_TRUE(pages.in_file());
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  expect_keeps(pages);
}

TEST(ScratchPages, ReleaseTakesAFileOutOfMemory) {
  const ScratchPages pages(kBytes, 0, test::scratch_folder());
  for (uint64_t& value : numbers(pages)) value = 1;
  const uint64_t before = resident_bytes();
  pages.release();
  EXPECT_LT(resident_bytes() + kBytes / 2, before);
}

TEST(ScratchPages, NamesTheFolderThatTakesNoFile) {
  try {
    const ScratchPages pages(kBytes, 0, "/there/is/no/such/folder");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::io);
    EXPECT_NE(std::string(error.what()).find("/there/is/no/such/folder"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("raise the memory limit"), std::string::npos) << error.what();
  }
}

TEST(ScratchPages, NothingIsNothing) {
  const ScratchPages pages(0, 0, "/there/is/no/such/folder");
  EXPECT_EQ(pages.data(), nullptr);
}

}  // namespace
}  // namespace velour::scratch_pages_test
