// Paths of test inputs and outputs.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace velour::test {

/// Folder of real test inputs: $VELOUR_DATA, else ../shared/data beside the project; empty when absent.
inline std::filesystem::path data_folder() {
  const char* from_environment = std::getenv("VELOUR_DATA");
  const std::filesystem::path folder =
      from_environment ? from_environment : std::string(VELOUR_SOURCE_DIR) + "/../shared/data";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

/// A fresh folder for one test's files, named after it, below the build folder; kept for a look after a failure.
inline std::filesystem::path scratch_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(VELOUR_SCRATCH_DIR) / info->test_suite_name() / info->name();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace velour::test

/// Skips the test, saying so, where the real input `file` (below the data folder) is absent.
#define VELOUR_NEED_DATA(path_variable, file)                                         \
  const std::filesystem::path path_variable = ::velour::test::data_folder() / (file); \
  if (!std::filesystem::exists(path_variable)) GTEST_SKIP() << "no test data: " << (file)
