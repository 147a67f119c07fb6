// What a failing statistical test leaves for a look.
#pragma once

#include <filesystem>
#include <string_view>

namespace velour::test {

/// $VELOUR_TEST_ARTIFACTS, else "velour-test-artifacts" in GoogleTest's temporary folder.
std::filesystem::path artifact_folder();

/// FOLDER/SUITE.TEST.NAME for the running test, slashes and blanks made underscores; the folder is created.
std::filesystem::path artifact_path(std::string_view name);

}  // namespace velour::test
