#include "scene/sky_misfit.h"

#include <memory>

#include "scene/environment.h"
#include "sphere/sobol.h"
#include "srbf/lobe_mixture.h"

namespace velour {
namespace {

constexpr uint32_t kDraws = 1024, kDrawBatch = DirectionBatch::kCapacity;
static_assert(kDraws % kDrawBatch == 0);

std::unique_ptr<const LobeMixture> density_of(const SkyMixture& sky) {
  auto mixture = std::make_unique<LobeMixture>();
  mixture->clear(Kernel::gaussian);
  for (size_t k = 0; k < sky.size(); ++k) mixture->add(sky.center[k], sky.bandwidth[k], sky.coefficient[k]);
  mixture->finish(0);
  return mixture;
}

}  // namespace

double sky_misfit(const Environment& environment, const SkyMixture& sky) {
  const auto mixture = density_of(sky);
  double sum = 0;
  for (uint32_t first = 0; first < kDraws; first += kDrawBatch) {
    Vec2 u[kDrawBatch];
    sobol_points(0, first, u);
    DirectionBatch world;
    environment.sample(u, world);
    world.pad();
    RgbBatch radiance;
    ScalarBatch own, lobes;
    environment.look_up(world, radiance, own);
    eval_density(*mixture, world, lobes);
    for (uint32_t i = 0; i < kDrawBatch; ++i) sum += static_cast<double>(own.v[i]) / static_cast<double>(lobes.v[i]);
  }
  return sum / kDraws - 1;
}

}  // namespace velour
