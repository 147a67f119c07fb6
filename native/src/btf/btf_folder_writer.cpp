#include <filesystem>

#include "btf/btf_folder.h"
#include "btf/view_file.h"
#include "file/file.h"
#include "image/image_stack_file.h"
#include "job/error.h"

namespace velour {
namespace fs = std::filesystem;
namespace {

template <typename T>
std::span<const uint8_t> bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

std::string index_path(const std::string& folder) { return fs::path(folder) / "btf.json"; }

DecodedBtfIndex read_index(const std::string& folder) {
  const std::string path = index_path(folder);
  return decode_btf_index(read_file(path, kMostBtfIndexBytes), path);
}

void write_index(const std::string& folder, const BtfIndex& index, const std::optional<BtfContent>& content) {
  const std::string text = encode_btf_index(index, content);
  write_file(index_path(folder), {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

/// Creates the folder if it does not exist. Throws unless it is empty.
void make_folder(const std::string& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) throw Error(Status::io, path + ": cannot create the folder: " + failure.message() + ".");
  if (fs::is_empty(path, failure) && !failure) return;
  throw Error(Status::io, path + ": the folder contains files that do not belong to a BTF; choose a new folder.");
}

void check_same(const std::string& path, const BtfIndex& index, bool resume) {
  const auto field = difference(read_index(path).index, index);
  if (field) {
    throw Error(Status::io, path + ": the folder contains another BTF, with different '" + *field +
                                "'; choose another folder, or delete this one.");
  }
  if (!resume) {
    throw Error(
        Status::io,
        path + ": the folder already contains this BTF or a part of it; resume the capture, or choose another folder.");
  }
}

void append(std::vector<std::span<const uint8_t>>& pixels, const ViewStructure& structure) {
  for (const auto* map : {&structure.coverage, &structure.height_mean, &structure.height_spread}) {
    pixels.push_back(bytes_of(std::span(*map)));
  }
}

/// Counts the values in the file of `view`, one image at a time.
ValueCounts counts_of(const std::string& folder, const BtfIndex& index, size_t view, const Progress& progress) {
  const std::vector<ImageStack> stacks = view_stacks(index, view);
  ValueCounts counts;
  if (index.layout.first(view) == index.layout.first(view + 1)) return counts;
  const ImageStackFile file(view_path(folder, view), stacks);
  std::vector<HalfBits> image(index.grid.texels() * 3);
  for (uint64_t i = 0; i < stacks[kValuesPart].images; ++i) {
    progress.check();
    file.read(kValuesPart, i, {reinterpret_cast<uint8_t*>(image.data()), image.size() * sizeof(HalfBits)});
    counts.add(image);
  }
  return counts;
}

BtfContent::ViewFile file_of(const std::string& path, const Progress& progress) {
  return {fs::file_size(path), sha256_of_file(path, progress)};
}

}  // namespace

BtfFolderWriter::BtfFolderWriter(const std::string& path, BtfIndex index, bool resume)
    : path_(path), index_(std::move(index)) {
  encode_btf_index(index_, std::nullopt);  // rejects a bad index before anything is created
  if (is_btf_folder(path_)) {
    check_same(path_, index_, resume);
    return;
  }
  make_folder(path_);
  write_index(path_, index_, std::nullopt);
}

bool BtfFolderWriter::has(uint32_t view) const {
  const std::vector<ImageStack> stacks = view_stacks(index_, view);
  if (stacks.empty()) return true;
  const std::string path = view_path(path_, view);
  if (!fs::exists(path)) return false;
  try {
    ImageStackFile(path, stacks).check_chunk_tables();
    return true;
  } catch (const Error&) {
    return false;  // the damaged file will be replaced
  }
}

void BtfFolderWriter::write(uint32_t view, const BtfView& content, const Progress& progress) const {
  if (view >= index_.layout.views().size())
    throw Error(Status::invalid_argument, "The BTF has no view " + std::to_string(view) + ".");
  if (index_.structure != (content.structure != nullptr) || (!index_.errors && !content.errors.empty())) {
    throw Error(Status::invalid_argument,
                path_ + ": a view must have errors and structure exactly if the index of the BTF says so.");
  }
  const std::vector<ImageStack> stacks = view_stacks(index_, view);
  if (stacks.empty()) return;
  std::vector<std::span<const uint8_t>> pixels;
  const bool lit = index_.layout.first(view) < index_.layout.first(view + 1);
  if (lit) pixels.push_back(bytes_of(content.values));
  if (lit && index_.errors) pixels.push_back(bytes_of(content.errors));
  if (content.structure) append(pixels, *content.structure);
  write_image_stacks(view_path(path_, view), stacks, pixels, {}, progress);
}

void BtfFolderWriter::finish(const Progress& progress) const {
  const size_t views = index_.layout.views().size();
  for (uint32_t v = 0; v < views; ++v) {
    if (!has(v)) {
      throw Error(Status::invalid_state,
                  path_ + ": view " + std::to_string(v) + " is missing or damaged; write it before the index.");
    }
  }
  BtfContent content;
  for (size_t v = 0; v < views; ++v) {
    progress.check();
    content.counts += counts_of(path_, index_, v, progress);
    const bool written = !view_stacks(index_, v).empty();
    content.views.push_back(written ? file_of(view_path(path_, v), progress) : BtfContent::ViewFile{});
  }
  write_index(path_, index_, content);
}

uint64_t BtfFolderWriter::bytes() const {
  uint64_t sum = fs::file_size(index_path(path_));
  for (size_t v = 0; v < index_.layout.views().size(); ++v) {
    std::error_code missing;
    const uint64_t bytes = fs::file_size(view_path(path_, v), missing);
    if (!missing) sum += bytes;
  }
  return sum;
}

bool is_btf_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(index_path(path), ignored);
}

}  // namespace velour
