#include "brdf/merl.h"

#include <cmath>
#include <cstring>

#include "brdf/entries.h"
#include "brdf/table_measurement.h"
#include "file/byte_reader.h"
#include "file/file.h"

namespace velour {
namespace {

constexpr BrdfTableLayout kMerlLayout{
    .theta_h = MerlGrid::theta_h, .phi_h = 1, .theta_d = MerlGrid::theta_d, .phi_d = MerlGrid::phi_d};
constexpr size_t kHeaderBytes = 3 * sizeof(int32_t);
constexpr size_t kPlaneBytes = MerlGrid::size * sizeof(double);
/// Stored value x scale = f in 1/sr; the camera's exposures, fixed by the format.
constexpr double kScale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

void check_header(ByteReader& in) {
  constexpr std::pair<const char*, int32_t> kFields[] = {{"theta_half", 90}, {"theta_diff", 90}, {"phi_diff", 180}};
  for (const auto& [field, expected] : kFields) {
    const auto found = in.number<int32_t>(field);
    if (found != expected)
      throw Error(Status::bad_data, in.name() + ": MERL dimension " + field + " is " + std::to_string(found) +
                                        " where every MERL file has " + std::to_string(expected) + ".");
  }
  if (in.remaining() != 3 * kPlaneBytes)
    throw Error(Status::bad_data, in.name() + ": holds " + std::to_string(kHeaderBytes + in.remaining()) +
                                      " bytes where a MERL file has " + std::to_string(kHeaderBytes + 3 * kPlaneBytes) +
                                      "; download it again.");
}

/// The planes are doubles at an odd multiple of four bytes: read by copying.
class StoredPlanes {
 public:
  explicit StoredPlanes(const uint8_t* data) : data_(data) {}
  Rgb f(size_t index) const { return {channel(0, index), channel(1, index), channel(2, index)}; }

 private:
  float channel(size_t c, size_t index) const {
    double stored;
    std::memcpy(&stored, data_ + c * kPlaneBytes + index * sizeof(double), sizeof stored);
    return static_cast<float>(stored * kScale[c]);
  }
  const uint8_t* data_;
};

std::vector<TableNode> read_nodes(const StoredPlanes& planes, EntryCounts& counts) {
  const HorizonTest horizon(kMerlLayout);
  std::vector<TableNode> nodes(MerlGrid::size);
  for (int i = 0; i < MerlGrid::theta_h; ++i)
    for (int j = 0; j < MerlGrid::theta_d; ++j)
      for (int k = 0; k < MerlGrid::phi_d; ++k) {
        const size_t index = MerlGrid::index(i, j, k);
        if (!horizon.above(i, j, k)) {
          count_below_horizon(counts);
          continue;
        }
        const Rgb f = planes.f(index);
        if (count_entry(f, NegativeRule::any_channel, counts)) nodes[index] = {{f.r, f.g, f.b, 1.0f}};
      }
  return nodes;
}

TableMeasurement::Details describe() {
  return {{"table", "90 theta_half x 90 theta_diff x 180 phi_diff, 3 channels of float64"},
          {"holds", "f without cosine, stored value x scale, 1/sr"},
          {"scales", "1/1500, 1.15/1500, 1.66/1500"},
          {"invalid", "a node with any channel negative"},
          {"interpolation", "trilinear over valid nodes, node i of theta_half at i^2/90 degrees"}};
}

}  // namespace

DirectionPair MerlGrid::pair(int i, int j, int k) { return kMerlLayout.pair(i, 0, j, k); }

bool looks_like_merl(std::span<const uint8_t> head) {
  constexpr int32_t kDimensions[] = {90, 90, 180};
  return head.size() >= kHeaderBytes && std::memcmp(head.data(), kDimensions, kHeaderBytes) == 0;
}

std::shared_ptr<const Measurement> read_merl(std::span<const uint8_t> bytes, Provenance provenance) {
  ByteReader in(bytes, provenance.path);
  check_header(in);
  EntryCounts counts;
  auto nodes = read_nodes(StoredPlanes(in.take(3 * kPlaneBytes, "table").data()), counts);
  provenance.format = "merl";
  return std::make_shared<TableMeasurement>(HalfDiffTable(kMerlLayout, std::move(nodes)), std::move(provenance), counts,
                                            describe());
}

void write_merl(const std::string& path, std::span<const double> planes) {
  if (planes.size() != 3 * MerlGrid::size)
    throw Error(Status::invalid_argument, path + ": a MERL table has " + std::to_string(3 * MerlGrid::size) +
                                              " values, not " + std::to_string(planes.size()) + ".");
  const HorizonTest horizon(kMerlLayout);
  std::vector<double> stored(planes.size(), -1.0);
  for (size_t index = 0; index < MerlGrid::size; ++index) {
    const auto k = static_cast<int>(index % 180), j = static_cast<int>(index / 180 % 90);
    bool valid = horizon.above(static_cast<int>(index / (180 * 90)), j, k);
    for (size_t c = 0; c < 3; ++c) {
      const double f = planes[c * MerlGrid::size + index];
      valid = valid && std::isfinite(f) && f >= 0.0;
    }
    for (size_t c = 0; c < 3 && valid; ++c)
      stored[c * MerlGrid::size + index] = planes[c * MerlGrid::size + index] / kScale[c];
  }
  constexpr int32_t kDimensions[] = {90, 90, 180};
  std::vector<uint8_t> bytes(kHeaderBytes + 3 * kPlaneBytes);
  std::memcpy(bytes.data(), kDimensions, kHeaderBytes);
  std::memcpy(bytes.data() + kHeaderBytes, stored.data(), 3 * kPlaneBytes);
  write_file(path, bytes);
}

}  // namespace velour
