#include "render/path/direct_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace velour {

namespace {

bool zero(const Rgb& c) { return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f; }
bool finite(const Rgb& c) { return std::isfinite(c.r + c.g + c.b); }

}  // namespace

void DirectLight::gather(std::span<const Receiver> receivers, bool go_on, ShadowQueue& shadows,
                         std::vector<CameraSample>& samples) {
  gather(receivers, go_on, Output{&shadows, &samples, nullptr});
}

void DirectLight::gather_incident(const Vertex& vertex, PathNumbers& numbers, int directions, bool go_on,
                                  IncidentLight& incident) {
  incident.terms.clear();
  incident.paths.clear();
  const Receiver receiver{vertex, &numbers, Rgb(1.0f), 0, directions, directions};
  gather({&receiver, 1}, go_on, Output{nullptr, nullptr, &incident});
}

void DirectLight::gather(std::span<const Receiver> receivers, bool go_on, Output output) {
  awaited_.clear();
  arena_.reset();
  for (size_t k = 0; k < receivers.size(); ++k) {
    if (lighting_.has_extended()) views_[k] = lighting_.view(receivers[k].vertex.light_place());
    prepare(receivers[k], go_on, output, work_[k], views_[k]);
  }
  make_points(receivers);
  draw_towards_lights(receivers);
  draw_towards_products(receivers);
  terms_.clear();
  for (size_t k = 0; k < receivers.size(); ++k) shade(receivers[k], static_cast<uint8_t>(k), output);
  settle(receivers, output);
  if (!lighting_.emissive().empty()) settle_emissive(receivers, output);
  gather_deltas(receivers, output);
}

void DirectLight::prepare(const Receiver& receiver, bool go_on, Output output, Work& work, const LightView& view) {
  const Vertex& vertex = receiver.vertex;
  const PrepareOptions options{.interpolated_draws = is_dissertations(options_.strategy),
                               .of_path = !output.is_incident(),
                               .filter = lobe_filter(options_.light_paths, receiver.past)};
  work.prepared = PreparedSurface(sampling_, vertex, options, arena_);
  work.under_sky = nullptr;
  if (vertex.transmits && options.of_path && even_sky_) {
    PrepareOptions facets = options;
    facets.facets_only = true;
    work.under_sky = &PreparedSurface(sampling_, vertex, facets, arena_).brdf();
  }
  work.deltas.count = 0;
  work.deltas.rest = 1.0f;
  if (vertex.transmits && options.of_path) work.prepared.brdf().delta_lobes(work.deltas);
  choose_continuation(receiver, go_on, work);
  work.goes_on_along_all = go_on && output.is_incident();
  const bool lit = lighting_.has_extended() && work.deltas.rest > 0.0f, explores = !lit && work.goes_on_along_all;
  work.shares = explores ? Shares{0.0f, 1.0f, 0.0f} : shares_at(receiver, view, work);
  // Products may be too narrow to meet an emitter, so that a path that continues leaves it to its continuation.
  work.counts_all_emissive = work.shares.surface > 0.0f || (!go_on && work.shares.product > 0.0f);
  PathNumbers& numbers = *receiver.numbers;
  const auto all = numbers.all(lit || explores ? receiver.directions : 0, receiver.full);
  const auto [rest, product] = numbers.deal(all, work.shares.product, Purpose::product_side);
  const auto [surface, lights] = numbers.deal(rest, work.shares.lights / (1.0f - work.shares.product), Purpose::side);
  work.from_product = product;
  work.from_surface = surface;
  work.from_lights = lights;
  // One of several directions would be every n-th point of their sequence; such points are not even.
  work.goes_on_drawn = go_on && surface.count == 1 && !output.is_incident() && work.along_delta < 0;
  work.continuation.reset();
  work.shared_term = -1;
}

Shares DirectLight::shares_at(const Receiver& receiver, const LightView& view, Work& work) {
  const Vertex& vertex = receiver.vertex;
  const Mixing& mixing = receiver.mixing != nullptr ? *receiver.mixing : mixing_;
  if (!mixing.products || sky_ == nullptr) return shares(mixing);
  ProposalLobes lobes;
  const bool proposed = work.prepared.brdf().proposal_lobes(lobes) &&
                        sky_->proposals.propose(lobes, vertex.frame, products_, work.product);
  if (!proposed) return shares(mixing);
  const float both = kProductShare * view.environment, lights = lights_part(vertex) * both;
  return shares(mixing, both - lights, lights);
}

void DirectLight::make_points(std::span<const Receiver> receivers) {
  points_.clear();
  const auto ask = [&](size_t k, Purpose purpose, PathNumbers::Run run) {
    const int first = points_.count();
    receivers[k].numbers->points(purpose, run.first, run.count, points_);
    return first;
  };
  for (size_t k = 0; k < receivers.size(); ++k) {
    work_[k].light_point = ask(k, Purpose::light, work_[k].from_lights);
  }
  for (size_t k = 0; k < receivers.size(); ++k) {
    work_[k].product_point = ask(k, Purpose::product, work_[k].from_product);
    work_[k].surface_point = ask(k, Purpose::surface, work_[k].from_surface);
  }
  points_.resolve();
}

void DirectLight::draw_towards_lights(std::span<const Receiver> receivers) {
  uint8_t view_of[DirectionBatch::kCapacity];
  int count = 0;
  for (size_t k = 0; k < receivers.size(); ++k) {
    std::fill_n(view_of + count, work_[k].from_lights.count, static_cast<uint8_t>(k));
    count += work_[k].from_lights.count;
  }
  if (count == 0) return;
  lighting_.sample(views_, {view_of, static_cast<size_t>(count)}, points_.points(0, count), towards_lights_,
                   {aims_, lighting_.emissive().empty() ? 0 : static_cast<size_t>(count)});
}

/// Products are Gaussians in the world frame, so those of all vertices are sampled together.
void DirectLight::draw_towards_products(std::span<const Receiver> receivers) {
  product_draws_.count = 0;
  for (size_t k = 0; k < receivers.size(); ++k) {
    Work& work = work_[k];
    work.product_direction = product_draws_.count;
    product_draws_.choose(work.product, points_.points(work.product_point, work.from_product.count));
  }
  if (product_draws_.count > 0) product_draws_.directions(Kernel::gaussian, towards_products_);
}

/// A direction that cannot carry light counts in n but is not stored in the batch, so it costs nothing further.
void DirectLight::keep_if_lit(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world, Technique technique,
                              uint8_t aim) {
  if (!vertex.receives_light(wl, wl_world)) return;
  technique_[world_.count] = technique;
  aim_[world_.count] = aim;
  local_.push(wl);
  world_.push(wl_world);
}

void DirectLight::keep_world(const Vertex& vertex, const DirectionBatch& drawn, int first, int count,
                             Technique technique) {
  const bool aimed = technique == Technique::lights && !lighting_.emissive().empty();
  for (int i = first; i < first + count; ++i) {
    const Vec3 wl_world = drawn.get(i);  // zero for the dark side of a light: then not above the horizon
    const uint8_t aim = aimed && aims_[i].instance != kNoHit ? static_cast<uint8_t>(i + 1) : 0;
    keep_if_lit(vertex, vertex.frame.to_local(wl_world), wl_world, technique, aim);
  }
}

void DirectLight::draw_from_surface(const Receiver& receiver, const Work& work) {
  if (work.from_surface.count == 0) return;
  const auto u = points_.points(work.surface_point, work.from_surface.count);
  work.prepared.sample(u, drawn_);
  for (int i = 0; i < drawn_.count; ++i) {
    const Vec3 wl = drawn_.get(i);
    keep_if_lit(receiver.vertex, wl, receiver.vertex.frame.to_world(wl), Technique::surface);
  }
}

void DirectLight::draw_sharp(const Receiver& receiver) {
  sharp_count_ = find_sharp_light(lighting_, receiver.vertex, *receiver.numbers, sharp_);
  for (int i = 0; i < sharp_count_; ++i) local_.push(sharp_[i].wl);
}

void DirectLight::shade(const Receiver& receiver, uint8_t place, Output output) {
  const Vertex& vertex = receiver.vertex;
  const Work& work = work_[place];
  local_.count = world_.count = 0;
  keep_world(vertex, towards_products_, work.product_direction, work.from_product.count, Technique::product);
  draw_from_surface(receiver, work);
  keep_world(vertex, towards_lights_, work.light_point, work.from_lights.count, Technique::lights);
  sharp_count_ = 0;
  if (!output.is_incident() && work.deltas.rest > 0.0f) draw_sharp(receiver);
  if (local_.count == 0) return;
  local_.pad();
  world_.pad();
  work.prepared.brdf().eval(local_, f_, material_pdf_);
  work.prepared.pdf(local_, material_pdf_, surface_pdf_);
  if (lighting_.has_extended()) add_terms(receiver, place, output);
  if (work.goes_on_along_all) add_continuations(vertex, work, *output.incident);
  for (int k = 0; k < sharp_count_; ++k) {
    const int i = world_.count + k;
    const Rgb reflected = receiver.throughput * reflectance(vertex, i) * std::abs(local_.z[i]);
    const SharpLight& sharp = sharp_[k];
    queue(receiver,
          {sharp.wl_world, reflected * sharp.irradiance, receiver.limit, sharp.distance, sharp.lamp->casts_shadow(),
           std::numeric_limits<float>::infinity()},
          output);
  }
}

void DirectLight::add_terms(const Receiver& receiver, uint8_t place, Output output) {
  const Work& work = work_[place];
  const bool has_product = work.shares.product > 0.0f;
  if (has_product) eval_density(work.product, world_, product_pdf_);
  const Rgb share = receiver.throughput / static_cast<float>(receiver.directions);
  for (int i = 0; i < world_.count; ++i) {
    const int to = terms_.world.count;
    terms_.world.push(world_.get(i));
    const Rgb f = output.is_incident() ? Rgb(1.0f) : reflectance(receiver.vertex, i);
    terms_.reflected.set(to, share * f * std::abs(local_.z[i]));
    terms_.product.v[to] = has_product ? work.shares.product * product_pdf_.v[i] : 0.0f;
    terms_.surface.v[to] = work.shares.surface * surface_pdf_.v[i];
    terms_.light_share.v[to] = work.shares.lights;
    terms_.technique[to] = technique_[i];
    terms_.receiver[to] = place;
    terms_.aim[to] = aim_[i];
    if (work.goes_on_drawn && technique_[i] == Technique::surface) go_on_along(receiver, i, to, work_[place]);
  }
}

void DirectLight::add_continuations(const Vertex& vertex, const Work& work, IncidentLight& incident) {
  const Rgb share(1.0f / static_cast<float>(work.from_surface.count));
  for (int i = 0; i < world_.count; ++i) {
    if (technique_[i] != Technique::surface) continue;
    const auto along = continuation_along(vertex, local_.get(i), world_.get(i), share, surface_pdf_.v[i]);
    if (along && finite(along->throughput)) incident.paths.push_back({static_cast<uint32_t>(i), *along});
  }
}

void DirectLight::go_on_along(const Receiver& receiver, int i, int term, Work& work) {
  const Vertex& vertex = receiver.vertex;
  work.continuation =
      continuation_along(vertex, local_.get(i), world_.get(i),
                         receiver.throughput * reflectance(vertex, i) / work.along_share, surface_pdf_.v[i]);
  const bool shares_ray = work.continuation && finite(work.continuation->throughput) && shares_rays_;
  if (shares_ray && vertex.rays_agree(world_.get(i))) work.shared_term = term;
}

void DirectLight::settle(std::span<const Receiver> receivers, Output output) {
  terms_.look_up(lighting_, views_, options_.heuristic);
  const auto add = [&](int i, const Rgb& light, float far, bool casts_shadow, bool of_smooth) {
    const Receiver& receiver = receivers[terms_.receiver[i]];
    settle_term(receivers, i,
                {terms_.world.get(i), light, limit_of_term(receiver), far, casts_shadow, terms_.light_pdf.v[i],
                 of_smooth, along_deltas_ || !of_smooth},
                output);
  };
  for (int i = 0; i < terms_.world.count; ++i) {
    // Cycles finds a sky of one color by bounces, which start on the mesh.
    const Vertex& vertex = receivers[terms_.receiver[i]].vertex;
    const Vec3 wl_world = terms_.world.get(i);
    if ((environment_hidden_ & vertex.kind_along(wl_world)) != 0) continue;
    if (even_sky_ && !vertex.receives(vertex.frame.to_local(wl_world), wl_world)) continue;
    const Rgb of_sky = terms_.weight.v[i] * terms_.environment.get(i);
    add(i, of_sky * reflected_sky(receivers, i), std::numeric_limits<float>::infinity(), true, !even_sky_);
  }
  for (const LampHit& hit : terms_.lamp_hits) {
    const int i = hit.direction;
    if (hit.lamp->is_hidden(receivers[terms_.receiver[i]].vertex.kind_along(terms_.world.get(i)))) continue;
    if (along_deltas_ && !hit.lamp->is_mirrored()) continue;
    const Rgb radiance = hit.lamp->radiance(terms_.world.get(i));
    add(i, terms_.lamp_weight.v[i] * radiance * terms_.reflected.get(i), hit.distance, hit.lamp->casts_shadow(), true);
  }
}

Rgb DirectLight::reflected_sky(std::span<const Receiver> receivers, int term) const {
  const size_t place = terms_.receiver[term];
  const PreparedBrdf* brdf = work_[place].under_sky;
  if (brdf == nullptr || along_deltas_) return terms_.reflected.get(term);
  const Receiver& receiver = receivers[place];
  const Vec3 wl = receiver.vertex.frame.to_local(terms_.world.get(term));
  const Rgb f = in_working_space(working_space_, receiver.vertex, brdf->eval_one(wl).f);
  return receiver.throughput * f * (std::abs(wl.z) / static_cast<float>(receiver.directions));
}

void DirectLight::settle_emissive(std::span<const Receiver> receivers, Output output) {
  Ray rays[DirectionBatch::kCapacity];
  uint8_t kinds[DirectionBatch::kCapacity];
  const auto count = static_cast<size_t>(terms_.world.count);
  for (int i = 0; i < terms_.world.count; ++i) {
    const Vertex& vertex = receivers[terms_.receiver[i]].vertex;
    const Vec3 wl_world = terms_.world.get(i);
    rays[i] = vertex.shadow_ray(wl_world, std::numeric_limits<float>::infinity());
    kinds[i] = vertex.kind_along(wl_world);
  }
  terms_.look_up_emissive(lighting_, views_, aims_, {rays, count}, {kinds, count});
  for (const LightTerms::EmissiveTerm& g : terms_.emissive) {
    const size_t place = terms_.receiver[g.direction];
    const Receiver& receiver = receivers[place];
    if (!counts_emissive(g.hit, counts_all_emissive(place))) continue;
    if (lighting_.emissive().is_hidden(g.hit, kinds[g.direction])) continue;
    const auto [radiance, far] = lighting_.emissive().light(rays[g.direction], g.hit, receiver.vertex.cone);
    const Rgb light = g.weight * radiance * terms_.reflected.get(g.direction);
    settle_term(receivers, g.direction,
                {terms_.world.get(g.direction), light, limit_of_term(receiver), far, true, g.pdf, true, along_deltas_},
                output);
  }
}

void DirectLight::settle_term(std::span<const Receiver> receivers, int term, const Contribution& c, Output output) {
  const size_t place = terms_.receiver[term];
  if (output.is_incident()) return add_incident(receivers[place].vertex, term, c, *output.incident);
  if (work_[place].shared_term != term) return queue(receivers[place], c, output);
  if (waits(receivers[place], c, output)) awaited_.push_back({place, c.light, c.limit, c.far});
}

Rgb DirectLight::reflectance(const Vertex& vertex, int direction) const {
  return in_working_space(working_space_, vertex, f_.get(direction));
}

bool DirectLight::keeps(const Rgb& light) {
  if (finite(light)) return true;
  ++nan_samples_;
  return false;
}

bool DirectLight::waits(const Receiver& receiver, const Contribution& c, Output output) {
  if (zero(c.light) || !keeps(c.light)) return false;
  if (!c.casts_shadow) (*output.samples)[receiver.sample].radiance += clamped(c.light, c.limit);
  return c.casts_shadow;
}

void DirectLight::queue(const Receiver& receiver, const Contribution& c, Output output) {
  if (!waits(receiver, c, output)) return;
  const Vertex& vertex = receiver.vertex;
  output.shadows->add(c.of_smooth ? vertex.shadow_ray(c.wl_world, c.far) : vertex.ray(c.wl_world, c.far), c.light,
                      receiver.sample, c.limit, c.by_bounces ? vertex.kind_along(c.wl_world) : hidden::kFromShadows);
}

void DirectLight::add_incident(const Vertex& vertex, int term, const Contribution& c, IncidentLight& incident) {
  if (zero(c.light) || !finite(c.light)) return;
  incident.terms.push_back({static_cast<uint32_t>(term), vertex.frame.to_local(c.wl_world), c.light, c.density,
                            vertex.shadow_ray(c.wl_world, c.far), c.casts_shadow});
}

std::optional<Continuation> DirectLight::extend(const Receiver& receiver, size_t place) {
  const Work& work = work_[place];
  if (work.along_delta < 0 && !(work.along_share > 0.0f)) return std::nullopt;
  const auto continuation =
      work.goes_on_drawn || work.along_delta >= 0
          ? work.continuation
          : sample_continuation(receiver.vertex, work.prepared, working_space_, receiver.throughput / work.along_share,
                                receiver.numbers->point(Purpose::continuation));
  if (!continuation || finite(continuation->throughput)) return continuation;
  ++nan_samples_;
  return std::nullopt;
}

PathPast DirectLight::past_after(const Receiver& receiver, size_t place, const Continuation& continuation) const {
  PathPast past{std::min(receiver.past.least_density, continuation.density), false,
                receiver.vertex.goes_through(continuation.ray.direction)};
  if (options_.light_paths.reflective_caustics) return past;
  const PreparedBrdf& brdf = work_[place].prepared.brdf();
  past.was_diffuse = receiver.numbers->label() < brdf.diffuse_share(continuation.wl, continuation.density);
  return past;
}

float LightTerms::weighed(Heuristic heuristic, int direction, float pdf) const {
  const float q[3] = {product.v[direction], surface.v[direction], light_share.v[direction] * pdf};
  const float density = effective_density(heuristic, q, technique[direction]);
  // A density of 0 results from rounding alone. NaN passes, to be counted.
  return density == 0.0f ? 0.0f : 1.0f / density;
}

void LightTerms::look_up(const Lighting& lighting, std::span<const LightView> views, Heuristic heuristic) {
  const int count = world.count;
  if (count == 0) return;
  world.pad();
  lighting.look_up(views, {receiver, static_cast<size_t>(count)}, world, environment, light_pdf, lamp_hits);
  for (int i = 0; i < count; ++i) weight.v[i] = aim[i] != 0 ? 0.0f : weighed(heuristic, i, light_pdf.v[i]);
  for (const LampHit& hit : lamp_hits) {
    const int i = hit.direction;
    lamp_weight.v[i] = aim[i] != 0 ? 0.0f : weighed(kLampHeuristic, i, light_pdf.v[i]);
  }
}

void LightTerms::look_up_emissive(const Lighting& lighting, std::span<const LightView> views, std::span<const Hit> aims,
                                  std::span<const Ray> rays, std::span<const uint8_t> kinds) {
  find_emissive(lighting.emissive(), aims, rays, kinds);
  for (EmissiveTerm& g : emissive) {
    const int i = g.direction;
    g.pdf = light_share.v[i] > 0.0f ? lighting.emissive_pdf(views[receiver[i]], world.get(i), g.hit) : 0.0f;
    g.weight = weighed(kLampHeuristic, i, g.pdf);
  }
}

void LightTerms::find_emissive(const EmissiveMeshes& surfaces, std::span<const Hit> aims, std::span<const Ray> rays,
                               std::span<const uint8_t> kinds) {
  Ray searching[DirectionBatch::kCapacity];
  uint8_t kind[DirectionBatch::kCapacity];
  int number[DirectionBatch::kCapacity];
  size_t count = 0;
  for (int i = 0; i < world.count; ++i) {
    if (aim[i] != 0) {
      emissive.push_back({i, aims[aim[i] - size_t{1}], 0.0f, 0.0f});
    } else if (technique[i] != Technique::lights) {
      number[count] = i;
      kind[count] = kinds[static_cast<size_t>(i)];
      searching[count++] = rays[static_cast<size_t>(i)];
    }
  }
  found_.clear();
  surfaces.meet({searching, count}, found_, {.each = {kind, count}});
  for (const EmissiveHit& f : found_) emissive.push_back({number[f.ray], f.hit, 0.0f, 0.0f});
}

}  // namespace velour
