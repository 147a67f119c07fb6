#include "btf/formats/btf_export.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "btf/formats/picture_index.h"
#include "image/image_stack.h"

namespace velour {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kBytesAtOnce = uint64_t{32} << 20;

bool is_named(const PolarAngles& d) {
  const auto is_whole = [](double degrees) { return degrees >= 0 && degrees < 1000 && degrees == std::floor(degrees); };
  return is_whole(d.theta) && is_whole(d.phi);
}

/// Shortest text that parses back to the same bits.
std::string number_text(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string csv_line(const PairLayout& layout, uint64_t pair, const std::string& file) {
  const uint32_t v = layout.view_of(pair), l = layout.light_of(pair);
  const PolarAngles &view = layout.views()[v], &light = layout.lights()[l];
  return file + "," + number_text(light.theta) + "," + number_text(light.phi) + "," + number_text(view.theta) + "," +
         number_text(view.phi) + "," + std::to_string(v) + "," + std::to_string(l) + "\n";
}

class Export {
 public:
  Export(const BtfMeasurement& btf, std::string path) : btf_(btf), path_(std::move(path)) {
    const PairLayout& layout = btf_.layout();
    named_ = layout.complete() && std::ranges::all_of(layout.views(), is_named) &&
             std::ranges::all_of(layout.lights(), is_named);
    at_once_ = std::max<uint64_t>(1, kBytesAtOnce / (btf_.grid().texels() * 3 * sizeof(HalfBits)));
    attributes_["velour.values"] = "brdf";
    const auto& tile = btf_.grid().tile_metres;
    if (tile) {
      attributes_["velour.tile_metres"] =
          number_text(static_cast<double>(tile->x)) + " " + number_text(static_cast<double>(tile->y));
    }
  }

  BtfExportReport write(Progress& progress) {
    make_folder();
    BtfExportReport report{named_ ? "ubo2003" : "csv", btf_.layout().pairs()};
    for (uint64_t first = 0; first < report.pictures; first += at_once_) {
      progress.check();
      progress.update(static_cast<double>(first) / static_cast<double>(report.pictures));
      report.bytes += write_pairs(first, std::min(at_once_, report.pictures - first));
    }
    if (!named_) report.bytes += write_index();
    return report;
  }

 private:
  void make_folder() const {
    std::error_code failure;
    fs::create_directories(path_, failure);
    if (failure) throw Error(Status::io, path_ + ": cannot create the folder: " + failure.message() + ".");
    if (!fs::is_empty(path_)) throw Error(Status::io, path_ + ": the folder is not empty; choose a new folder.");
  }

  std::string file_name(uint64_t pair) const {
    const PairLayout& layout = btf_.layout();
    const uint32_t v = layout.view_of(pair), l = layout.light_of(pair);
    // The Bonn sets number pairs by light, then by view.
    const uint64_t index = named_ ? l * layout.views().size() + v : pair;
    if (named_) return name_of_angles({layout.lights()[l], layout.views()[v], index}) + ".exr";
    std::string number = std::to_string(index);
    number.insert(0, number.size() < 6 ? 6 - number.size() : 0, '0');
    return "pair_" + number + ".exr";
  }

  /// Returns the number of bytes written.
  uint64_t write_pairs(uint64_t first, uint64_t count) {
    const uint64_t image = btf_.grid().texels() * 3;
    values_.resize(count * image);
    btf_.read_pairs(first, count, values_);
    std::atomic<uint64_t> bytes = 0;
    tbb::parallel_for(uint64_t{0}, count, [&](uint64_t i) {
      bytes += write_picture_of(fs::path(path_) / file_name(first + i), std::span(values_).subspan(i * image, image));
    });
    return bytes;
  }

  uint64_t write_picture_of(const std::string& file, std::span<const HalfBits> values) const {
    const TexelGrid& grid = btf_.grid();
    const ImageStack stack{"values", StackValue::half, 3, grid.width, grid.height, 1};
    const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes());
    write_image_stacks(file, {&stack, 1}, {&bytes, 1}, attributes_);
    return fs::file_size(file);
  }

  uint64_t write_index() const {
    std::string text = "file,theta_l,phi_l,theta_v,phi_v,view,light\n";
    for (uint64_t pair = 0; pair < btf_.layout().pairs(); ++pair)
      text += csv_line(btf_.layout(), pair, file_name(pair));
    write_file(fs::path(path_) / "btf.csv", {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    return text.size();
  }

  const BtfMeasurement& btf_;
  std::string path_;
  bool named_ = false;
  uint64_t at_once_ = 1;  // pairs
  ImageAttributes attributes_;
  std::vector<HalfBits> values_;
};

}  // namespace

BtfExportReport export_btf(const BtfMeasurement& btf, const std::string& path, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  progress.stage("writing images", 0, 1);
  BtfExportReport report = Export(btf, path).write(progress);
  progress.update(1);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace velour
