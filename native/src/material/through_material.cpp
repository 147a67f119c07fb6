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
