// Material of a BTF model that consists of sides, for any evaluator.
#pragma once

#include <memory>
#include <optional>
#include "btf/eval/btf_draws.h"
#include "btf/eval/btf_light.h"
#include "btf/eval/measured_btf_material.h"
#include "btf/model/srbf_btf.h"
#include "btf/model/tensor_btf.h"
#include "material/footprint_taps.h"
#include "material/material.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {

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
