// Material of a BTF model that consists of sides, for any evaluator, and its sampling mixture.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>
#include "btf/eval/measured_btf_material.h"
#include "btf/model/srbf_btf.h"
#include "btf/model/tensor_btf.h"
#include "material/material.h"
#include "material/surface_site.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "math/srbf/lobe_products.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

// Sampling mixture of a BTF model.

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

/// Evaluates the looks of one side of a BTF for BtfDraws.
template <typename Evaluator>
class BtfLooks {
 public:
  BtfLooks(const Evaluator& evaluator, uint32_t side) {
    for (size_t i = 0; i < BtfLook::kBroad; ++i) broad_[i] = evaluator.light(side, BtfDraws::centers()[i]);
  }

  /// BtfLook::broad at a finished point.
  BtfLookTable::Broad broad(const Evaluator& evaluator, const typename Evaluator::Point& point) const {
    BtfLookTable::Broad broad;
    for (size_t i = 0; i < broad.size(); ++i) {
      broad[i] = luminance(evaluator.value(point, broad_[i])) * BtfDraws::centers()[i].z;
    }
    return broad;
  }
  /// BtfLook::mirror at a finished point.
  static float mirror(const Evaluator& evaluator, const typename Evaluator::Point& point, const Vec3& normal) {
    return radiance(evaluator, point, BtfDraws::mirror(point.wv, normal));
  }

  /// Examples at random points and views of `side`.
  std::vector<BtfDraws::Example> examples(const Evaluator& evaluator, uint32_t side) const {
    constexpr uint32_t kPlaces = 48;
    std::vector<BtfDraws::Example> examples;
    const auto point = std::make_unique<typename Evaluator::Point>();
    for (uint32_t i = 0; i < kPlaces; ++i) {
      RandomStream random(0, i, 2);
      const Vec2 uv = random.next2();
      evaluator.begin(side, sample_cosine_hemisphere(random.next2()), *point);
      evaluator.add(uv, 0, 1, *point);
      evaluator.finish(*point);
      const Vec3 normal = evaluator.normal(*point);
      BtfDraws::Example& example = examples.emplace_back(
          BtfDraws::Example{{point->wv, normal, broad(evaluator, *point), mirror(evaluator, *point, normal)}, {}});
      for (const Vec3& wl : BtfDraws::even_lights()) example.f.push_back(radiance(evaluator, *point, wl));
    }
    return examples;
  }

 private:
  /// Luminance of f cos.
  static float radiance(const Evaluator& evaluator, const typename Evaluator::Point& point, const Vec3& wl) {
    return wl.z > 0 ? luminance(evaluator.value(point, wl)) * wl.z : 0.0f;
  }

  std::array<typename Evaluator::Light, BtfLook::kBroad> broad_;
};

/// `Evaluator`: SrbfEvaluator or a class with the same members. Texture coordinates are in tiles: the BTF repeats at
/// every integer. Light directions on the other side are passed mirrored, with wl.z > 0.
template <typename Evaluator>
class SidedBtfMaterial final : public Material {
 public:
  template <typename Btf>
  SidedBtfMaterial(std::shared_ptr<const Btf> btf, BtfLight light) : evaluator_(std::move(btf)), light_(light) {
    for (const bool below : {false, true}) {
      const auto side = evaluator_.side(below, below == (light == BtfLight::viewers_side));
      if (side) sides_[below].emplace(evaluator_, *side);
    }
  }

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    const auto& side = side_of(site);
    if (!side) return arena.make<PreparedUnseen>();
    return arena.make<Prepared>(evaluator_, *side, wv, site, options.value_only);
  }

  bool varies() const override { return true; }
  Vec2 texels() const override { return evaluator_.texels(); }
  bool isotropic() const override { return false; }

 private:
  struct Side {
    Side(const Evaluator& evaluator, uint32_t side)
        : number(side), looks(evaluator, side), draws(looks.examples(evaluator, side)) {
      if (!draws.asks()) return;
      table = BtfLookTable(evaluator.texels(), [&](const Vec2& uv, float level, const Vec3& wv) {
        const auto point = std::make_unique_for_overwrite<typename Evaluator::Point>();
        evaluator.begin(number, wv, *point);
        evaluator.add(uv, level, 1, *point);
        evaluator.finish(*point);
        return looks.broad(evaluator, *point);
      });
    }
    uint32_t number;
    BtfLooks<Evaluator> looks;
    BtfDraws draws;
    BtfLookTable table;  // empty unless draws.asks()
  };

  class Prepared final : public PreparedBrdf {
   public:
    Prepared(const Evaluator& evaluator, const Side& side, const Vec3& wv, const SurfaceSite& site, bool value_only)
        : evaluator_(evaluator), value_only_(value_only) {
      evaluator.begin(side.number, wv, point_);
      const FootprintTaps taps = footprint_taps(site.footprint, evaluator.texels());
      for (int i = 0; i < taps.count; ++i) {
        evaluator.add(taps.place(site.uv, i), taps.level, 1.0f / static_cast<float>(taps.count), point_);
      }
      evaluator.finish(point_);
      if (value_only) return;
      BtfLook look{wv, evaluator.normal(point_), {}, 0};
      if (side.draws.asks()) look.broad = side.table.look_up(site.uv, taps.level, wv);
      if (side.draws.asks_mirror(wv, look.normal)) look.mirror = side.looks.mirror(evaluator, point_, look.normal);
      side.draws.fill(look, density_);
    }

    void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
      if (value_only_) {
        std::fill_n(pdf.v, wl.count, 0.0f);
      } else {
        eval_warped(density_, wl, f, pdf);  // its value, 0, is overwritten
      }
      for (int i = 0; i < wl.count; ++i) f.set(i, value(wl.get(i)));
    }

    Reflection eval_one(const Vec3& wl) const override {
      Reflection result{};
      if (!value_only_) eval_warped(density_, wl, result.f, result.pdf);
      result.f = value(wl);
      return result;
    }

    void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { sample_warped(density_, u, wl); }

    bool proposal_lobes(ProposalLobes& lobes) const override {
      if (value_only_) return false;
      BtfDraws::propose(density_, lobes);
      return true;
    }

   private:
    Rgb value(const Vec3& wl) const { return wl.z > 0 ? evaluator_.value(point_, wl) : Rgb(0.0f); }

    const Evaluator& evaluator_;
    bool value_only_;
    WarpedMixture density_;  // unless value_only_
    typename Evaluator::Point point_;
  };

  /// Where the BTF was not fitted: black.
  class PreparedUnseen final : public PreparedCosineBtf {
    Rgb value(const Vec3& /*wl*/) const override { return Rgb(0.0f); }
  };

  /// A one-sided BTF shows the same side from behind.
  const std::optional<Side>& side_of(const SurfaceSite& site) const {
    return sides_[site.back && (sides_[1] || light_ == BtfLight::other_side)];
  }

  Evaluator evaluator_;
  BtfLight light_;
  std::array<std::optional<Side>, 2> sides_;  // seen from the front, from behind
};

// Material of a BTF modeled as sums of multivariate SRBFs.

/// Texture coordinates are in tiles: the BTF repeats at every integer.
std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf,
                                                       BtfLight light = BtfLight::viewers_side);

// Material of a BTF modeled as clustered tensors.

/// Texture coordinates are in tiles: the BTF repeats at every integer.
std::shared_ptr<const Material> make_tensor_btf_material(std::shared_ptr<const TensorBtf> btf,
                                                         BtfLight light = BtfLight::viewers_side);

// Material of a BTF with an open structure, on a surface whose rays intersect the structure's silhouette themselves.

/// f of the solid part, from a BTF whose values average solid and empty parts, or from a material that contains one.
/// Texels beyond a silhouette hold light of the structure inside; it is folded back over the silhouette, so that rays
/// that hit the structure gather exactly all of it.
class HoledBtfMaterial final : public Material {
 public:
  explicit HoledBtfMaterial(std::shared_ptr<const Material> btf) : btf_(std::move(btf)) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  bool varies() const override { return true; }
  bool transmits() const override { return btf_->transmits(); }
  Vec2 texels() const override { return btf_->texels(); }
  bool isotropic() const override { return btf_->isotropic(); }

 private:
  std::shared_ptr<const Material> btf_;
};

}  // namespace velour
