#include "btf/formats/load_btf.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "btf/formats/btf_folder.h"
#include "btf/formats/image_set.h"
#include "btf/formats/picture_index.h"
#include "btf/formats/ubo_file.h"

namespace velour {
namespace fs = std::filesystem;
namespace {

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

void check(const BtfLoadOptions& options) {
  const auto refuse = [](const char* sentence) { throw Error(Status::invalid_argument, sentence); };
  if (options.curve.gamma && !(*options.curve.gamma >= 0.1f && *options.curve.gamma <= 10.0f)) {
    refuse("The gamma of the images of a BTF must be between 0.1 and 10.");
  }
  if (options.tile_metres && !is_tile_size(*options.tile_metres)) {
    refuse("The tile size of a BTF must be two positive numbers, in meters.");
  }
}

std::shared_ptr<const BtfMeasurement> load_csv(const std::string& path, const BtfLoadOptions& options) {
  return load_image_set({path, "csv", read_csv_index(path, options.angles)}, options);
}

std::shared_ptr<const BtfMeasurement> load_folder(const std::string& path, const BtfLoadOptions& options) {
  if (is_btf_folder(path)) return load_btf_folder(path, options.tile_metres);
  const std::string index = fs::path(path) / "btf.csv";
  if (is_file(index)) return load_csv(index, options);
  return load_image_set({path, "ubo2003", find_named_pictures(path)}, options);
}

/// Checks the extension too, so that an index with a bad first line gets a specific error.
bool is_csv(const std::string& path) { return fs::path(path).extension() == ".csv" || is_csv_index(path); }

bool is_archive(const std::string& path) {
  const std::vector<uint8_t> head = read_file_head(path, 4);
  return std::ranges::equal(head, std::array<uint8_t, 4>{'P', 'K', 3, 4});
}

}  // namespace

std::shared_ptr<const BtfMeasurement> load_btf(const std::string& path, const BtfLoadOptions& options) {
  check(options);
  if (is_folder(path)) return load_folder(path, options);
  if (fs::path(path).filename() == "btf.json") return load_folder(fs::absolute(path).parent_path(), options);
  if (is_ubo_file(path)) return load_ubo_file(path, options);
  if (is_csv(path)) return load_csv(path, options);
  if (is_archive(path)) throw Error(Status::unsupported, path + ": is an archive; unpack it and give the folder.");
  throw Error(Status::bad_data, path +
                                    ": is not a BTF in a supported format; use a .btf file of the University of Bonn, "
                                    "a CSV index of images, or a folder (docs/reference/btf_formats.md).");
}

bool is_btf(const std::string& path) {
  if (is_folder(path) || fs::path(path).filename() == "btf.json") return true;
  return is_file(path) && (is_ubo_file(path) || is_csv(path));
}

}  // namespace velour
