#include "capture/btf/view_capture.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "math/sphere/random.h"
#include "render/path/direction_sampling.h"

namespace velour {

void ViewStore::read_by(const std::function<void()>& work) const {
  if (!pages_.in_file()) return work();
  std::jthread releases([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      release();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  work();
}

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

TexelShader::TexelShader(const Scene& scene, const TexelSampling& sampling)
    : sampling_(sampling),
      rec709_to_working_(scene.rec709_to_working()),
      luminance_weights_(luminance({1, 0, 0}), luminance({0, 1, 0}), luminance({0, 0, 1})) {
  if (rec709_to_working_) luminance_weights_ = luminance_weights_ * glm::inverse(*rec709_to_working_);
}

Rgb TexelValues::mean(uint32_t light) const {
  const double scale = 1.0 / samples;
  return Rgb(Vec3d(sums.sum[0][light], sums.sum[1][light], sums.sum[2][light]) * scale);
}

float TexelValues::standard_error(uint32_t light) const {
  if (samples < 2) return 0;
  const double n = samples, mean = sums.luminance[light] / n;
  const double variance = std::max(0.0, sums.luminance_sq[light] / n - mean * mean) * n / (n - 1);
  return static_cast<float>(std::sqrt(variance / n));
}

void TexelShader::shade(const PathVertices& paths, uint32_t texel, const LightGroup& group, const ShadowMasks& masks,
                        TexelValues& values) {
  values = {};
  values.samples = sampling_.samples;
  const uint32_t padded = (group.count() + 15) / 16 * 16;  // what add_path() reads
  for (uint32_t s = 0; s < sampling_.samples; ++s) {
    for (auto& channel : path_) std::fill_n(channel, padded, 0.0f);
    shade_path(paths, texel * sampling_.samples + s, group, masks);
    values.broken += add_path(path_, luminance_weights_, group.count(), values.sums);
  }
}

void TexelShader::shade_path(const PathVertices& paths, uint32_t path, const LightGroup& group,
                             const ShadowMasks& masks) {
  for (uint32_t depth = 0; depth <= sampling_.bounces; ++depth) {
    const uint32_t v = paths.vertex_of(path, depth);
    if (v == PathVertices::kNone) return;
    shade_vertex(paths.vertices()[v], group, masks.of(v));
  }
}

void TexelShader::shade_vertex(const PathVertex& at, const LightGroup& group, const ShadowMasks::Mask& mask) {
  if ((mask[0] | mask[1]) == 0) return;
  arena_.reset();
  const PreparedBrdf* const brdf = at.vertex.material->prepare(at.vertex.wv, at.vertex.site, {}, arena_);
  for (uint32_t word = 0; word < mask.size(); ++word) {
    if (mask[word] == 0) continue;
    collect_lit(group, 64 * word, mask[word], at.vertex.frame, lit_);
    add_lit(at, *brdf);
  }
}

void TexelShader::add_lit(const PathVertex& at, const PreparedBrdf& brdf) {
  brdf.eval(lit_.wl, f_, pdf_);
  for (int i = 0; i < lit_.wl.count; ++i) {
    const Rgb f = in_working_space(rec709_to_working_, at.vertex, f_.get(i));
    const Rgb value = at.throughput * f * lit_.weight[i];
    for (int c = 0; c < 3; ++c) path_[c][lit_.number[i]] += value[c];
  }
}

namespace {

/// Number of rays traced at a time: few enough for the caches, and whole packets of the ray tracer.
constexpr size_t kRaysTogether = 2048;

}  // namespace

void ShadowMasks::trace(const PathVertices& paths, const LightGroup& group, TileRays& rays, RayLog* log,
                        const Progress& progress) {
  read(paths);
  for (uint32_t l = 0; l < group.count(); ++l) {
    progress.check();
    try_light(paths, group.lights[l], l, rays, log);
  }
}

void ShadowMasks::read(const PathVertices& paths) {
  masks_.assign(paths.vertices().size(), Mask{});
  normals_.clear();
  origins_.clear();
  for (const PathVertex& v : paths.vertices()) {
    normals_.push(v.vertex.geometric_normal, v.vertex.frame.z);
    origins_.push_back(v.vertex.position + v.vertex.offset * v.vertex.geometric_normal);
  }
}

void ShadowMasks::try_light(const PathVertices& paths, const CaptureLight& light, uint32_t bit, TileRays& rays,
                            RayLog* log) {
  facing_places(normals_, light.wl, facing_);
  for (size_t done = 0; done < facing_.size(); done += kRaysTogether) {
    ids_ = std::span(facing_).subspan(done, std::min(kRaysTogether, facing_.size() - done));
    trace_some(paths, light, rays, log);
    note_reached(bit);
  }
}

void ShadowMasks::note_reached(uint32_t bit) {
  const uint8_t* blocked = blocked_.data();  // bytes may alias: these copies avoid reloading all pointers
  Mask* masks = masks_.data();
  const uint32_t* ids = ids_.data();
  const size_t count = ids_.size();
  const uint32_t word = bit / 64, shift = bit % 64;
  for (size_t i = 0; i < count; ++i) masks[ids[i]][word] |= uint64_t{blocked[i] == 0} << shift;
}

void ShadowMasks::trace_some(const PathVertices& paths, const CaptureLight& light, TileRays& rays, RayLog* log) {
  rays_.resize(ids_.size());
  for (size_t i = 0; i < ids_.size(); ++i) {
    Ray& ray = rays_[i];
    ray.origin = origins_[ids_[i]];
    ray.near = 0.0f;
    ray.direction = light.wl;  // `far` is set to the end of the shell
  }
  blocked_.resize(ids_.size());
  if (cutouts_.any()) {
    trace_through_cutouts(paths, light, rays, log);
  } else {
    rays.occluded(rays_, blocked_, light.ends, log);
  }
}

void ShadowMasks::trace_through_cutouts(const PathVertices& paths, const CaptureLight& light, TileRays& rays,
                                        RayLog* log) {
  hits_.resize(rays_.size());
  keys_.clear();
  for (size_t i = 0; i < rays_.size(); ++i) keys_.push_back(mix64(paths.vertices()[ids_[i]].key + light.number));
  rays.intersect(rays_, hits_, log);
  cutouts_.pass(rays_, hits_, keys_, paths.cone(), rays, log);
  for (size_t i = 0; i < hits_.size(); ++i) blocked_[i] = hits_[i].instance != kNoHit;
}

}  // namespace velour
