// Sampling mixture of a BTF model.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>
#include "math/srbf/lobe_products.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

/// Appearance of a BTF point, as far as the sampling mixture depends on it.
struct BtfLook {
  static constexpr size_t kBroad = 7;
  Vec3 wv, normal;
  std::array<float, kBroad> broad;  // luminance of f cos at BtfDraws::centers()
  float mirror;                     // luminance of f cos in the mirror direction about `normal`
};

/// A BTF's f is a square of signed sums, which cannot be sampled in closed form but is cheap to evaluate. Each point
/// therefore gets its own mixture: seven broad lobes over the hemisphere, as strong as f cos at their centers (which
/// includes shadows and the slope of the relief); a half-vector lobe about the relief normal, as strong as f cos in the
/// mirror direction exceeds the broad lobes; and the cosine. It adds no bytes to the model and follows every texel.
/// Densities are exact; only their fit is rough. Immutable; thread-safe.
class BtfDraws {
 public:
  /// A point and a view, with the luminance of f cos at each of even_lights().
  struct Example {
    BtfLook look;
    std::vector<float> f;
  };
  /// Cosine-distributed light directions.
  static const std::vector<Vec3>& even_lights();
  /// Chooses the bandwidth of the half-vector lobe and the cosine share from a few candidates, by least variance under
  /// uniform light over `examples`. Cosine sampling alone is best for a diffuse surface without shadows.
  explicit BtfDraws(const std::vector<Example>& examples);

  static const std::array<Vec3, BtfLook::kBroad>& centers();
  /// False: plain cosine sampling; only `wv` and `normal` of a look are used.
  bool asks() const { return cosine_share_ < 1; }
  /// Whether BtfLook::mirror is used; it must then be evaluated at mirror().
  bool asks_mirror(const Vec3& wv, const Vec3& normal) const;
  static Vec3 mirror(const Vec3& wv, const Vec3& normal) { return 2 * glm::dot(wv, normal) * normal - wv; }

  /// Sets the density of `mixture`, and its value to 0. No allocation.
  void fill(const BtfLook& look, WarpedMixture& mixture) const;
  /// The lobes of `mixture` as Gaussians over light directions.
  static void propose(const WarpedMixture& mixture, ProposalLobes& lobes);

 private:
  float half_bandwidth_ = 0, cosine_share_ = 1;
};

// Table of the BTF values that BtfDraws needs.

/// f cos of one side of a BTF in the broad light directions of BtfDraws, over a pyramid of cells of the tile and over
/// views. Without it each point costs seven BTF evaluations although a path samples few lights there: two fifths of the
/// render time for 2 to 4 % less variance. The mirror direction is not tabulated: highlights are narrower than cells,
/// and missing one causes a firefly. Memory: at most 0.6 MB. Immutable; thread-safe.
class BtfLookTable {
 public:
  using Broad = std::array<float, BtfLook::kBroad>;
  /// Evaluates BtfLook::broad at `uv` on a level of the BTF's pyramid, seen from `wv`. Called concurrently.
  using Ask = std::function<Broad(const Vec2& uv, float level, const Vec3& wv)>;

  /// An empty table.
  BtfLookTable() = default;
  /// `texels`: resolution of the BTF along both axes of the tile.
  BtfLookTable(const Vec2& texels, const Ask& ask);

  /// Value of the nearest cell, quantized to within 4 %. `level`: mip level of the footprint.
  Broad look_up(const Vec2& uv, float level, const Vec3& wv) const;

 private:
  using Strengths = std::array<uint8_t, BtfLook::kBroad>;  // logarithmic

  size_t first_of(uint32_t level) const;

  uint32_t cells_ = 0;                // per axis of the tile, at the finest level; a power of 2
  float finest_ = 0;                  // level of the BTF's pyramid whose texels are as large as these cells
  std::vector<Strengths> strengths_;  // [level][row][column][view]
};

}  // namespace velour
