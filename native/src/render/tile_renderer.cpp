#include "render/tile_renderer.h"

#include <algorithm>
#include <cmath>

#include "render/path/direction_sampling.h"

namespace velour {

namespace {

template <typename Label>
Label label_of(const std::vector<Label>& labels, size_t number) {
  return number < labels.size() ? labels[number] : Label{};
}

}  // namespace

SurfaceSample SurfaceRecorder::record(const PassOptions& options, const Vertex& vertex, const Hit& hit,
                                      const Rgb& throughput, const PathNumbers& numbers) {
  const auto material = static_cast<size_t>(vertex.surface - scene_.materials().data());
  const InstanceLabel of_instance = label_of(options.instances, hit.instance);
  const MaterialLabel of_material = label_of(options.materials, material);
  SurfaceSample s;
  s.position = vertex.position;
  s.object_index = of_instance.index;
  s.material_index = of_material.index;
  s.seen = std::min((throughput.r + throughput.g + throughput.b) / 3.0f, 1.0f);
  s.object_id = of_instance.object_id;
  s.asset_id = of_instance.asset_id;
  s.material_id = of_material.id;
  if (options.has(pass::kUv)) s.uv = uv(hit, of_instance.uv_set);
  if (options.has(pass::kMist)) s.clear = (1.0f - options.mist.at(distance(vertex.position))) * s.seen;
  if (options.has(pass::kAlbedo | pass::kDenoisingAlbedo | pass::kHalves))
    s.albedo = throughput * albedo_.estimate(vertex, numbers);
  if (options.has(pass::kDenoisingAlbedo | pass::kHalves)) {
    const Rgb emitted = throughput * vertex.emission();
    if (std::isfinite(emitted.r + emitted.g + emitted.b)) s.shine = emitted;
  }
  if (options.has(pass::kVector)) find_motion(hit, s);
  return s;
}

void SurfaceRecorder::find_motion(const Hit& hit, SurfaceSample& sample) const {
  const Hit at = scene_.has_shell(hit) ? scene_.shell_foot(hit).top : hit;
  const Vec2 here = current_.picture(scene_.position(at, kMiddleTime));
  const Vec2 before = size_ * (previous_.picture(scene_.position(at, 0.0f)) - here);
  const Vec2 after = size_ * (here - next_.picture(scene_.position(at, 1.0f)));
  if (!std::isfinite(before.x + before.y + after.x + after.y)) return;  // behind the camera
  sample.from_previous = before;
  sample.to_next = after;
  sample.surfaces = 1;
}

Vec3 SurfaceRecorder::uv(const Hit& hit, int set) const {
  const Hit at = scene_.has_shell(hit) ? scene_.shell_foot(hit).top : hit;
  const Mesh& mesh = scene_.traced_mesh(scene_.instances()[at.instance]);
  if (set < 0 || !mesh.has_uvs()) return Vec3(0.0f);
  const auto corner = mesh.corner_uvs(at.triangle, static_cast<size_t>(set));
  return {(1.0f - at.u - at.v) * corner[0] + at.u * corner[1] + at.v * corner[2], 1.0f};
}

/// Distance for mist, as in Cycles: from the camera, or from its plane if it is orthographic.
float SurfaceRecorder::distance(const Vec3& world) const {
  const Camera& camera = scene_.camera();
  if (camera.type == Camera::Type::orthographic) return std::abs(camera.depth(world));
  return glm::distance(world, camera.camera_to_world.column(3));
}

Rgb SurfaceAlbedo::estimate(const Vertex& vertex, PathNumbers numbers) {
  arena_.reset();
  const PreparedBrdf* const brdf = vertex.material->prepare(vertex.wv, vertex.site, {}, arena_);
  Vec2 u[kDirections];
  numbers.points(Purpose::surface, numbers.ray() * kDirections, u);
  brdf->sample(u, drawn_);
  wl_.count = 0;
  for (int i = 0; i < drawn_.count; ++i) {
    const Vec3 wl = drawn_.get(i);
    if (vertex.receives(wl, vertex.frame.to_world(wl))) wl_.push(wl);
  }
  if (wl_.count == 0) return Rgb(0.0f);
  wl_.pad();
  brdf->eval(wl_, f_, pdf_);
  Rgb sum(0.0f);
  for (int i = 0; i < wl_.count; ++i) {
    const Rgb term = f_.get(i) * (std::abs(wl_.z[i]) / pdf_.v[i]);
    if (std::isfinite(term.r + term.g + term.b)) sum += term;
  }
  return in_working_space(rec709_to_working_, vertex, sum / static_cast<float>(kDirections));
}

namespace {

/// Camera rays in flight: enough for long batches of shadow rays, few enough to stay in the cache.
constexpr int kRaysInFlight = 128;

/// Alpha of the surfaces that a camera ray has passed, given its remaining `throughput`.
float covered(const Rgb& throughput) { return 1.0f - (throughput.r + throughput.g + throughput.b) / 3.0f; }

}  // namespace

TileRenderer::TileRenderer(const RenderContext& context)
    : context_(context),
      pixel_(context.scene, context.options.width, context.options.height, context.camera_rays()),
      flight_(context.scene, *context.lighting, context.options, context.sky.get()),
      recorder_(context.scene, context.options.width, context.options.height) {}

void TileRenderer::render(const PixelRect& tile, int first, int count, Film& film, RayLog* log,
                          const Progress& progress) {
  pixels_.resize(static_cast<size_t>(tile.width()) * static_cast<size_t>(tile.height()));
  values_.resize(pixels_.size() * film.layout().size());
  film_ = &film;
  film.load(tile, pixels_, values_);
  const int pixels_a_run = std::clamp(kRaysInFlight / count, 1, tile.width());
  for (int y = tile.y0; y < tile.y1; ++y) {
    const size_t row = static_cast<size_t>(y - tile.y0) * static_cast<size_t>(tile.width());
    for (int x = tile.x0; x < tile.x1; x += pixels_a_run) {
      progress.check();
      const PixelRect run{x, y, std::min(x + pixels_a_run, tile.x1), y + 1};
      for (int done = 0; done < count; done += kRaysInFlight) {
        const size_t pixel = row + static_cast<size_t>(x - tile.x0);
        render_run(run, first + done, std::min(kRaysInFlight, count - done), pixel, log);
      }
    }
  }
  film.store(tile, pixels_, values_);
}

void TileRenderer::render_run(const PixelRect& run, int first, int count, size_t pixel, RayLog* log) {
  start_paths(run, first, count);
  for (int depth = 0; depth <= context_.options.bounces && !flight_.paths.empty(); ++depth) {
    trace(depth, log);
    flight_.receivers.clear();
    for (size_t i = 0; i < flight_.paths.size(); ++i) follow(i, depth);
    ray_count_ += flight_.gather(depth < context_.options.bounces, log);
  }
  add_background();
  add_samples(count, pixel);
}

void TileRenderer::add_samples(int count, size_t pixel) {
  const PassLayout& layout = film_->layout();
  for (size_t i = 0; i < flight_.samples.size(); ++i) {
    const size_t at = pixel + i / static_cast<size_t>(count);
    if (layout.size() > 0)
      layout.add(surfaces_[i], flight_.samples[i], pixels_[at], values_.data() + at * layout.size());
    pixels_[at].add(flight_.samples[i]);
  }
}

void TileRenderer::start_paths(const PixelRect& run, int first, int count) {
  const RenderOptions& o = context_.options;
  flight_.paths.clear();
  flight_.samples.clear();
  for (int x = run.x0; x < run.x1; ++x) {
    const uint64_t pixel = static_cast<uint64_t>(run.y0) * static_cast<uint64_t>(o.width) + static_cast<uint64_t>(x);
    for (int index = first; index < first + count; ++index) {
      flight_.paths.push_back({PathNumbers(o, pixel, static_cast<uint32_t>(index)),
                               Rgb(1.0f),
                               static_cast<uint32_t>(flight_.samples.size()),
                               {}});
      flight_.samples.emplace_back().directions = context_.directions(index);
    }
  }
  if (film_->layout().size() > 0) surfaces_.assign(flight_.samples.size(), SurfaceSample{});
  aim_paths(run, count);
}

/// Creates the camera rays of the paths, `count` per pixel.
void TileRenderer::aim_paths(const PixelRect& run, int count) {
  const RenderOptions& o = context_.options;
  const Vec2 size(static_cast<float>(o.width), static_cast<float>(o.height));
  const auto pixel_of = [&](size_t path) { return Vec2(run.x0 + static_cast<int>(path) / count, run.y0); };
  flight_.rays.clear();
  PointBatch points, lens, moments;
  const Camera& camera = context_.scene.camera();
  const bool has_lens = camera.aperture.radius > 0.0f;
  for (size_t first = 0; first < flight_.paths.size(); first += PointBatch::kCapacity) {
    const size_t end = std::min(flight_.paths.size(), first + PointBatch::kCapacity);
    const auto make = [&](PointBatch& batch, const auto& request) {
      batch.clear();
      for (size_t i = first; i < end; ++i) request(flight_.paths[i].numbers, batch);
      batch.resolve();
      return batch.points(0, batch.count());
    };
    const auto points_for = [](Purpose purpose) {
      return [purpose](PathNumbers& numbers, PointBatch& batch) { numbers.point(purpose, batch); };
    };
    const auto places = make(points, points_for(Purpose::camera));
    const auto on_lens = has_lens ? make(lens, points_for(Purpose::lens)) : places;
    const auto times =
        camera.shutter ? make(moments, [](PathNumbers& numbers, PointBatch& batch) { numbers.time(batch); }) : places;
    for (size_t i = first; i < end; ++i) {
      const Vec2 through = has_lens ? camera.aperture.sample(on_lens[i - first]) : Vec2(0.0f);
      const float time = camera.shutter ? camera.shutter->time(times[i - first].x) : kMiddleTime;
      flight_.rays.push_back(camera.ray((pixel_of(i) + places[i - first]) / size, through, time));
      flight_.paths[i].cone = pixel_.cone(flight_.rays.back().direction, time);
    }
  }
}

void TileRenderer::trace(int depth, RayLog* log) {
  if (log != nullptr) log->add(flight_.rays, RayLog::Kind::nearest);
  if (depth == 0) {
    flight_.trace_camera_rays();
  } else {
    flight_.trace_continued();
  }
  ray_count_ += flight_.rays.size();
}

void TileRenderer::follow(size_t index, int depth) {
  Path& path = flight_.paths[index];
  const Hit& hit = flight_.hits[index];
  CameraSample& sample = flight_.samples[path.sample];
  if (hit.instance == kNoHit) {
    if (depth == 0) {
      sample.alpha = covered(path.throughput);
      missed_.push_back({path.sample, flight_.rays[index].direction, path.throughput});
    }
    return;
  }
  if (depth == 0 && context_.scene.is_holdout(hit)) {  // alpha 0, as in Cycles, even on an opaque film
    sample.alpha = covered(path.throughput);
    return;
  }
  Vertex vertex = Vertex::seen(context_.scene, flight_.rays[index], hit, path.cone, depth == 0 ? &pixel_ : nullptr);
  const auto material = static_cast<size_t>(vertex.surface - context_.scene.materials().data());
  if (context_.tables) vertex.table = (*context_.tables)[material].get();
  if (context_.ggx) vertex.ggx = (*context_.ggx)[material].get();
  if (depth == 0) {
    sample.alpha = 1.0f;
    sample.normal = vertex.frame.z;
    sample.depth = context_.scene.camera().depth(vertex.position);
    if (film_->options().has(pass::kOfSurfaces)) {
      surfaces_[path.sample] = recorder_.record(film_->options(), vertex, hit, path.throughput, path.numbers);
    }
  }
  const LightPathOptions& light_paths = context_.options.light_paths;
  if (depth == 0 || !flight_.light.counts_emissive(hit, path.counted_all_emissive)) {
    const Rgb emitted = path.throughput * vertex.emission();
    if (flight_.light.keeps(emitted)) sample.radiance += clamped(emitted, light_paths.limit(depth - 1));
  }
  const Mixing* const mixing = depth == 0 && !context_.mixing.empty() ? &context_.mixing[material] : nullptr;
  const int most = depth == 0 ? context_.options.split : std::min(context_.options.split, kIndirectDirections);
  flight_.receivers.push_back({vertex, &path.numbers, path.throughput, path.sample, std::min(sample.directions, most),
                               most, path.past, light_paths.limit(depth), mixing});
}

void TileRenderer::add_background() {
  DirectionBatch batch;
  RgbBatch radiance;
  const RenderOptions& o = context_.options;
  const bool visible = !o.transparent && !o.hide_world;
  for (size_t start = 0; start < missed_.size() && visible; start += DirectionBatch::kCapacity) {
    const size_t end = std::min(missed_.size(), start + DirectionBatch::kCapacity);
    batch.count = 0;
    for (size_t i = start; i < end; ++i) batch.push(missed_[i].direction);
    batch.pad();
    context_.scene.look_up_background(batch, radiance);
    for (size_t i = start; i < end; ++i) {
      CameraSample& sample = flight_.samples[missed_[i].sample];
      sample.radiance =
          clamped(missed_[i].throughput * radiance.get(static_cast<int>(i - start)), o.light_paths.limit(0));
      sample.alpha = 1.0f;
      if (!surfaces_.empty()) surfaces_[missed_[i].sample].shine = sample.radiance;
    }
  }
  if (!o.transparent && o.hide_world) {
    for (const Miss& miss : missed_) flight_.samples[miss.sample].alpha = 1.0f;
  }
  missed_.clear();
}

}  // namespace velour
