#include "material/placed_material.h"

#include "math/sphere/frame.h"

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

class PlacedMaterial final : public Material {
 public:
  PlacedMaterial(std::shared_ptr<const Material> material, const TextureMap& map)
      : material_(std::move(material)), map_(map), frame_(frame_of(map.map)) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    const PreparedBrdf* const material = material_->prepare(frame_.to_local(wv), placed(site), options, arena);
    if (frame_.x.x == 1 && frame_.y.y == 1) return material;
    return arena.make<PreparedPlaced>(material, frame_);
  }

  bool varies() const override { return material_->varies(); }
  Vec2 texels() const override {
    const Vec2 texels = material_->texels();
    if (!material_->varies()) return texels;
    return {glm::length(map_.map[0] * texels), glm::length(map_.map[1] * texels)};
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
  SurfaceSite placed(const SurfaceSite& site) const {
    SurfaceSite own = site;
    own.uv = map_.point(site.uv);
    own.footprint = map_.map * site.footprint;
    own.beyond_outline = map_.map * site.beyond_outline;
    return own;
  }

  const std::shared_ptr<const Material> material_;
  const TextureMap map_;
  const Frame frame_;
};

}  // namespace

std::shared_ptr<const Material> make_placed(std::shared_ptr<const Material> material, const TextureMap& map) {
  const bool unplaced = map.map == Mat2(1.0f) && map.shift == Vec2(0.0f);
  if (unplaced || (material->isotropic() && !material->varies())) return material;
  return std::make_shared<PlacedMaterial>(std::move(material), map);
}

}  // namespace velour
