// Samplers that strategies use beside materials and lights. They depend on the scene alone, and renders share them.
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "brdf/eval/table_sampler.h"
#include "material/microfacet/ggx_sampler.h"
#include "render/lights/environment_proposals.h"
#include "render/render.h"
#include "scene/scene.h"

namespace velour {

// Indexed by material.
using TableSamplers = std::vector<std::shared_ptr<const TableSampler>>;
using GgxSamplers = std::vector<std::unique_ptr<const GgxSampler>>;

struct EnvironmentProductSampler {
  EnvironmentProposals proposals;
  std::vector<float> lights_part;  // by material (environment_proposals.h)
  RenderReport::Sky report;
};

/// These samplers are built when a render of this state of the scene first needs them (Scene::kept()), with the same
/// bits for any number of threads. The functions throw Error(cancelled).
std::shared_ptr<const TableSamplers> table_samplers(const Scene& scene, const Progress& progress);
/// `threads` 0: all.
std::shared_ptr<const GgxSamplers> ggx_samplers(const Scene& scene, int threads, Progress& progress);
/// `cache_folder`: cache of mixture_of_environment(), read by the first render.
std::shared_ptr<const EnvironmentProductSampler> environment_sampler(const Scene& scene,
                                                                     const std::string& cache_folder,
                                                                     Progress& progress);

}  // namespace velour
