#include "render/scene_samplers.h"

#include <mutex>

#include "brdf/fit/ggx_fit.h"
#include "light/environment_mixture.h"
#include "render/lights/environment_proposals.h"

namespace velour {
namespace {

struct SceneSamplers {
  std::mutex mutex;
  std::shared_ptr<const TableSamplers> tables;
  std::shared_ptr<const GgxSamplers> ggx;
  std::shared_ptr<const EnvironmentProductSampler> sky;
};

/// Returns what the scene keeps at `place`, or the result of `make`. Renders that start together may both make it, so
/// that each can be cancelled; they get the same object.
template <typename T, typename Make>
std::shared_ptr<const T> kept(const Scene& scene, std::shared_ptr<const T> SceneSamplers::*place, const Make& make) {
  const std::shared_ptr<SceneSamplers> samplers = scene.kept<SceneSamplers>();
  std::shared_ptr<const T>& known = (*samplers).*place;
  {
    const std::lock_guard lock(samplers->mutex);
    if (known) return known;
  }
  auto made = std::make_shared<const T>(make());
  const std::lock_guard lock(samplers->mutex);
  if (!known) known = std::move(made);
  return known;
}

}  // namespace

std::shared_ptr<const TableSamplers> table_samplers(const Scene& scene, const Progress& progress) {
  return kept(scene, &SceneSamplers::tables, [&] {
    TableSamplers tables;
    for (const SurfaceMaterial& m : scene.materials()) {
      progress.check();
      auto own = m.material->tables();
      tables.push_back(own ? std::move(own) : std::make_shared<const TableSampler>(*m.material));
    }
    return tables;
  });
}

std::shared_ptr<const GgxSamplers> ggx_samplers(const Scene& scene, int threads, Progress& progress) {
  return kept(scene, &SceneSamplers::ggx, [&] {
    GgxSamplers lobes;
    for (const SurfaceMaterial& m : scene.materials()) {
      lobes.push_back(std::make_unique<const GgxSampler>(fit_ggx(*m.material, threads, progress)));
    }
    return lobes;
  });
}

std::shared_ptr<const EnvironmentProductSampler> environment_sampler(const Scene& scene,
                                                                     const std::string& cache_folder,
                                                                     Progress& progress) {
  return kept(scene, &SceneSamplers::sky, [&] {
    const Environment& environment = scene.environment();
    const EnvironmentMixture sky = mixture_of_environment(environment, {}, cache_folder, progress);
    EnvironmentProductSampler sampler{EnvironmentProposals(sky, misfit_of_environment(environment, sky)),
                                      {},
                                      {sky.size(), sky.relative_l2, sky.seconds, sky.cached}};
    sampler.lights_part = lights_parts(scene, sampler.proposals);
    return sampler;
  });
}

}  // namespace velour
