#include "model/tensor_btf_file.h"

#include <algorithm>

#include "image/half_image.h"
#include "model/btf_sides.h"

namespace velour {
namespace {

/// Names of the parts of side `number`.
struct TensorSideParts {
  explicit TensorSideParts(size_t number) : prefix(side_prefix(number)) {}
  std::string view() const { return prefix + "view"; }
  std::string light() const { return prefix + "light"; }
  std::string color() const { return prefix + "color"; }
  std::string core() const { return prefix + "core"; }
  std::string scales() const { return prefix + "scales"; }
  std::string relief(size_t level) const { return prefix + "relief." + std::to_string(level); }
  std::string members(size_t level) const { return prefix + "members." + std::to_string(level); }
  std::string bytes(size_t level) const { return prefix + "bytes." + std::to_string(level); }
  std::string prefix;
};

/// Concatenates the member `own` of all clusters.
template <typename Value>
std::vector<Value> joined(const TensorSide& side, std::vector<Value> TensorBtfCluster::*own) {
  std::vector<Value> all;
  for (const TensorBtfCluster& c : side.clusters) all.insert(all.end(), (c.*own).begin(), (c.*own).end());
  return all;
}
template <typename Value>
void split(const std::vector<Value>& all, std::vector<Value> TensorBtfCluster::*own, TensorSide& side) {
  const auto each = static_cast<std::ptrdiff_t>(all.size() / side.clusters.size());
  auto from = all.begin();
  for (TensorBtfCluster& c : side.clusters) {
    (c.*own).assign(from, from + each);
    from += each;
  }
}

void write_side(const TensorSide& side, const TensorSideParts& part, TensorFile& file) {
  const uint64_t clusters = side.clusters.size();
  const auto write_halves = [&](const std::string& name, std::vector<HalfBits> TensorBtfCluster::*own, uint64_t rank) {
    const std::vector<HalfBits> halves = joined(side, own);
    file.tensors[name] = tensor_of(halves, {clusters, halves.size() / clusters / rank, rank});
  };
  write_halves(part.view(), &TensorBtfCluster::view, side.rank.view);
  write_halves(part.light(), &TensorBtfCluster::light, side.rank.light);
  write_halves(part.color(), &TensorBtfCluster::color, side.rank.color);
  write_halves(part.core(), &TensorBtfCluster::core, uint64_t{side.rank.view} * side.rank.light * side.rank.color);
  file.tensors[part.scales()] = scales_tensor(joined(side, &TensorBtfCluster::scale), {clusters, side.rank.texel});
  for (size_t l = 0; l < side.levels.size(); ++l) {
    const TensorLevel& level = side.levels[l];
    const uint32_t width = level.width, height = level.height;
    if (!level.relief.empty()) file.tensors[part.relief(l)] = tensor_of(level.relief, {height, width});
    file.tensors[part.members(l)] = byte_maps(level.member, side.members, width, height);
    file.tensors[part.bytes(l)] = byte_maps(level.value, uint64_t{side.members} * side.rank.texel, width, height);
  }
}

/// An extent of a part's shape, from 1 to `most`.
uint32_t extent_of(const ModelFields& fields, const std::string& part, size_t dimensions, size_t dimension,
                   size_t most) {
  const Tensor& tensor = fields.tensor(part);
  if (tensor.shape.size() != dimensions) {
    fields.fail("the part " + part + " must have " + std::to_string(dimensions) + " dimensions.");
  }
  const uint64_t extent = tensor.shape[dimension];
  if (extent >= 1 && extent <= most) return static_cast<uint32_t>(extent);
  fields.fail("the part " + part + " has " + std::to_string(extent) + " entries along dimension " +
              std::to_string(dimension) + "; it must have 1 to " + std::to_string(most) + ".");
}

void check_ranks(const ModelFields& fields, const TensorSideParts& part, const TensorSide& side) {
  for (const uint32_t rank : {side.rank.texel, side.rank.light}) {
    if (side.clusters.size() * padded_rank(rank) <= TensorBtf::kMaxClusterRanks) continue;
    fields.fail(part.core() + " has " + std::to_string(side.clusters.size()) + " clusters of rank " +
                std::to_string(rank) + "; clusters times rank, rounded up to a multiple of " +
                std::to_string(kRankPadding) + ", must be at most " + std::to_string(TensorBtf::kMaxClusterRanks) +
                ".");
  }
}

/// Number of directions on the side. Throws if there are none.
uint64_t directions_of(const ModelFields& fields, const std::vector<PolarAngles>& set, bool below, const char* what) {
  const size_t count = directions_on_side(set, below).size();
  if (count == 0) {
    fields.fail(std::string("btf.sides has a side ") + (below ? "below" : "above") +
                " the plane, but velour.btf.index has no " + what + " there.");
  }
  return count;
}

void read_factors(const ModelFields& fields, const TensorSideParts& part, const PairLayout& layout, TensorSide& side) {
  side.clusters.resize(extent_of(fields, part.core(), 3, 0, TensorBtf::kMaxClusters));
  side.rank = {extent_of(fields, part.core(), 3, 1, TensorBtf::kMaxRank),
               extent_of(fields, part.view(), 3, 2, TensorBtf::kMaxRank),
               extent_of(fields, part.light(), 3, 2, TensorBtf::kMaxRank), extent_of(fields, part.color(), 3, 2, 3)};
  check_ranks(fields, part, side);
  const uint64_t clusters = side.clusters.size(), view = side.rank.view, light = side.rank.light,
                 color = side.rank.color, views = directions_of(fields, layout.views(), side.view_below, "view"),
                 lights = directions_of(fields, layout.lights(), side.light_below, "light");
  const auto read = [&](const std::string& name, const std::vector<uint64_t>& shape,
                        std::vector<HalfBits> TensorBtfCluster::*own) {
    split(shaped_halves(fields, name, shape), own, side);
  };
  read(part.view(), {clusters, views, view}, &TensorBtfCluster::view);
  read(part.light(), {clusters, lights, light}, &TensorBtfCluster::light);
  read(part.color(), {clusters, 3, color}, &TensorBtfCluster::color);
  read(part.core(), {clusters, side.rank.texel, view * light * color}, &TensorBtfCluster::core);
  split(read_scales(fields, part.scales(), {clusters, side.rank.texel}), &TensorBtfCluster::scale, side);
}

/// Checks that the members of each texel are distinct, existing clusters.
void check_members(const ModelFields& fields, const std::string& part, const TensorLevel& level,
                   const TensorSide& side) {
  const size_t texels = size_t{level.width} * level.height;
  const auto place = [&](size_t t, size_t k) { return k * texels + t; };  // in the part
  for (size_t t = 0; t < texels; ++t) {
    const uint8_t* member = level.member.data() + t * side.members;
    for (size_t k = 0; k < side.members; ++k) {
      const bool again = std::find(member, member + k, member[k]) != member + k;
      if (member[k] < side.clusters.size() && !again) continue;
      fields.fail_at(part, place(t, k), static_cast<float>(member[k]) / 256,
                     again ? "a cluster that does not occur before it" : "the index of a cluster, divided by 256");
    }
  }
}

TensorLevel read_level(const ModelFields& fields, const TensorSideParts& part, size_t number, uint32_t width,
                       uint32_t height, const TensorSide& side) {
  TensorLevel level{width, height, {}, {}, {}};
  if (fields.has(part.relief(number))) level.relief = shaped_halves(fields, part.relief(number), {height, width});
  level.member = read_byte_maps(fields, part.members(number), side.members, width, height);
  check_members(fields, part.members(number), level, side);
  level.value = read_byte_maps(fields, part.bytes(number), uint64_t{side.members} * side.rank.texel, width, height);
  return level;
}

TensorSide read_side(const ModelFields& fields, const TensorSideParts& part, const BtfFrame& frame,
                     const SideTable::Place& place) {
  TensorSide side;
  side.view_below = place.view_below;
  side.light_below = place.light_below;
  read_factors(fields, part, frame.layout, side);
  side.members = extent_of(fields, part.members(0), 3, 0, std::min(side.clusters.size(), TensorBtf::kMaxMembers));
  uint32_t width = frame.grid.width, height = frame.grid.height;
  for (;; width = half_of(width), height = half_of(height)) {
    side.levels.push_back(read_level(fields, part, side.levels.size(), width, height, side));
    if (width == 1 && height == 1) return side;
  }
}

}  // namespace

void write_tensor_btf(const TensorBtf& btf, TensorFile& file) {
  write_btf_frame({btf.layout, btf.grid, btf.companding, btf.axes}, file);
  write_side_table(side_table(btf), file);
  for (size_t s = 0; s < btf.sides.size(); ++s) write_side(btf.sides[s], TensorSideParts(s), file);
}

TensorBtf read_tensor_btf(const ModelFields& fields) {
  const BtfFrame frame = read_btf_frame(fields);
  TensorBtf btf{frame.layout, frame.grid, frame.companding, frame.axes, {}};
  SideTable table = read_side_table(fields);
  for (const SideTable::Place& place : table.sides) {
    btf.sides.push_back(read_side(fields, TensorSideParts(btf.sides.size()), frame, place));
  }
  btf.shared = std::move(table.shared);
  return btf;
}

}  // namespace velour
