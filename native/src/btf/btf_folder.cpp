#include "btf/btf_folder.h"

#include <filesystem>

#include "btf/view_file.h"
#include "file/file.h"
#include "image/image_stack_file.h"
#include "job/error.h"

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
      : BtfFolder(path, index_path, read_file(index_path, kMostBtfIndexBytes)) {}

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

}  // namespace velour
