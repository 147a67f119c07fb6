#include "support/test_data.h"

#include <cstdlib>

namespace velour::test {

std::filesystem::path data_folder() {
  const char* from_environment = std::getenv("VELOUR_DATA");
  const std::filesystem::path folder = from_environment ? from_environment : VELOUR_SOURCE_DIR "/../shared/data";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

std::filesystem::path scratch_root() { return VELOUR_SCRATCH_DIR; }

std::filesystem::path scratch_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = scratch_root() / info->test_suite_name() / info->name();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace velour::test
