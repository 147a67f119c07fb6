#include "btf/model/tensor_images.h"

#include <cmath>
#include <optional>

#include "btf/measure/relief.h"
#include "btf/model/tensor_btf.h"
#include "image/bilinear_texels.h"
#include "math/sphere/direction_mesh.h"

namespace velour {
namespace {

/// The row of a factor, interpolated between directions.
std::vector<float> between(const std::vector<float>& factor, size_t rank, const DirectionMesh::Weights& at) {
  std::vector<float> row(rank, 0.0f);
  for (size_t i = 0; i < 3; ++i) {
    const float* from = factor.data() + at.index[i] * rank;
    for (size_t r = 0; r < rank; ++r) row[r] += at.weight[i] * from[r];
  }
  return row;
}

/// A cluster's contribution to a texel for a pair: a linear function of the texel's bytes, per channel.
struct ByteFunction {
  Vec3 constant{0.0f};
  std::vector<float> slope;  // [channel][rank]
};

Vec3 mirrored_up(const Vec3& w) { return {w.x, w.y, std::abs(w.z)}; }

}  // namespace

struct TensorImages::Side {
  Side(const TensorBtf& btf, const TensorSide& s)
      : side(s),
        views(directions_on_side(btf.layout.views(), s.view_below)),
        lights(directions_on_side(btf.layout.lights(), s.light_below)) {
    for (const TensorBtfCluster& cluster : s.clusters) clusters.emplace_back(btf, cluster);
    const TensorLevel& level = s.levels.at(0);
    if (!level.relief.empty()) relief.emplace(level.width, level.height, heights_of(level), tile_aspect(btf.grid));
  }

  ByteFunction function_of(size_t cluster, const DirectionMesh::Weights& view,
                           const DirectionMesh::Weights& light) const {
    const TensorFactors& from = clusters[cluster];
    const TensorSide::Ranks& rank = side.rank;
    const std::vector<float> v = between(from.view, rank.view, view), l = between(from.light, rank.light, light);
    ByteFunction function{Vec3(0.0f), std::vector<float>(size_t{3} * rank.texel)};
    const float* core = from.core.data();
    for (size_t r = 0; r < rank.texel; ++r) {
      Vec3 basis(0.0f);
      for (size_t i = 0; i < rank.view; ++i) {
        for (size_t j = 0; j < rank.light; ++j) {
          for (size_t k = 0; k < rank.color; ++k) {
            const float part = v[i] * l[j] * *core++;
            for (size_t c = 0; c < 3; ++c) basis[static_cast<int>(c)] += part * from.color[c * rank.color + k];
          }
        }
      }
      const ByteScale& scale = side.clusters[cluster].scale[r];
      function.constant += scale.least * basis;
      for (size_t c = 0; c < 3; ++c) function.slope[c * rank.texel + r] = scale.step * basis[static_cast<int>(c)];
    }
    return function;
  }

  /// The sums of all texels, [row][column], in linear Rec. 709.
  std::vector<Vec3> sums_of(const DirectionMesh::Weights& view, const DirectionMesh::Weights& light) const {
    std::vector<ByteFunction> functions;
    for (size_t c = 0; c < clusters.size(); ++c) functions.push_back(function_of(c, view, light));
    const TensorLevel& level = side.levels[0];
    const size_t rank = side.rank.texel;
    std::vector<Vec3> sums(size_t{level.width} * level.height, Vec3(0.0f));
    for (size_t i = 0; i < level.member.size(); ++i) {
      const ByteFunction& function = functions[level.member[i]];
      const uint8_t* bytes = level.value.data() + i * rank;
      Vec3 sum = function.constant;
      for (size_t c = 0; c < 3; ++c) {
        for (size_t r = 0; r < rank; ++r) {
          sum[static_cast<int>(c)] += function.slope[c * rank + r] * static_cast<float>(bytes[r]);
        }
      }
      sums[i / side.members] += sum;
    }
    return sums;
  }

  Vec3 sum_at(const std::vector<Vec3>& sums, size_t texel, const Vec3& wv) const {
    if (!relief) return sums[texel];
    const uint32_t width = relief->width(), height = relief->height();
    const Vec2 place((static_cast<float>(texel % width) + 0.5f) / static_cast<float>(width),
                     (static_cast<float>(texel / width) + 0.5f) / static_cast<float>(height));
    const BilinearTexels corners = bilinear_at(relief->seen_texel(place, wv), width, height);
    Vec3 sum(0.0f);
    for (size_t i = 0; i < 4; ++i) sum += corners.weight[i] * sums[corners.index[i]];
    return sum;
  }

  const TensorSide& side;
  DirectionMesh views, lights;
  std::vector<TensorFactors> clusters;
  std::optional<Relief> relief;
};

struct TensorImages::Impl {
  const TensorBtf& btf;
  std::vector<Side> sides;
};

TensorImages::TensorImages(const TensorBtf& btf) {
  auto impl = std::make_unique<Impl>(Impl{btf, {}});
  for (const TensorSide& side : btf.sides) impl->sides.emplace_back(btf, side);
  impl_ = std::move(impl);
}

TensorImages::~TensorImages() = default;

void TensorImages::image(const DirectionPair& pair, std::vector<float>& rgb) const {
  const TensorBtf& btf = impl_->btf;
  rgb.assign(btf.grid.texels() * 3, 0.0f);
  const auto number = serving_side(btf, pair.wv.z < 0, pair.wl.z < 0);
  if (!number) return;
  const Side& side = impl_->sides[*number];
  const Vec3 wv = mirrored_up(pair.wv), wl = mirrored_up(pair.wl);
  const std::vector<Vec3> sums = side.sums_of(side.views.at(wv), side.lights.at(wl));
  for (size_t t = 0; t < sums.size(); ++t) {
    const Vec3 sum = side.sum_at(sums, t, wv);
    for (int c = 0; c < 3; ++c) rgb[3 * t + static_cast<size_t>(c)] = expanded(btf.companding, sum[c]);
  }
}

}  // namespace velour
