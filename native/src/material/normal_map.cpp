#include "material/normal_map.h"

#include <algorithm>
#include <cmath>
#include "math/sphere/frame.h"

namespace velour {
namespace {

constexpr float kMinNormalCosine = 1e-6f;  // of the light with the surface normal; keeps f finite

/// What remains of diffuse light about a normal whose cosine with the surface normal is `tilt`.
float remaining(ReliefCorrection correction, float own, float mapped, float tilt) {
  if (correction == ReliefCorrection::none) return 1;
  return correction == ReliefCorrection::shadowed ? relief_shadowing(own, tilt)
                                                  : terminator_softening(own, mapped, tilt);
}

class PreparedNormalMapped final : public PreparedBrdf {
 public:
  /// `relief`: about the mapped normal, in which `material` is prepared.
  PreparedNormalMapped(const PreparedBrdf* material, const Frame& relief, ReliefCorrection correction, bool transmits)
      : material_(material), relief_(relief), correction_(correction), transmits_(transmits) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    DirectionBatch turned;
    for (int i = 0; i < wl.count; ++i) turned.push(relief_.to_local(wl.get(i)));
    turned.pad();
    material_->eval(turned, f, pdf);
    for (int i = 0; i < wl.count; ++i) {
      const float side = transmits_ && wl.z[i] < 0 ? -1.0f : 1.0f;
      const float own = side * wl.z[i], mapped = side * turned.z[i];
      const float share = remaining(correction_, own, mapped, relief_.z.z);
      f.set(i, own > 0 && mapped > 0 ? f.get(i) * (share * mapped / std::max(own, kMinNormalCosine)) : Rgb(0.0f));
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    material_->sample(u, wl);
    for (int i = 0; i < wl.count; ++i) wl.set(i, relief_.to_world(wl.get(i)));
  }

  float diffuse_share(const Vec3& wl, float pdf) const override {
    return material_->diffuse_share(relief_.to_local(wl), pdf);
  }

  void delta_lobes(DeltaLobes& lobes) const override {
    DeltaLobes own;
    material_->delta_lobes(own);
    lobes.count = 0;
    lobes.rest = own.rest;
    for (int i = 0; i < own.count; ++i) {
      const Vec3 wl = relief_.to_world(own.lobe[i].wl);
      if (wl.z * own.lobe[i].wl.z > 0) lobes.add(wl, own.lobe[i].weight);
    }
  }

 private:
  const PreparedBrdf* material_;
  Frame relief_;
  ReliefCorrection correction_;
  bool transmits_;
};

class NormalMappedMaterial final : public Material {
 public:
  NormalMappedMaterial(std::shared_ptr<const Material> material, const NormalMap& map, ReliefPart part)
      : material_(std::move(material)), map_(map), part_(part) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    const Frame seen = frame_of(part_ != ReliefPart::diffuse, wv, site);
    const Vec3 local = above_horizon(seen.to_local(wv));
    const PreparedBrdf* const material = material_->prepare(local, site, options, arena);
    return arena.make<PreparedNormalMapped>(material, part_ == ReliefPart::base ? frame_of(false, wv, site) : seen,
                                            part_ == ReliefPart::lobe ? ReliefCorrection::none : map_.correction,
                                            material_->transmits());
  }

  bool varies() const override { return true; }
  Vec2 texels() const override { return material_->texels(); }
  bool transmits() const override { return material_->transmits(); }
  bool isotropic() const override { return false; }

 private:
  Frame frame_of(bool is_lobe, const Vec3& wv, const SurfaceSite& site) const {
    return Frame::about(map_.normal(is_lobe, wv, site));
  }

  const std::shared_ptr<const Material> material_;
  const NormalMap map_;
  const ReliefPart part_;
};

bool keeps_mirrors_above(ReliefCorrection correction, bool is_lobe) {
  return correction == ReliefCorrection::turned || (correction != ReliefCorrection::none && is_lobe);
}

/// Not normalized; zero: there is none.
Vec3 normal_at(const NormalMap& map, const SurfaceSite& site) {
  if (map.of_surface) return {0, 0, 1};
  const Rgb given = map.texture.at_point(site, Rgb(0.5f, 0.5f, 1.0f));
  if (map.texture.program) return given;
  const Vec3 normal = 2.0f * given - 1.0f;
  const float rest = std::clamp(map.strength, 0.0f, 1.0f);
  return site.relief * Vec3(map.strength * normal.x, map.strength * normal.y, 1 + (normal.z - 1) * rest);
}

}  // namespace

Vec3 NormalMap::normal(bool is_lobe, const Vec3& wv, const SurfaceSite& site) const {
  const Vec3 given = normal_at(*this, site);
  const float length = glm::length(given);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 1};
  return keeps_mirrors_above(correction, is_lobe) ? with_mirror_above(given / length, site.ground, wv) : given / length;
}

/// In the plane of both normals, a normal at angle t from `ground` mirrors wv to a cosine of r cos(2 t - phi) with
/// `ground`, where r and phi are the polar coordinates of wv's projection onto that plane. The cosine is large enough
/// within an interval of t that contains 0; beyond its end the normal is moved to that end.
Vec3 with_mirror_above(const Vec3& normal, const Vec3& ground, const Vec3& wv) {
  const float up = glm::dot(wv, ground), least = std::min(0.01f, 0.9f * up);
  if (2 * glm::dot(wv, normal) * glm::dot(normal, ground) - up >= least) return normal;
  const Vec3 tilt = normal - glm::dot(normal, ground) * ground;
  const float length = glm::length(tilt);
  const Vec3 side = length > 1e-6f ? tilt / length : Frame::about(ground).x;
  const float along = glm::dot(wv, side), r = std::sqrt(up * up + along * along);
  const float end = 0.5f * (std::atan2(along, up) + std::acos(std::clamp(least / r, -1.0f, 1.0f)));
  return glm::normalize(std::cos(end) * ground + std::sin(end) * side);
}

float terminator_softening(float own, float mapped, float tilt) {
  const float bottom = mapped * tilt;
  const float g = bottom != 0 ? own / bottom : 0.0f;
  if (g >= 1) return 1;
  return g > 0 ? g * (1 + g * (1 - g)) : 0.0f;
}

float relief_shadowing(float own, float tilt) {
  if (!(own > 0)) return 0;
  const auto tangent_sq = [](float cosine) { return std::max(1 / (cosine * cosine) - 1, 0.0f); };
  const float alpha_sq = tilt != 0 ? std::min(tangent_sq(tilt) / 8, 1.0f) : 1.0f;
  return 2 / (1 + std::sqrt(1 + alpha_sq * tangent_sq(own)));
}

std::shared_ptr<const Material> make_normal_mapped(std::shared_ptr<const Material> material, const NormalMap& map,
                                                   ReliefPart part) {
  return std::make_shared<NormalMappedMaterial>(std::move(material), map, part);
}

}  // namespace velour
