// Samplers that strategies use beside materials and lights. They depend on the scene alone, and renders share them.
#pragma once

#include <memory>
#include <vector>

#include "job/progress.h"
#include "material/ggx_sampler.h"
#include "material/table_sampler.h"
#include "render/report.h"
#include "render/sky_proposals.h"
#include "scene/scene.h"

namespace velour {

// Indexed by material.
using TableSamplers = std::vector<std::shared_ptr<const TableSampler>>;
using GgxSamplers = std::vector<std::unique_ptr<const GgxSampler>>;

struct SkySampler {
  SkyProposals proposals;
  std::vector<float> lights_part;  // by material (lights_part.h)
  RenderReport::Sky report;
};

/// These samplers are built when a render of this state of the scene first needs them (Scene::kept()), with the same
/// bits for any number of threads. The functions throw Error(cancelled).
std::shared_ptr<const TableSamplers> table_samplers(const Scene& scene, const Progress& progress);
/// `threads` 0: all.
std::shared_ptr<const GgxSamplers> ggx_samplers(const Scene& scene, int threads, Progress& progress);
/// `cache_folder`: cache of sky_mixture(), read by the first render.
std::shared_ptr<const SkySampler> sky_sampler(const Scene& scene, const std::string& cache_folder, Progress& progress);

}  // namespace velour
