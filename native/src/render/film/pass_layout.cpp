#include "render/film/pass_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "render/film/cryptomatte.h"

namespace velour {

void PixelSum::add(const CameraSample& sample) {
  if (camera_rays == 0) depth = sample.depth;
  radiance += sample.radiance;
  alpha += sample.alpha;
  normal += sample.normal;
  luminance[camera_rays % 2] += velour::luminance(sample.radiance);
  ++camera_rays;
  directions += static_cast<uint32_t>(sample.directions);
}

void PixelSum::join(const PixelSum& later) {
  if (camera_rays == 0) depth = later.depth;
  radiance += later.radiance;
  alpha += later.alpha;
  normal += later.normal;
  // The halves take turns: after an odd number of rays the next one belongs to the second.
  for (uint32_t half = 0; half < 2; ++half) luminance[(camera_rays + half) % 2] += later.luminance[half];
  camera_rays += later.camera_rays;
  directions += later.directions;
}

double PixelSum::mean_luminance() const {
  return (static_cast<double>(luminance[0]) + static_cast<double>(luminance[1])) / camera_rays;
}

double PixelSum::variance() const {
  const double odd = camera_rays / 2, even = camera_rays - camera_rays / 2, n = camera_rays;
  const double difference = static_cast<double>(luminance[0]) / even - static_cast<double>(luminance[1]) / odd;
  // E difference^2 = v (1/even + 1/odd) where a half of k rays has variance v / k, and the mean has v / n.
  return difference * difference * even * odd / (n * n);
}

float Mist::at(float distance) const {
  if (!(depth > 0.0f)) return 0.0f;
  return std::pow(std::clamp((distance - start) / depth, 0.0f, 1.0f), exponent);
}

namespace {

struct CameraRay {
  const SurfaceSample& surface;
  const CameraSample& sample;
  const PixelSum& before;
};

void set(float* v, const Vec3& x) {
  for (int c = 0; c < 3; ++c) v[c] = x[c];
}
void increase(float* v, const Vec3& x) {
  for (int c = 0; c < 3; ++c) v[c] += x[c];
}
bool is_first(const CameraRay& ray) { return ray.before.camera_rays == 0; }

/// Sums of squared deviations from the mean by Welford's method, which loses no digits where errors are small.
void add_error(const CameraRay& ray, float* v) {
  const float n = static_cast<float>(ray.before.camera_rays);
  for (int c = 0; c < 3; ++c) {
    const float x = ray.sample.radiance[c], sum = ray.before.radiance[c];
    if (n > 0.0f) v[c] += (x - sum / n) * (x - (sum + x) / (n + 1.0f));
  }
}

void write_error(const float* v, const PixelSum& sum, float* out) {
  const double n = sum.camera_rays;
  for (int c = 0; c < 3; ++c) {
    out[c] = n > 1.0 ? static_cast<float>(std::sqrt(std::max(0.0, static_cast<double>(v[c])) / (n * (n - 1.0)))) : 0.0f;
  }
}

/// Two successive runs of camera rays.
struct Runs {
  const PixelSum& before;
  const PixelSum& later;
};

/// Sum of squared deviations of two runs from their common mean (Chan, Golub and LeVeque).
void join_error(const Runs& runs, float* v, const float* later) {
  const double n = runs.before.camera_rays, m = runs.later.camera_rays;
  if (m == 0.0) return;
  for (int c = 0; c < 3; ++c) {
    const double apart = n > 0.0 ? runs.before.radiance[c] / n - runs.later.radiance[c] / m : 0.0;
    v[c] =
        static_cast<float>(static_cast<double>(v[c]) + static_cast<double>(later[c]) + apart * apart * n * m / (n + m));
  }
}

template <int channels>
void join_first(const Runs& runs, float* v, const float* later) {
  if (runs.before.camera_rays == 0) std::copy_n(later, channels, v);
}

template <int channels>
void join_sums(const Runs& /*runs*/, float* v, const float* later) {
  for (int c = 0; c < channels; ++c) v[c] += later[c];
}

/// A pass of `channels` values, for which a pixel stores `floats`.
struct ValuePass {
  uint32_t bit;
  std::string_view name;
  int channels, floats;
  void (*add)(const CameraRay& ray, float* values);
  void (*join)(const Runs& runs, float* values, const float* later);
  void (*write)(const float* values, const PixelSum& sum, float* out);
};

template <int channels>
void write_as_is(const float* v, const PixelSum& /*sum*/, float* out) {
  std::copy_n(v, channels, out);
}

// Floats that a pixel stores for its halves: sums of color, denoising albedo and normal over the even camera rays, and
// of the albedo over all.
constexpr int kFloatsOfHalves = 12;
using HalfSum = std::array<Vec3, 3>;

HalfSum first_half(const float* v) { return {Vec3{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}; }
HalfSum second_half(const float* v, const PixelSum& sum) {
  HalfSum half = first_half(v);
  const HalfSum all = {sum.radiance, Vec3(v[9], v[10], v[11]), sum.normal};
  for (size_t i = 0; i < half.size(); ++i) half[i] = all[i] - half[i];
  return half;
}

void add_halves(const CameraRay& ray, float* v) {
  const Rgb albedo = ray.surface.albedo + ray.surface.shine;
  increase(v + 9, albedo);
  if (ray.before.camera_rays % 2 != 0) return;
  increase(v, ray.sample.radiance);
  increase(v + 3, albedo);
  increase(v + 6, ray.sample.normal);
}

/// After an odd number of rays the next one belongs to the second half.
void join_halves(const Runs& runs, float* v, const float* later) {
  const bool in_turn = runs.before.camera_rays % 2 == 0;
  const HalfSum more = in_turn ? first_half(later) : second_half(later, runs.later);
  for (size_t i = 0; i < more.size(); ++i) increase(v + 3 * i, more[i]);
  increase(v + 9, {later[9], later[10], later[11]});
}

void write_halves(const float* v, const PixelSum& sum, float* out) {
  const uint32_t odd = sum.camera_rays / 2, even = sum.camera_rays - odd;
  const auto write = [&](const HalfSum& half, uint32_t rays) {
    for (const Vec3& mean : half) {
      for (int c = 0; c < 3; ++c) *out++ = rays > 0 ? mean[c] / static_cast<float>(rays) : 0.0f;
    }
  };
  write(first_half(v), even);
  write(second_half(v, sum), odd);
}

constexpr ValuePass kValues[] = {
    {pass::kPosition, "Position", 3, 3,
     [](const CameraRay& ray, float* v) {
       if (is_first(ray)) set(v, ray.surface.position);
     },
     join_first<3>, write_as_is<3>},
    {pass::kUv, "UV", 3, 3, [](const CameraRay& ray, float* v) { increase(v, ray.surface.uv); }, join_sums<3>,
     [](const float* v, const PixelSum& sum, float* out) {
       for (int c = 0; c < 3; ++c) out[c] = v[c] * sum.weight();
     }},
    {pass::kObjectIndex, "IndexOB", 1, 1,
     [](const CameraRay& ray, float* v) {
       if (is_first(ray)) *v = ray.surface.object_index;
     },
     join_first<1>, write_as_is<1>},
    {pass::kMaterialIndex, "IndexMA", 1, 1,
     [](const CameraRay& ray, float* v) {
       if (is_first(ray)) *v = ray.surface.material_index;
     },
     join_first<1>, write_as_is<1>},
    {pass::kMist, "Mist", 1, 1, [](const CameraRay& ray, float* v) { *v += ray.surface.clear; }, join_sums<1>,
     [](const float* v, const PixelSum& sum, float* out) {
       *out = sum.camera_rays > 0 ? std::clamp(1.0f - *v * sum.weight(), 0.0f, 1.0f) : 0.0f;
     }},
    {pass::kAlbedo, "Albedo", 3, 3,
     [](const CameraRay& ray, float* v) {
       for (int c = 0; c < 3; ++c) v[c] += ray.surface.albedo[c];
     },
     join_sums<3>,
     [](const float* v, const PixelSum& sum, float* out) {
       for (int c = 0; c < 3; ++c) out[c] = std::clamp(v[c] * sum.weight(), 0.0f, 1.0f);
     }},
    {pass::kError, "Error", 3, 3, add_error, join_error, write_error},
    // As in Cycles, so that a denoiser sees the edges of emitters; may be above 1.
    {pass::kDenoisingAlbedo, "Denoising Albedo", 3, 3,
     [](const CameraRay& ray, float* v) {
       for (int c = 0; c < 3; ++c) v[c] += ray.surface.albedo[c] + ray.surface.shine[c];
     },
     join_sums<3>,
     [](const float* v, const PixelSum& sum, float* out) {
       for (int c = 0; c < 3; ++c) out[c] = v[c] * sum.weight();
     }},
    {pass::kHalves, "Halves", 18, kFloatsOfHalves, add_halves, join_halves, write_halves},
    {pass::kVector, "Vector", 4, 5,
     [](const CameraRay& ray, float* v) {
       const SurfaceSample& s = ray.surface;
       const float more[] = {s.from_previous.x, s.from_previous.y, s.to_next.x, s.to_next.y, s.surfaces};
       for (int c = 0; c < 5; ++c) v[c] += more[c];
     },
     join_sums<5>,
     [](const float* v, const PixelSum& /*sum*/, float* out) {
       for (int c = 0; c < 4; ++c) out[c] = v[4] > 0.0f ? v[c] / v[4] : 0.0f;
     }},
};

struct IdPass {
  uint32_t bit;
  std::string_view name;  // followed by two digits
  float SurfaceSample::*id;
};

constexpr IdPass kIds[] = {{pass::kCryptoObject, "CryptoObject", &SurfaceSample::object_id},
                           {pass::kCryptoMaterial, "CryptoMaterial", &SurfaceSample::material_id},
                           {pass::kCryptoAsset, "CryptoAsset", &SurfaceSample::asset_id}};

const ValuePass* find_value(std::string_view name) {
  const auto* found = std::ranges::find(kValues, name, &ValuePass::name);
  return found != std::end(kValues) ? found : nullptr;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The pass that `name` belongs to, and its level: "CryptoAsset02" is the third.
struct IdLevel {
  const IdPass* pass = nullptr;
  int level = 0;
};
IdLevel find_ids(std::string_view name) {
  if (name.size() < 2) return {};
  const char tens = name[name.size() - 2], ones = name.back();
  const auto* found = std::ranges::find(kIds, name.substr(0, name.size() - 2), &IdPass::name);
  if (found == std::end(kIds) || !is_digit(tens) || !is_digit(ones)) return {};
  return {found, 10 * (tens - '0') + (ones - '0')};
}

}  // namespace

PassLayout::PassLayout(const PassOptions& options) : asked_(options.asked), ranks_(options.cryptomatte_ranks) {
  if ((asked_ & ~pass::kAll) != 0) {
    throw Error(Status::invalid_argument, "The requested passes are " + std::to_string(asked_) +
                                              ", which has bits other than the VLR_PASS values.");
  }
  if (ranks_ < 2 || ranks_ > PassOptions::kMaxRanks) {
    throw Error(Status::invalid_argument, "The number of Cryptomatte ids per pixel is " + std::to_string(ranks_) +
                                              "; it must be 2 to " + std::to_string(PassOptions::kMaxRanks) + ".");
  }
  for (uint32_t bit = 1; bit <= pass::kAll; bit *= 2) size_ += floats(bit);
}

/// Floats per pixel; 0 if the pass is not requested.
size_t PassLayout::floats(uint32_t bit) const {
  if ((asked_ & bit) == 0) return 0;
  const auto* value = std::ranges::find(kValues, bit, &ValuePass::bit);
  return static_cast<size_t>(value != std::end(kValues) ? value->floats : floats_of_ids(ranks_));
}

/// Offset of the floats of a pass: values come before ids, each in the order of their tables.
size_t PassLayout::place(uint32_t bit) const {
  size_t before = 0;
  for (const ValuePass& value : kValues) {
    if (value.bit == bit) return before;
    before += floats(value.bit);
  }
  for (const IdPass& ids : kIds) {
    if (ids.bit == bit) return before;
    before += floats(ids.bit);
  }
  return before;
}

int PassLayout::channels(std::string_view name) {
  if (const ValuePass* value = find_value(name)) return value->channels;
  return find_ids(name).pass != nullptr ? 4 : 0;
}

bool PassLayout::has(std::string_view name) const {
  if (const ValuePass* value = find_value(name)) return (asked_ & value->bit) != 0;
  const auto [ids, level] = find_ids(name);
  return ids != nullptr && (asked_ & ids->bit) != 0 && 2 * level < ranks_;
}

void PassLayout::add(const SurfaceSample& surface, const CameraSample& sample, const PixelSum& before,
                     float* values) const {
  const CameraRay ray{surface, sample, before};
  for (const ValuePass& value : kValues) {
    if ((asked_ & value.bit) == 0) continue;
    value.add(ray, values);
    values += value.floats;
  }
  const auto ids_a_pixel = static_cast<size_t>(floats_of_ids(ranks_));
  for (const IdPass& ids : kIds) {
    if ((asked_ & ids.bit) == 0) continue;
    add_id(surface.*ids.id, surface.seen, {values, ids_a_pixel});
    values += ids_a_pixel;
  }
}

void PassLayout::join(const PixelSum& before, std::span<float> values, const PixelSum& later,
                      std::span<const float> later_values) const {
  const Runs runs{before, later};
  size_t at = 0;
  for (const ValuePass& value : kValues) {
    if ((asked_ & value.bit) == 0) continue;
    value.join(runs, &values[at], &later_values[at]);
    at += static_cast<size_t>(value.floats);
  }
  const auto ids_a_pixel = static_cast<size_t>(floats_of_ids(ranks_));
  for (const IdPass& ids : kIds) {
    if ((asked_ & ids.bit) == 0) continue;
    for (size_t i = at; i < at + ids_a_pixel; i += 2) {
      add_id(later_values[i], later_values[i + 1], values.subspan(at, ids_a_pixel));
    }
    at += ids_a_pixel;
  }
}

void PassLayout::write(std::string_view name, std::span<const PixelSum> sums, std::span<const float> values,
                       float* out) const {
  const ValuePass* value = find_value(name);
  const auto [ids, level] = find_ids(name);
  const uint32_t bit = value != nullptr ? value->bit : ids->bit;
  const int count = channels(name);
  const float* from = values.data() + place(bit);
  for (const PixelSum& sum : sums) {
    if (value != nullptr) {
      value->write(from, sum, out);
    } else {
      write_ids({from, floats(bit)}, 2 * level, sum.weight(), out);
    }
    from += size_;
    out += count;
  }
}

}  // namespace velour
