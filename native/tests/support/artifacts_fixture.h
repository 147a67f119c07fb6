// For tests of the harness itself: artifacts go to a fresh folder of the test.
#pragma once

#include <cstdlib>
#include <fstream>
#include <vector>

#include "support/test_data.h"

namespace velour::test {

class ArtifactsFixture : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* old = std::getenv("VELOUR_TEST_ARTIFACTS");
    if (old != nullptr) old_ = old;
    folder_ = scratch_folder();
    setenv("VELOUR_TEST_ARTIFACTS", folder_.c_str(), 1);
  }
  void TearDown() override {
    old_.empty() ? unsetenv("VELOUR_TEST_ARTIFACTS") : setenv("VELOUR_TEST_ARTIFACTS", old_.c_str(), 1);
  }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) found.push_back(entry.path());
    return found;
  }
  std::filesystem::path only_file() const {
    const auto found = files();
    EXPECT_EQ(found.size(), 1u);
    return found.empty() ? std::filesystem::path() : found[0];
  }
  static std::vector<std::string> lines_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

  std::filesystem::path folder_;
  std::string old_;
};

}  // namespace velour::test
