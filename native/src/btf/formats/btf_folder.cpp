#include "btf/formats/btf_folder.h"

#include <filesystem>
#include "base/error.h"
#include "base/file.h"
#include "image/image_stack.h"

namespace velour {

namespace fs = std::filesystem;
namespace {

template <typename T>
std::span<uint8_t> writable_bytes(std::span<T> values) {
  return {reinterpret_cast<uint8_t*>(values.data()), values.size_bytes()};
}

class BtfFolder : public BtfMeasurement {
 public:
  BtfFolder(const std::string& path, const std::optional<Vec2>& tile_metres)
      : BtfFolder(path, fs::path(path) / "btf.json") {
    if (tile_metres) grid_.tile_metres = tile_metres;
  }

  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    read_images(kValuesPart, first, count, values);
  }

  bool read_errors(uint64_t first, uint64_t count, std::span<HalfBits> errors) const override {
    if (index_.errors) read_images(kErrorsPart, first, count, errors);
    return index_.errors;
  }

  std::optional<ViewStructure> read_structure(uint32_t view) const override {
    if (!index_.structure) return std::nullopt;
    const std::vector<ImageStack> stacks = view_stacks(index_, view);
    const ImageStackFile file(view_path(path_, view), stacks);
    ViewStructure structure;
    size_t part = stacks.size() - kStructureParts;
    for (auto* map : {&structure.coverage, &structure.height_mean, &structure.height_spread}) {
      map->resize(grid_.texels());
      file.read(part++, 0, writable_bytes(std::span(*map)));
    }
    return structure;
  }

  std::vector<std::pair<std::string, std::string>> details() const override { return {{"options", index_.options}}; }

  bool has_errors() const override { return index_.errors; }
  bool has_structure() const override { return index_.structure; }

  std::optional<ValueCounts> all_counts() const override { return content_.counts; }

 private:
  BtfFolder(const std::string& path, const fs::path& index_path)
      : BtfFolder(path, index_path, read_file(index_path, kMaxBtfIndexBytes)) {}

  BtfFolder(const std::string& path, const std::string& index_path, const std::vector<uint8_t>& bytes)
      : BtfFolder(path, decode_btf_index(bytes, index_path)) {
    provenance_ = {path, index_.source, "velour-btf", "", sha256_hex(bytes), bytes.size()};
    for (size_t v = 0; v < content_.views.size(); ++v) provenance_.file_bytes += check_view(v);
  }

  BtfFolder(const std::string& path, DecodedBtfIndex decoded) : path_(path), index_(std::move(decoded.index)) {
    if (!decoded.content) {
      throw Error(
          Status::bad_data,
          path + ": the BTF is incomplete: its capture was stopped. Run the same capture command with '--resume'.");
    }
    content_ = std::move(*decoded.content);
    layout_ = index_.layout;
    grid_ = index_.grid;
    shell_ = index_.shell;
  }

  /// Checks the view's file and returns its size in bytes.
  uint64_t check_view(size_t view) const {
    const std::vector<ImageStack> stacks = view_stacks(index_, view);
    if (stacks.empty()) return 0;
    const ImageStackFile file(view_path(path_, view), stacks);
    file.check_chunk_tables();
    return file.bytes();
  }

  /// Reads pairs [first, first + count) of one part, view by view.
  void read_images(size_t part, uint64_t first, uint64_t count, std::span<HalfBits> values) const {
    check_range(first, count);
    for (uint64_t pair = first; pair < first + count;) {
      const uint32_t view = layout().view_of(pair);
      const uint64_t end = std::min(layout().first(view + 1), first + count);
      const std::vector<ImageStack> stacks = view_stacks(index_, view);
      const uint64_t halves = stacks[part].image_bytes() / sizeof(HalfBits);
      const ImageStackFile file(view_path(path_, view), stacks);
      file.read(part, pair - layout().first(view),
                writable_bytes(values.subspan((pair - first) * halves, (end - pair) * halves)));
      pair = end;
    }
  }

  std::string path_;
  BtfIndex index_;
  BtfContent content_;
};

}  // namespace

std::shared_ptr<const BtfMeasurement> load_btf_folder(const std::string& path, const std::optional<Vec2>& tile_metres) {
  return std::make_shared<BtfFolder>(path, tile_metres);
}

namespace fs = std::filesystem;
namespace {

template <typename T>
std::span<const uint8_t> bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

std::string index_path(const std::string& folder) { return fs::path(folder) / "btf.json"; }

DecodedBtfIndex read_index(const std::string& folder) {
  const std::string path = index_path(folder);
  return decode_btf_index(read_file(path, kMaxBtfIndexBytes), path);
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

std::string view_path(const std::string& folder, size_t view) {
  std::string number = std::to_string(view);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return std::filesystem::path(folder) / ("view_" + number + ".exr");
}

std::vector<ImageStack> view_stacks(const BtfIndex& index, size_t view) {
  const uint64_t lights = index.layout.first(view + 1) - index.layout.first(view);
  const TexelGrid& grid = index.grid;
  std::vector<ImageStack> stacks;
  if (lights > 0) stacks.push_back({"values", StackValue::half, 3, grid.width, grid.height, lights});
  if (lights > 0 && index.errors) stacks.push_back({"errors", StackValue::half, 1, grid.width, grid.height, lights});
  if (!index.structure) return stacks;
  for (const char* name : {"coverage", "height_mean", "height_spread"}) {
    stacks.push_back({name, StackValue::float32, 1, grid.width, grid.height, 1});
  }
  return stacks;
}

}  // namespace velour
