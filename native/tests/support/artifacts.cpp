#include "support/artifacts.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <string>

namespace velour::test {

std::filesystem::path artifact_folder() {
  const char* asked = std::getenv("VELOUR_TEST_ARTIFACTS");
  if (asked != nullptr && *asked != '\0') return asked;
  return std::filesystem::path(::testing::TempDir()) / "velour-test-artifacts";
}

std::filesystem::path artifact_path(std::string_view name) {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string file = std::string(info->test_suite_name()) + '.' + info->name() + '.' + std::string(name);
  for (char& c : file) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  }
  const auto folder = artifact_folder();
  std::filesystem::create_directories(folder);
  return folder / file;
}

}  // namespace velour::test
