// BTFs of clustered tensors made of random numbers, and what they mean.
#pragma once

#include <cmath>

#include "btf/measure/relief.h"
#include "btf/model/tensor_btf.h"
#include "image/texels.h"
#include "math/sphere/direction_mesh.h"
#include "math/sphere/random.h"

namespace velour::test {

struct TensorShape {
  uint32_t clusters = 3, members = 2;
  TensorSide::Ranks rank{5, 4, 3, 2};
  bool relief = true;
};

inline std::vector<HalfBits> halves_of(const std::vector<float>& floats) {
  std::vector<HalfBits> bits(floats.size());
  floats_to_halves(floats, bits);
  return bits;
}

/// Rows of `rank` numbers: 1, then random ones in [-swing, swing].
inline std::vector<HalfBits> random_rows(size_t rows, size_t rank, float swing, RandomStream& random) {
  std::vector<float> floats(rows * rank);
  for (size_t i = 0; i < floats.size(); ++i) floats[i] = i % rank == 0 ? 1.0f : swing * (2 * random.next() - 1);
  return halves_of(floats);
}

/// The first entries of all factors make a positive mean, about which the others swing.
inline TensorBtfCluster random_cluster(size_t views, size_t lights, const TensorShape& shape, RandomStream& random) {
  const TensorSide::Ranks& rank = shape.rank;
  TensorBtfCluster cluster;
  cluster.view = random_rows(views, rank.view, 0.5f, random);
  cluster.light = random_rows(lights, rank.light, 0.5f, random);
  cluster.color = random_rows(3, rank.color, 0.5f, random);
  cluster.core = random_rows(1, size_t{rank.texel} * rank.view * rank.light * rank.color, 0.2f, random);
  const float share = 1 / static_cast<float>(shape.members);
  for (uint32_t r = 0; r < rank.texel; ++r) {
    const float least = r == 0 ? 0.3f : -0.2f, most = r == 0 ? 0.7f : 0.25f;
    cluster.scale.push_back({share * least, share * (most - least) / 255});
  }
  return cluster;
}

inline TensorLevel random_level(uint32_t width, uint32_t height, const TensorShape& shape, RandomStream& random) {
  TensorLevel level{width, height, {}, {}, {}};
  const size_t texels = size_t{width} * height;
  std::vector<float> heights;
  for (size_t t = 0; t < texels; ++t) {
    const auto first = static_cast<uint32_t>(random.next_bits() % shape.clusters);
    for (uint32_t k = 0; k < shape.members; ++k) level.member.push_back(uint8_t((first + k) % shape.clusters));
    for (uint32_t i = 0; i < shape.members * shape.rank.texel; ++i) level.value.push_back(uint8_t(random.next_bits()));
    heights.push_back(width > 1 ? 0.05f * random.next() : 0.0f);
  }
  if (shape.relief) level.relief = halves_of(heights);
  return level;
}

inline TensorSide random_side(const PairLayout& layout, const TexelGrid& grid, bool below, const TensorShape& shape) {
  RandomStream random(31, below, shape.clusters);
  TensorSide side{below, below, shape.rank, shape.members, {}, {}};
  const size_t views = directions_on_side(layout.views(), below).size(),
               lights = directions_on_side(layout.lights(), below).size();
  for (uint32_t c = 0; c < shape.clusters; ++c) side.clusters.push_back(random_cluster(views, lights, shape, random));
  for (uint32_t width = grid.width, height = grid.height;; width = half_of(width), height = half_of(height)) {
    side.levels.push_back(random_level(width, height, shape, random));
    if (width == 1 && height == 1) return side;
  }
}

/// 6 x 4 texels; views and lights on one side, or on both, of which the lower one is another shape's, without a relief.
inline TensorBtf example_tensor(bool two_sided = false, Companding companding = Companding::root,
                                const TensorShape& shape = {}) {
  std::vector<PolarAngles> views = ring_directions(30, 5), lights = ring_directions(50, 6);
  views.push_back({0, 0});
  if (two_sided) {
    for (const PolarAngles& d : below(views)) views.push_back(d);
    for (const PolarAngles& d : below(lights)) lights.push_back(d);
  }
  TensorBtf btf{PairLayout(views, lights), {6, 4, Vec2(0.002f, 0.003f)}, companding, Mat3(1.0f), {}};
  btf.axes = Mat3(Vec3(0.8f, 0.6f, 0.0f), Vec3(-0.6f, 0.8f, 0.0f), Vec3(0.0f, 0.0f, 1.0f));
  btf.sides.push_back(random_side(btf.layout, btf.grid, false, shape));
  if (two_sided) btf.sides.push_back(random_side(btf.layout, btf.grid, true, {2, 1, {3, 2, 5, 1}, false}));
  return btf;
}

/// One entry of a factor [direction][rank], interpolated.
inline double between(const std::vector<HalfBits>& factor, size_t rank, size_t entry,
                      const DirectionMesh::Weights& at) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) {
    const float value = finite_half_to_float(factor[at.index[i] * rank + entry]);
    sum += static_cast<double>(at.weight[i]) * static_cast<double>(value);
  }
  return sum;
}

/// basis_{c,r}(v, l, a) of btf/model/tensor_btf.h, for the three axes.
inline Vec3d defined_basis(const TensorSide& side, const TensorBtfCluster& c, size_t r,
                           const DirectionMesh::Weights& view, const DirectionMesh::Weights& light) {
  const TensorSide::Ranks& rank = side.rank;
  Vec3d basis(0.0);
  for (size_t i = 0; i < rank.view; ++i) {
    for (size_t j = 0; j < rank.light; ++j) {
      for (size_t k = 0; k < rank.color; ++k) {
        const auto core =
            static_cast<double>(finite_half_to_float(c.core[((r * rank.view + i) * rank.light + j) * rank.color + k]));
        const double part = core * between(c.view, rank.view, i, view) * between(c.light, rank.light, j, light);
        for (size_t a = 0; a < 3; ++a) {
          basis[static_cast<int>(a)] += part * static_cast<double>(finite_half_to_float(c.color[a * rank.color + k]));
        }
      }
    }
  }
  return basis;
}

/// s of one texel.
inline Vec3d defined_sum(const TensorSide& side, const TensorLevel& level, size_t texel,
                         const DirectionMesh::Weights& view, const DirectionMesh::Weights& light) {
  Vec3d sum(0.0);
  for (size_t k = 0; k < side.members; ++k) {
    const TensorBtfCluster& cluster = side.clusters[level.member[texel * side.members + k]];
    for (size_t r = 0; r < side.rank.texel; ++r) {
      const uint8_t byte = level.value[(texel * side.members + k) * side.rank.texel + r];
      const double value =
          static_cast<double>(cluster.scale[r].least) + static_cast<double>(cluster.scale[r].step) * byte;
      sum += value * defined_basis(side, cluster, r, view, light);
    }
  }
  return sum;
}

/// f by the definition in btf/model/tensor_btf.h: of a side, at a place of a level, for directions with z > 0.
inline Rgb defined_value(const TensorBtf& btf, const TensorSide& side, size_t number, const Vec2& uv,
                         const DirectionPair& pair) {
  const TensorLevel& level = side.levels[number];
  Vec2 place = uv;
  if (!level.relief.empty()) {
    place = Relief(level.width, level.height, heights_of(level), tile_aspect(btf.grid)).seen(uv, pair.wv);
  }
  const auto view = DirectionMesh(directions_on_side(btf.layout.views(), side.view_below)).at(pair.wv),
             light = DirectionMesh(directions_on_side(btf.layout.lights(), side.light_below)).at(pair.wl);
  const BilinearTexels texels = bilinear_texels(place, level.width, level.height);
  Vec3d sum(0.0);
  for (size_t i = 0; i < 4; ++i) {
    sum += static_cast<double>(texels.weight[i]) * defined_sum(side, level, texels.index[i], view, light);
  }
  const Vec3 color = btf.axes * Vec3(sum);
  return {expanded(btf.companding, color.r), expanded(btf.companding, color.g), expanded(btf.companding, color.b)};
}

}  // namespace velour::test
