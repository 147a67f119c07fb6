// Paths of test inputs and outputs.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace velour::test {

/// Folder of real test inputs: $VELOUR_DATA, else a folder shared/data beside the project; empty when absent.
std::filesystem::path data_folder();

/// Below the build folder, for files of tests.
std::filesystem::path scratch_root();

/// A fresh folder for one test's files, named after it, in the root; kept for a look after a failure.
std::filesystem::path scratch_folder();

}  // namespace velour::test

/// Skips the test, saying so, where the real input `file` (below the data folder) is absent.
#define VELOUR_NEED_DATA(path_variable, file)                                         \
  const std::filesystem::path path_variable = ::velour::test::data_folder() / (file); \
  if (!std::filesystem::exists(path_variable)) GTEST_SKIP() << "no test data: " << (file)
