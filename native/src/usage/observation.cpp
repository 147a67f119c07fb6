#include "usage/observation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.h"
#include "base/file.h"
#include "base/json_fields.h"

namespace velour {

namespace {

/// Appends `hit` with those of its terms whose direction satisfies `wanted`.
template <typename Wanted>
void append(SceneObservation& into, const SceneObservation& from, const ObservedHit& hit, const Wanted& wanted) {
  ObservedHit same = hit;
  same.first = same.middle = static_cast<uint32_t>(into.wl.size());
  for (uint32_t i = hit.first; i < hit.last; ++i) {
    if (!wanted(from.wl[i])) continue;
    into.wl.push_back(from.wl[i]);
    into.light.push_back(from.light[i]);
    if (i < hit.middle) ++same.middle;
  }
  same.last = static_cast<uint32_t>(into.wl.size());
  into.hits.push_back(same);
}

void append(SceneObservation& into, const SceneObservation& from, const ObservedHit& hit) {
  append(into, from, hit, [](const Vec3&) { return true; });
}

void merge(SceneDomain& into, const SceneDomain& other) {
  for (size_t i = 0; i < into.view.size(); ++i) into.view[i] += other.view[i];
  for (size_t i = 0; i < into.hash.size(); ++i) into.hash[i] += other.hash[i];
  merge(into.surface, other.surface);
  into.camera_rays += other.camera_rays;
  into.frames += other.frames;
  into.light_density = std::max(into.light_density, other.light_density);
}

}  // namespace

SceneObservation reflected_part(const SceneObservation& observation) {
  SceneObservation part;
  part.domain = observation.domain;
  for (const ObservedHit& hit : observation.hits) {
    append(part, observation, hit, [](const Vec3& wl) { return wl.z > 0; });
  }
  return part;
}

void merge(SceneObservation& into, const SceneObservation& other) {
  const SceneObservation before = std::move(into);
  into = {};
  into.domain = before.domain;
  merge(into.domain, other.domain);
  for (size_t a = 0, b = 0; into.hits.size() < SceneObservation::kHits;) {
    const bool has_a = a < before.hits.size(), has_b = b < other.hits.size();
    if (!has_a && !has_b) break;
    if (has_a && (!has_b || before.hits[a].key <= other.hits[b].key)) {
      append(into, before, before.hits[a++]);
    } else {
      append(into, other, other.hits[b++]);
    }
  }
}

namespace {

/// Whether bin `i` lies within `range`; both are in whole degrees.
bool holds(const ViewRange& range, size_t i) {
  const int degree = static_cast<int>(i);
  return degree >= range.begin && degree < range.end;
}

double share_of_views_outside(const ViewRange& range, const SceneDomain& frame) {
  double outside = 0;
  for (size_t i = 0; i < frame.view.size(); ++i) outside += holds(range, i) ? 0.0 : frame.view[i];
  return outside / frame.weight();
}

}  // namespace

double out_of_domain(const SceneDomain& domain, const ViewRange& range, const SceneObservation& frame) {
  if (frame.hits.empty() || !(frame.domain.weight() > 0.0)) return 0.0;
  const double most = kSharperLight * domain.light_density;
  const auto sharper = std::ranges::count_if(frame.hits, [&](const ObservedHit& hit) {
    return range.holds(theta_of(hit.wv)) && static_cast<double>(hit.light_density) > most;
  });
  const double by_light = static_cast<double>(sharper) / static_cast<double>(frame.hits.size());
  return std::min(1.0, share_of_views_outside(range, frame.domain) + by_light);
}

double out_of_views(const SceneDomain& domain, const SceneObservation& frame) {
  return share_from_elsewhere(domain.directions(), frame.domain.directions());
}

double out_of_resolution(uint32_t texels, const SceneObservation& frame) {
  return frame.domain.weight() > 0.0 ? share_finer_than(frame.domain.surface, texels) : 0.0;
}

namespace {

template <typename T>
void append(std::vector<uint8_t>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  const auto* first = reinterpret_cast<const uint8_t*>(raw.data());
  bytes.insert(bytes.end(), first, first + raw.size());
}

/// ObservedHit without padding, whose bytes are undefined.
struct PackedHit {
  uint64_t key;
  float wv[3], light_density;
  uint32_t first, middle, last, back;
};
static_assert(sizeof(PackedHit) == 40);

PackedHit packed(const ObservedHit& hit) {
  return {hit.key, {hit.wv.x, hit.wv.y, hit.wv.z}, hit.light_density, hit.first, hit.middle, hit.last, hit.back};
}

}  // namespace

std::array<uint64_t, 4> content_hash(const SceneObservation& observation) {
  std::vector<PackedHit> hits;
  for (const ObservedHit& hit : observation.hits) hits.push_back(packed(hit));
  std::vector<uint8_t> bytes;
  append(bytes, std::span<const double>(observation.domain.view));
  append(bytes, std::span<const double>(&observation.domain.light_density, 1));
  if (observation.domain.surface.weight() > 0) {  // keeps the older hashes of uniform materials
    append(bytes, std::span<const double>(observation.domain.surface.footprint));
    append(bytes, std::span<const double>(observation.domain.surface.tile));
    append(bytes, std::span<const double>(observation.domain.surface.views.weight));
  }
  append(bytes, std::span<const PackedHit>(hits));
  append(bytes, std::span<const Vec3>(observation.wl));
  append(bytes, std::span<const Rgb>(observation.light));
  return *parse_hash(sha256_hex(bytes));
}

namespace {

constexpr std::string_view kHex = "0123456789abcdef";

}  // namespace

std::string hash_text(const std::array<uint64_t, 4>& hash) {
  std::string text;
  for (const uint64_t word : hash) {
    for (int shift = 60; shift >= 0; shift -= 4) text += kHex[word >> shift & 15];
  }
  return text;
}

std::optional<std::array<uint64_t, 4>> parse_hash(std::string_view text) {
  if (text.size() != 64) return std::nullopt;
  std::array<uint64_t, 4> hash{};
  for (size_t i = 0; i < text.size(); ++i) {
    const size_t digit = kHex.find(text[i]);
    if (digit == std::string_view::npos) return std::nullopt;
    hash[i / 16] = hash[i / 16] << 4 | digit;
  }
  return hash;
}

namespace {

using Json = JsonFields::Json;

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr const char* kFormat = "velour-observation";
constexpr uint64_t kVersion = 1;
/// Fifty times the size of an observation.
constexpr uint64_t kMaxBytes = uint64_t{128} << 20;
constexpr uint64_t kMaxTerms = kMaxBytes / sizeof(Vec3);
constexpr uint64_t kMaxRays = uint64_t{1} << 62;  // so that sums of a few do not overflow

template <typename T>
std::string base64_of(const T& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return base64({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

Json hits_json(const std::vector<ObservedHit>& hits) {
  std::vector<uint64_t> key;
  std::vector<Vec3> wv;
  std::vector<float> light_density;
  std::vector<uint32_t> terms;
  std::vector<uint8_t> back;
  for (const ObservedHit& hit : hits) {
    key.push_back(hit.key);
    wv.push_back(hit.wv);
    light_density.push_back(hit.light_density);
    terms.insert(terms.end(), {hit.middle - hit.first, hit.last - hit.middle});
    back.push_back(hit.back);
  }
  Json json = {{"count", hits.size()},
               {"key", base64_of(key)},
               {"wv", base64_of(wv)},
               {"light_density", base64_of(light_density)},
               {"terms", base64_of(terms)}};
  if (std::ranges::count(back, 1) > 0) json["back"] = base64_of(back);
  return json;
}

Json surface_json(const SurfaceDomain& surface) {
  Json json = {{"footprint", surface.footprint}, {"tile", surface.tile}};
  if (surface.views.sum() > 0) json["views"] = base64_of(surface.views.weight);
  return json;
}

void read_directions(const JsonFields& fields, ViewWeights& views) {
  const auto weights = fields.values<double>("views", views.weight.size());
  std::ranges::copy(weights, views.weight.begin());
  const bool good = std::ranges::all_of(weights, [](double w) { return w >= 0; });
  if (!good || !std::isfinite(views.sum())) fields.fail("views", "numbers of at least 0 with a finite sum");
}

SurfaceDomain read_surface(const JsonFields& fields) {
  SurfaceDomain surface;
  std::ranges::copy(fields.numbers("footprint", surface.footprint.size()), surface.footprint.begin());
  std::ranges::copy(fields.numbers("tile", surface.tile.size()), surface.tile.begin());
  if (!std::isfinite(surface.weight())) fields.fail("footprint", "a list of numbers with a finite sum");
  if (fields.has("views")) read_directions(fields, surface.views);
  return surface;
}

SceneDomain read_domain(const JsonFields& fields) {
  SceneDomain domain;
  std::ranges::copy(fields.numbers("view", SceneDomain::kViewBins), domain.view.begin());
  if (!std::isfinite(domain.weight())) fields.fail("view", "a list of numbers with a finite sum");
  domain.camera_rays = fields.whole("camera_rays", kMaxRays);
  domain.frames = fields.whole("frames", kMaxRays);
  domain.light_density = fields.number_or_infinite("light_density");
  const auto hash = parse_hash(fields.text("hash"));
  if (!hash) fields.fail("hash", "64 hexadecimal digits");
  domain.hash = *hash;
  if (fields.has("surface")) domain.surface = read_surface(fields.object("surface"));
  return domain;
}

bool is_unit(const Vec3& w) { return std::abs(glm::length(w) - 1.0f) < 1e-3f; }
bool is_above_horizon(const Vec3& w) { return w.z > 0.0f && is_unit(w); }

/// Assigns each hit the terms that follow those of the previous hit.
void read_term_counts(const JsonFields& fields, uint64_t total, std::vector<ObservedHit>& hits) {
  const auto counts = fields.values<uint32_t>("terms", 2 * hits.size());
  constexpr const char* kWanted = "counts that add up to 'terms.count'";
  uint64_t next = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const uint64_t middle = next + counts[2 * i], last = middle + counts[2 * i + 1];
    if (last > total) fields.fail("terms", kWanted);
    hits[i].first = static_cast<uint32_t>(next);
    hits[i].middle = static_cast<uint32_t>(middle);
    hits[i].last = static_cast<uint32_t>(next = last);
  }
  if (next != total) fields.fail("terms", kWanted);
}

void read_sides(const JsonFields& fields, std::vector<ObservedHit>& hits) {
  const auto back = fields.values<uint8_t>("back", hits.size());
  if (!std::ranges::all_of(back, [](uint8_t b) { return b <= 1; })) fields.fail("back", "a list of bytes 0 or 1");
  for (size_t i = 0; i < hits.size(); ++i) hits[i].back = back[i] == 1;
}

std::vector<ObservedHit> read_hits(const JsonFields& fields, uint64_t terms) {
  std::vector<ObservedHit> hits(fields.whole("count", SceneObservation::kHits));
  const auto key = fields.values<uint64_t>("key", hits.size());
  const auto wv = fields.values<Vec3>("wv", hits.size());
  const auto light_density = fields.values<float>("light_density", hits.size());
  if (!std::ranges::is_sorted(key)) fields.fail("key", "in ascending order");
  if (!std::ranges::all_of(wv, is_above_horizon)) fields.fail("wv", "unit vectors above the horizon");
  if (!std::ranges::all_of(light_density, [](float d) { return d >= 0.0f; })) {
    fields.fail("light_density", "numbers of at least 0");
  }
  for (size_t i = 0; i < hits.size(); ++i) hits[i] = {key[i], wv[i], 0, 0, 0, light_density[i]};
  if (fields.has("back")) read_sides(fields, hits);
  read_term_counts(fields, terms, hits);
  return hits;
}

/// Channels may be negative: colors outside the working space.
bool is_finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

void read_terms(const JsonFields& fields, uint64_t count, SceneObservation& observation) {
  observation.wl = fields.values<Vec3>("wl", count);
  observation.light = fields.values<Rgb>("light", count);
  if (!std::ranges::all_of(observation.wl, is_unit)) fields.fail("wl", "unit vectors");
  if (!std::ranges::all_of(observation.light, is_finite)) fields.fail("light", "finite numbers");
}

Json parsed(std::span<const uint8_t> bytes, const std::string& name) {
  Json json = parse_json(bytes);
  if (!is_of_format(json, kFormat)) {
    throw Error(Status::bad_data, name + ": is not a scene usage file (JSON with format '" + kFormat +
                                      "'); it may be truncated. Write it again with 'velour observe'.");
  }
  return json;
}

void check_version(const JsonFields& fields, const std::string& name) {
  const uint64_t version = fields.whole("version", std::numeric_limits<uint64_t>::max());
  if (version == kVersion) return;
  throw Error(Status::version_mismatch, name + ": the scene usage has format version " + std::to_string(version) +
                                            "; this Velour reads version " + std::to_string(kVersion) +
                                            ". Observe the scene again.");
}

}  // namespace

std::string encode_observation(const SceneObservation& observation) {
  const SceneDomain& domain = observation.domain;
  const Json density = std::isfinite(domain.light_density) ? Json(domain.light_density) : Json(nullptr);
  Json json = {
      {"format", kFormat},
      {"version", kVersion},
      {"frames", domain.frames},
      {"camera_rays", domain.camera_rays},
      {"light_density", density},
      {"hash", hash_text(domain.hash)},
      {"view", domain.view},
      {"hits", hits_json(observation.hits)},
      {"terms",
       {{"count", observation.wl.size()}, {"wl", base64_of(observation.wl)}, {"light", base64_of(observation.light)}}}};
  if (domain.surface.weight() > 0) json["surface"] = surface_json(domain.surface);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SceneObservation decode_observation(std::span<const uint8_t> bytes, const std::string& name) {
  const Json json = parsed(bytes, name);
  const JsonSource source{name, "the file is damaged. Observe the scene again."};
  const JsonFields fields(json, source);
  check_version(fields, name);
  SceneObservation observation;
  observation.domain = read_domain(fields);
  const JsonFields terms = fields.object("terms");
  const uint64_t count = terms.whole("count", kMaxTerms);
  observation.hits = read_hits(fields.object("hits"), count);
  read_terms(terms, count, observation);
  if (observation.hits.empty() != (observation.domain.weight() == 0.0)) {
    fields.fail("hits", "empty if and only if all weights in 'view' are 0");
  }
  return observation;
}

void save_observation(const SceneObservation& observation, const std::string& path) {
  const std::string text = encode_observation(observation);
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

SceneObservation load_observation(const std::string& path) {
  return decode_observation(read_file(path, kMaxBytes), path);
}

bool is_observation_file(const std::string& path) {
  const auto head = read_file_head(path, 64);
  const std::string text(head.begin(), head.end());
  return text.starts_with('{') && text.find(kFormat) != std::string::npos;
}

}  // namespace velour
