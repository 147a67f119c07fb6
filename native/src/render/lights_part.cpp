#include "render/lights_part.h"

#include <memory>

#include "material/material.h"
#include "render/sky_proposals.h"
#include "sphere/warp.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

constexpr float kHalf = 0.5f;
constexpr float kBroad = 16;      // bandwidth: a standard deviation of 14 degrees, wider than a light
constexpr double kDiffuse = 0.9;  // minimum broad share of a diffuse material

}  // namespace

double broad_share(const Material& material) {
  const auto point = std::make_unique<PreparedBrdf>();
  double broad = 0, all = 0;
  for (const float degrees : {10.0f, 30.0f, 50.0f, 70.0f}) {
    ProposalLobes lobes;
    material.prepare(direction(radians_from(degrees), 0), *point);
    if (!material.proposal_lobes(*point, lobes)) continue;
    const auto cosine = static_cast<double>(lobes.cosine * kPi);
    broad += cosine;
    all += cosine;
    for (int j = 0; j < lobes.count; ++j) {
      const GaussianLobe& lobe = lobes.lobe[j];
      const double mass =
          static_cast<double>(lobe.amplitude) * kernel_integral(Kernel::gaussian, static_cast<double>(lobe.bandwidth));
      all += mass;
      if (lobe.bandwidth < kBroad) broad += mass;
    }
  }
  return all > 0 ? broad / all : 0;
}

std::vector<float> lights_parts(const Scene& scene, const SkyProposals& sky) {
  std::vector<float> parts;
  for (const SurfaceMaterial& m : scene.materials()) {
    const bool half = sky.has_sun() || (sky.blurs_edges() && broad_share(*m.material) > kDiffuse);
    parts.push_back(half ? kHalf : 0.0f);
  }
  return parts;
}

}  // namespace velour
