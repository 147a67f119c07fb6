// What strategies draw directions from beside materials and lights. It depends on the scene alone, and renders share
// it.
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

// By material.
using TableSamplers = std::vector<std::shared_ptr<const TableSampler>>;
using GgxSamplers = std::vector<std::unique_ptr<const GgxSampler>>;

struct SkySampler {
  SkyProposals proposals;
  std::vector<float> lights_part;  // by material (lights_part.h)
  RenderReport::Sky report;
};

/// Each is made when a render of this state of the scene first needs it (Scene::kept()), and has the same bits for any
/// number of threads. They throw Error(cancelled).
std::shared_ptr<const TableSamplers> table_samplers(const Scene& scene, const Progress& progress);
/// `threads`: 0 is all.
std::shared_ptr<const GgxSamplers> ggx_samplers(const Scene& scene, int threads, Progress& progress);
/// `cache_folder`: of sky_mixture(), which the first render looks into.
std::shared_ptr<const SkySampler> sky_sampler(const Scene& scene, const std::string& cache_folder, Progress& progress);

}  // namespace velour
