#include "brdf/formats/merl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/byte_reader.h"
#include "base/file.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"

namespace velour {
namespace {

constexpr BrdfTableLayout kMerlLayout{
    .theta_h = MerlGrid::theta_h, .phi_h = 1, .theta_d = MerlGrid::theta_d, .phi_d = MerlGrid::phi_d};
constexpr size_t kHeaderBytes = 3 * sizeof(int32_t);
constexpr int32_t kMaxNodes = 4096;  // per axis; larger numbers cannot be a table's header
/// Stored value x scale = f in 1/sr; the camera's exposures, fixed by the format.
constexpr double kScale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

using Dimensions = std::array<int32_t, 3>;

template <typename T>
T stored_number(const uint8_t* at, bool is_big_endian) {
  std::array<uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

Dimensions stored_dimensions(std::span<const uint8_t> header, bool is_big_endian) {
  Dimensions found;
  for (size_t i = 0; i < 3; ++i) {
    found[i] = stored_number<int32_t>(header.data() + i * sizeof(int32_t), is_big_endian);
  }
  return found;
}

bool are_plausible(const Dimensions& dimensions) {
  return std::ranges::all_of(dimensions, [](int32_t count) { return count >= 2 && count <= kMaxNodes; });
}

/// Storage of a file's table. Some programs write tables of other sizes than the database's, as float32, or in the byte
/// order of their machine; the header and the file's length tell which.
struct MerlStorage {
  BrdfTableLayout layout;
  bool is_big_endian;
  size_t number_bytes;  // size of a float64 or float32
};

MerlStorage storage_of(ByteReader& in) {
  const auto header = in.take(kHeaderBytes, "header");
  const bool is_big_endian =
      !are_plausible(stored_dimensions(header, false)) && are_plausible(stored_dimensions(header, true));
  const Dimensions counts = stored_dimensions(header, is_big_endian);
  constexpr const char* kFields[] = {"theta_half", "theta_diff", "phi_diff"};
  std::string names;
  for (size_t i = 0; i < 3; ++i) {
    const std::string field = std::string(kFields[i]) + " is " + std::to_string(counts[i]);
    if (counts[i] < 2 || counts[i] > kMaxNodes)
      throw Error(Status::bad_data, in.name() + ": MERL dimension " + field + "; it must be 2 to " +
                                        std::to_string(kMaxNodes) + " (90, 90 and 180 in the MERL database).");
    names += (i == 0 ? "" : ", ") + field;
  }
  const BrdfTableLayout layout{.theta_h = counts[0], .phi_h = 1, .theta_d = counts[1], .phi_d = counts[2]};
  for (const size_t number_bytes : {sizeof(double), sizeof(float)}) {
    if (in.remaining() != 3 * number_bytes * layout.size()) continue;
    if (layout.phi_d > MerlGrid::phi_d)
      throw Error(Status::bad_data, in.name() + ": MERL dimension phi_diff is " + std::to_string(layout.phi_d) +
                                        ", and the header does not say whether that covers 180 degrees, as in the MERL "
                                        "database, or 360. Write 180 degrees in at most 180 steps.");
    return {layout, is_big_endian, number_bytes};
  }
  const size_t of_float64 = kHeaderBytes + 3 * sizeof(double) * layout.size();
  const size_t of_float32 = kHeaderBytes + 3 * sizeof(float) * layout.size();
  throw Error(Status::bad_data, in.name() + ": holds " + std::to_string(kHeaderBytes + in.remaining()) +
                                    " bytes, but a MERL table whose " + names + " has " + std::to_string(of_float64) +
                                    " (float64) or " + std::to_string(of_float32) +
                                    " (float32). Download or write it again.");
}

/// Reads the planes by copying: their doubles lie at odd multiples of four bytes.
class StoredPlanes {
 public:
  StoredPlanes(const MerlStorage& storage, const uint8_t* data) : storage_(storage), data_(data) {}
  Rgb f(size_t index) const { return {channel(0, index), channel(1, index), channel(2, index)}; }

 private:
  float channel(size_t c, size_t index) const {
    const uint8_t* at = data_ + (c * storage_.layout.size() + index) * storage_.number_bytes;
    const bool swap = storage_.is_big_endian;
    const double stored = storage_.number_bytes == sizeof(double) ? stored_number<double>(at, swap)
                                                                  : double{stored_number<float>(at, swap)};
    return static_cast<float>(stored * kScale[c]);
  }
  const MerlStorage& storage_;
  const uint8_t* data_;
};

std::vector<TableNode> read_nodes(const BrdfTableLayout& layout, const StoredPlanes& planes, EntryCounts& counts) {
  const HorizonTest horizon(layout);
  std::vector<TableNode> nodes(layout.size());
  for (int i = 0; i < layout.theta_h; ++i)
    for (int j = 0; j < layout.theta_d; ++j)
      for (int k = 0; k < layout.phi_d; ++k) {
        const size_t index = layout.index(i, 0, j, k);
        if (!horizon.above(i, j, k)) {
          count_below_horizon(counts);
          continue;
        }
        const Rgb f = planes.f(index);
        if (count_entry(f, NegativeRule::any_channel, counts)) nodes[index] = {{f.r, f.g, f.b, 1.0f}};
      }
  return nodes;
}

TableMeasurement::Details describe(const MerlStorage& storage) {
  const BrdfTableLayout& layout = storage.layout;
  const std::string theta_h = std::to_string(layout.theta_h);
  return {{"table", theta_h + " theta_half x " + std::to_string(layout.theta_d) + " theta_diff x " +
                        std::to_string(layout.phi_d) + " phi_diff, 3 channels of " +
                        (storage.number_bytes == sizeof(double) ? "float64" : "float32") +
                        (storage.is_big_endian ? ", big-endian" : "")},
          {"holds", "f without cosine, stored value x scale, 1/sr"},
          {"scales", "1/1500, 1.15/1500, 1.66/1500"},
          {"invalid", "nodes with a negative channel"},
          {"interpolation", "trilinear over valid nodes, node i of theta_half at 90 (i/" + theta_h + ")^2 degrees"}};
}

}  // namespace

DirectionPair MerlGrid::pair(int i, int j, int k) { return kMerlLayout.pair(i, 0, j, k); }

bool looks_like_merl(std::span<const uint8_t> head) {
  return head.size() >= kHeaderBytes &&
         (are_plausible(stored_dimensions(head, false)) || are_plausible(stored_dimensions(head, true)));
}

std::shared_ptr<const Measurement> read_merl(std::span<const uint8_t> bytes, Provenance provenance) {
  ByteReader in(bytes, provenance.path);
  const MerlStorage storage = storage_of(in);
  EntryCounts counts;
  const StoredPlanes planes(storage, in.take(in.remaining(), "table").data());
  auto nodes = read_nodes(storage.layout, planes, counts);
  provenance.format = "merl";
  return std::make_shared<TableMeasurement>(HalfDiffTable(storage.layout, std::move(nodes)), std::move(provenance),
                                            counts, describe(storage));
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
  std::vector<uint8_t> bytes(kHeaderBytes + 3 * MerlGrid::size * sizeof(double));
  std::memcpy(bytes.data(), kDimensions, kHeaderBytes);
  std::memcpy(bytes.data() + kHeaderBytes, stored.data(), stored.size() * sizeof(double));
  write_file(path, bytes);
}

}  // namespace velour
