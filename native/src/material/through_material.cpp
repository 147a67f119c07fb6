#include "material/through_material.h"

#include <algorithm>

#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {
namespace {

constexpr uint32_t kPlaces = 64, kLights = 64;

/// Luminance reflected under uniform light, summed over random points and views.
double mean_albedo(const Material& material, bool back) {
  const auto point = std::make_unique<PreparedBrdf>();
  double sum = 0;
  for (uint32_t i = 0; i < kPlaces; ++i) {
    RandomStream random(1, i, 0);
    SurfaceSite site{.uv = random.next2()};
    site.back = back;
    material.prepare(sample_cosine_hemisphere(random.next2()), site, *point);
    for (uint32_t k = 0; k < kLights; ++k) {
      sum += static_cast<double>(luminance(material.eval_one(*point, sample_cosine_hemisphere(random.next2())).f));
    }
  }
  return sum;
}

}  // namespace

ThroughMaterial::ThroughMaterial(std::shared_ptr<const Material> reflected, std::shared_ptr<const Material> through)
    : reflected_(std::move(reflected)), through_(std::move(through)) {
  for (const bool back : {false, true}) {
    const double beyond = mean_albedo(*through_, back), both = beyond + mean_albedo(*reflected_, back);
    const double share = both > 0 ? beyond / both : 0.5;
    share_[back] = std::clamp(static_cast<float>(share), kMinShare, 1 - kMinShare);
  }
}

void ThroughMaterial::prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const {
  if (!point.through) point.through = std::make_unique<PreparedBrdf>();
  reflected_->prepare(wv, site, point);
  point.through->value_only = point.value_only;
  point.through->interpolated_draws = point.interpolated_draws;
  point.through->filter = point.filter;
  through_->prepare(wv, site, *point.through);
  point.through_share = share_[site.back];
}

/// Each material gives f = 0 on its other side, and the density of its samples there.
void ThroughMaterial::eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const {
  DirectionBatch beyond = wl;
  for (int i = 0; i < wl.count; ++i) beyond.z[i] = -wl.z[i];
  RgbBatch through;
  ScalarBatch through_pdf;
  through_->eval(*point.through, beyond, through, through_pdf);
  reflected_->eval(point, wl, f, pdf);
  for (int i = 0; i < wl.count; ++i) {
    f.set(i, f.get(i) + through.get(i));
    pdf.v[i] = (1 - point.through_share) * pdf.v[i] + point.through_share * through_pdf.v[i];
  }
}

Material::Reflection ThroughMaterial::eval_one(const PreparedBrdf& point, const Vec3& wl) const {
  const Reflection of = reflected_->eval_one(point, wl), through = through_->eval_one(*point.through, mirrored(wl));
  return {of.f + through.f, (1 - point.through_share) * of.pdf + point.through_share * through.pdf};
}

float ThroughMaterial::diffuse_share(const PreparedBrdf& point, const Vec3& wl, float pdf) const {
  if (wl.z < 0) return through_->diffuse_share(*point.through, mirrored(wl), pdf / point.through_share);
  return reflected_->diffuse_share(point, wl, pdf / (1 - point.through_share));
}

void ThroughMaterial::sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const {
  sample_sides(u, point.through_share, wl, [&](bool through, std::span<const Vec2> some, DirectionBatch& drawn) {
    if (through) {
      through_->sample(*point.through, some, drawn);
    } else {
      reflected_->sample(point, some, drawn);
    }
  });
}

}  // namespace velour
