#include "material/derived_materials.h"

#include <algorithm>

#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

/// The axes of a texture in the frame of the surface.
Frame frame_of(const Mat2& map) {
  const Vec2 along = glm::normalize(glm::inverse(map)[0]);
  const Vec2 across = (glm::determinant(map) < 0 ? -1.0f : 1.0f) * Vec2(-along.y, along.x);
  return {Vec3(along, 0), Vec3(across, 0), Vec3(0, 0, 1)};
}

class PreparedPlaced final : public PreparedBrdf {
 public:
  PreparedPlaced(const PreparedBrdf* material, const Frame& frame) : material_(material), frame_(frame) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    DirectionBatch turned;
    for (int i = 0; i < wl.count; ++i) turned.push(frame_.to_local(wl.get(i)));
    turned.pad();
    material_->eval(turned, f, pdf);
  }
  Reflection eval_one(const Vec3& wl) const override { return material_->eval_one(frame_.to_local(wl)); }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    material_->sample(u, wl);
    for (int i = 0; i < wl.count; ++i) wl.set(i, frame_.to_world(wl.get(i)));
  }
  Vec3 sample_one(const Vec2& u) const override { return frame_.to_world(material_->sample_one(u)); }

  float diffuse_share(const Vec3& wl, float pdf) const override {
    return material_->diffuse_share(frame_.to_local(wl), pdf);
  }
  void delta_lobes(DeltaLobes& lobes) const override {
    material_->delta_lobes(lobes);
    for (int i = 0; i < lobes.count; ++i) lobes.lobe[i].wl = frame_.to_world(lobes.lobe[i].wl);
  }
  bool proposal_lobes(ProposalLobes& lobes) const override {
    if (!material_->proposal_lobes(lobes)) return false;
    for (int j = 0; j < lobes.count; ++j) lobes.lobe[j].center = frame_.to_world(lobes.lobe[j].center);
    return true;
  }

 private:
  const PreparedBrdf* material_;
  Frame frame_;
};

/// Coordinates and axes of a placed material at a point.
struct PlacedAxes {
  TextureMap map;
  Frame frame;
  bool is_turned;
};

class PlacedMaterial final : public Material {
 public:
  PlacedMaterial(std::shared_ptr<const Material> material, const Placing& placing)
      : material_(std::move(material)), placing_(placing), constant_(place_of(placing.map, placing.map.map)) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    const PlacedAxes axes = place_at(site);
    const PreparedBrdf* const material =
        material_->prepare(axes.frame.to_local(wv), placed(site, axes.map), options, arena);
    return axes.is_turned ? arena.make<PreparedPlaced>(material, axes.frame) : material;
  }

  bool varies() const override { return material_->varies() || placing_.varies(); }
  Vec2 texels() const override {
    const Vec2 texels = material_->texels();
    if (!material_->varies()) return texels;
    const Mat2& map = placing_.map.map;
    return {glm::length(map[0] * texels), glm::length(map[1] * texels)};
  }
  bool opaque() const override { return material_->opaque(); }
  float alpha(const SurfaceSite& site) const override { return material_->alpha(placed(site)); }
  bool tints() const override { return material_->tints(); }
  Rgb passing(const SurfaceSite& site) const override { return material_->passing(placed(site)); }
  bool emits() const override { return material_->emits(); }
  Rgb emission(const SurfaceSite& site) const override { return material_->emission(placed(site)); }
  bool transmits() const override { return material_->transmits(); }
  bool isotropic() const override { return material_->isotropic(); }

 private:
  /// `turning`: the linear part of the map on square tiles.
  static PlacedAxes place_of(const TextureMap& map, const Mat2& turning) {
    const Frame frame = frame_of(turning);
    return {map, frame, !(frame.x.x == 1 && frame.y.y == 1)};
  }

  PlacedAxes place_at(const SurfaceSite& site) const {
    if (!placing_.varies()) return constant_;
    const float given = placing_.rotation.at_point(site, 0), angle = std::isfinite(given) ? given : 0.0f;
    const float scale = std::max(Placing::kMinScale, placing_.scale.at_point(site, 1));  // NaN: the least
    const float c = std::cos(angle), s = std::sin(angle), a = placing_.aspect;
    const TextureMap& map = placing_.map;
    const Mat2 rotation(c, -s, s, c), of_tile = Mat2(c, -a * s, s / a, c) / scale;
    return place_of({of_tile * map.map, of_tile * map.shift}, rotation * map.map);
  }

  static SurfaceSite placed(const SurfaceSite& site, const TextureMap& map) {
    SurfaceSite own = site;
    own.uv = map.point(site.uv);
    own.footprint = map.map * site.footprint;
    own.beyond_outline = map.map * site.beyond_outline;
    return own;
  }
  SurfaceSite placed(const SurfaceSite& site) const { return placed(site, place_at(site).map); }

  const std::shared_ptr<const Material> material_;
  const Placing placing_;
  const PlacedAxes constant_;  // where nothing varies
};

}  // namespace

std::shared_ptr<const Material> make_placed(std::shared_ptr<const Material> material, const Placing& placing) {
  const bool unplaced = placing.map.map == Mat2(1.0f) && placing.map.shift == Vec2(0.0f) && !placing.varies();
  if (unplaced || (material->isotropic() && !material->varies())) return material;
  return std::make_shared<PlacedMaterial>(std::move(material), placing);
}

namespace {

constexpr uint32_t kPlaces = 64, kLights = 64;

/// Luminance reflected under uniform light, summed over random points and views.
double mean_albedo(const Material& material, bool back) {
  ScratchArena arena;
  double sum = 0;
  for (uint32_t i = 0; i < kPlaces; ++i) {
    RandomStream random(1, i, 0);
    SurfaceSite site{.uv = random.next2()};
    site.back = back;
    arena.reset();
    const PreparedBrdf* const point = material.prepare(sample_cosine_hemisphere(random.next2()), site, {}, arena);
    for (uint32_t k = 0; k < kLights; ++k) {
      sum += static_cast<double>(luminance(point->eval_one(sample_cosine_hemisphere(random.next2())).f));
    }
  }
  return sum;
}

/// Each part gives f = 0 on its other side, and the density of its samples there.
class PreparedThrough final : public PreparedBrdf {
 public:
  /// `share`: probability of sampling `through`, the point for light from the other side.
  PreparedThrough(const PreparedBrdf* reflected, const PreparedBrdf* through, float share)
      : reflected_(reflected), through_(through), share_(share) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    DirectionBatch beyond = wl;
    for (int i = 0; i < wl.count; ++i) beyond.z[i] = -wl.z[i];
    RgbBatch through;
    ScalarBatch through_pdf;
    through_->eval(beyond, through, through_pdf);
    reflected_->eval(wl, f, pdf);
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, f.get(i) + through.get(i));
      pdf.v[i] = (1 - share_) * pdf.v[i] + share_ * through_pdf.v[i];
    }
  }

  Reflection eval_one(const Vec3& wl) const override {
    const Reflection of = reflected_->eval_one(wl), through = through_->eval_one(mirrored(wl));
    return {of.f + through.f, (1 - share_) * of.pdf + share_ * through.pdf};
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    sample_sides(u, share_, wl, [&](bool through, std::span<const Vec2> some, DirectionBatch& drawn) {
      (through ? through_ : reflected_)->sample(some, drawn);
    });
  }

  float diffuse_share(const Vec3& wl, float pdf) const override {
    if (wl.z < 0) return through_->diffuse_share(mirrored(wl), pdf / share_);
    return reflected_->diffuse_share(wl, pdf / (1 - share_));
  }

 private:
  const PreparedBrdf *reflected_, *through_;
  float share_;
};

}  // namespace

ThroughMaterial::ThroughMaterial(std::shared_ptr<const Material> reflected, std::shared_ptr<const Material> through)
    : reflected_(std::move(reflected)), through_(std::move(through)) {
  for (const bool back : {false, true}) {
    const double beyond = mean_albedo(*through_, back), both = beyond + mean_albedo(*reflected_, back);
    const double share = both > 0 ? beyond / both : 0.5;
    share_[back] = std::clamp(static_cast<float>(share), kMinShare, 1 - kMinShare);
  }
}

const PreparedBrdf* ThroughMaterial::prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                             ScratchArena& arena) const {
  const PreparedBrdf* const reflected = reflected_->prepare(wv, site, options, arena);
  return arena.make<PreparedThrough>(reflected, through_->prepare(wv, site, options, arena), share_[site.back]);
}

}  // namespace velour
