#include "capture/view_capture.h"

#include <tbb/parallel_for.h>

#include <atomic>

namespace velour {
namespace {

/// Index in the grid of texel `number` of a block.
uint64_t grid_texel(const TexelGrid& grid, const TexelBlock& block, uint32_t number) {
  const uint64_t row = block.row + number / block.columns, column = block.column + number % block.columns;
  return row * grid.width + column;
}

}  // namespace

void ViewCapture::run(const ViewSetup& view, ViewImages& images, double begin, double end, RayShare* share,
                      Progress& progress) {
  const uint32_t count = blocks_.count();
  std::atomic<uint32_t> done{0};
  tbb::parallel_for(uint32_t{0}, count, [&](uint32_t number) {
    const TexelBlock block = blocks_.block(number);
    const auto work = [&](RayLog* log) { run_block(view, block, images, log, progress); };
    if (share == nullptr) {
      work(nullptr);
    } else {
      const auto paths = static_cast<int>(block.texels() * sampling_.samples * (sampling_.bounces + 1));
      share->record(size_t{view.number} * count + number, {0, 0, paths, 1}, 1, work);
    }
    progress.update(begin + (end - begin) * (++done / static_cast<double>(count)));
  });
}

void ViewCapture::run_block(const ViewSetup& view, const TexelBlock& block, ViewImages& images, RayLog* log,
                            const Progress& progress) {
  Worker& worker = workers_.local();
  worker.paths.trace(view, block, worker.rays, log, progress);
  store_structure(block, worker.paths, images.structure);
  for (uint32_t first = 0; first < view.lights.size(); first += kLightsTogether) {
    const LightGroup group(view.lights, first);
    worker.masks.trace(worker.paths, group, worker.rays, log, progress);
    shade_block(group, first, block, worker, images, progress);
  }
  if (images.store != nullptr) images.store->release();
}

void ViewCapture::shade_block(const LightGroup& group, uint32_t first_light, const TexelBlock& block, Worker& worker,
                              ViewImages& images, const Progress& progress) {
  for (uint32_t t = 0; t < block.texels(); ++t) {
    progress.check();
    worker.shader.shade(worker.paths, t, group, worker.masks, worker.values);
    worker.broken += worker.values.broken;
    store(grid_texel(grid_, block, t), first_light, group.count(), worker, images);
  }
}

void ViewCapture::store(uint64_t texel, uint32_t first_light, uint32_t lights, Worker& worker,
                        ViewImages& images) const {
  worker.mean.clear();
  worker.error.clear();
  for (uint32_t l = 0; l < lights; ++l) {
    const Rgb mean = to_rec709_ * worker.values.mean(l);
    for (int c = 0; c < 3; ++c) worker.mean.push_back(std::clamp(mean[c], -kLargestHalf, kLargestHalf));
    worker.error.push_back(std::min(worker.values.standard_error(l), kLargestHalf));
  }
  worker.mean_bits.resize(worker.mean.size());
  worker.error_bits.resize(worker.error.size());
  floats_to_halves(worker.mean, worker.mean_bits);
  floats_to_halves(worker.error, worker.error_bits);
  for (uint32_t l = 0; l < lights; ++l) {
    const uint64_t at = (first_light + l) * grid_.texels() + texel;
    for (uint32_t c = 0; c < 3; ++c) images.values[3 * at + c] = worker.mean_bits[3 * l + c];
    if (!images.errors.empty()) images.errors[at] = worker.error_bits[l];
  }
}

void ViewCapture::store_structure(const TexelBlock& block, const PathVertices& paths, ViewStructure& structure) const {
  for (uint32_t t = 0; t < block.texels(); ++t) {
    double hits = 0, sum = 0, sum_sq = 0;
    for (uint32_t s = 0; s < sampling_.samples; ++s) {
      const uint32_t v = paths.vertex_of(t * sampling_.samples + s, 0);
      if (v == PathVertices::kNone) continue;
      const double height = static_cast<double>(paths.vertices()[v].vertex.position.z - tile_.bottom());
      hits += 1;
      sum += height;
      sum_sq += height * height;
    }
    const uint64_t at = grid_texel(grid_, block, t);
    const double mean = hits > 0 ? sum / hits : 0;
    structure.coverage[at] = static_cast<float>(hits / sampling_.samples);
    structure.height_mean[at] = static_cast<float>(mean);
    structure.height_spread[at] =
        hits > 0 ? static_cast<float>(std::sqrt(std::max(0.0, sum_sq / hits - mean * mean))) : 0.0f;
  }
}

CaptureCounts ViewCapture::counts() const {
  CaptureCounts all;
  for (const Worker& worker : workers_) {
    all.rays += worker.rays.traced();
    all.lost += worker.rays.lost();
    all.broken += worker.broken;
  }
  return all;
}

}  // namespace velour
