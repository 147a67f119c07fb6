#include "material/microfacet/ggx.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"
#include "math/sphere/quadrature.h"

namespace velour {

namespace {

class PreparedGgx final : public PreparedBrdf {
 public:
  PreparedGgx(const GgxParameters& parameters, const GgxSampler& sampler, const Vec3& wv)
      : parameters_(parameters), sampler_(sampler), wv_(wv) {
    sampler.prepare(wv, point_);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, wl.z[i] > 0 ? ggx_model(parameters_, {.wl = wl.get(i), .wv = wv_}) : Rgb(0));
    }
    sampler_.pdf(point_, wl, pdf);
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return sampler_.sample(point_, v); });
  }

 private:
  const GgxParameters& parameters_;
  const GgxSampler& sampler_;
  Vec3 wv_;
  GgxPoint point_;
};

class GgxMaterial final : public Material {
 public:
  explicit GgxMaterial(const GgxParameters& parameters) : parameters_(parameters), sampler_(parameters) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& /*site*/, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<PreparedGgx>(parameters_, sampler_, wv);
  }

  bool isotropic() const override { return parameters_.alpha.x == parameters_.alpha.y; }

 private:
  GgxParameters parameters_;
  GgxSampler sampler_;
};

}  // namespace

std::shared_ptr<const Material> make_ggx_material(const GgxParameters& parameters) {
  return std::make_shared<GgxMaterial>(parameters);
}

namespace {

constexpr size_t kEntries = 32;      // of albedo tables, along roughness and along cosine
constexpr size_t kRiseEntries = 16;  // of mean-rise tables, along roughness, cosine and index
constexpr float kLeast = 1e-4f;      // roughness and cosine at the first entries, in place of 0

float at(size_t entry, size_t entries) {
  return std::max(static_cast<float>(entry) / static_cast<float>(entries - 1), kLeast);
}

Vec3 view_of(float cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

float white_albedo(float roughness, float cosine) {
  double sum = 0;
  for_visible_facets(view_of(cosine), Vec2(roughness * roughness),
                     [&](double weight, float /*cosine*/, float masking) { sum += weight * masking; });
  return std::min(static_cast<float>(sum), 1.0f);
}

/// Linear interpolation of an argument in [0, 1] between a table's `size` entries.
template <size_t size>
struct Place {
  size_t low, high;
  float share;  // weight of `high`

  explicit Place(float x) {
    const float place = std::clamp(x, 0.0f, 1.0f) * (size - 1);
    low = std::min(static_cast<size_t>(place), size - 2);
    high = low + 1;
    share = place - static_cast<float>(low);
  }
  float between(float a, float b) const { return (1 - share) * a + share * b; }
};

/// Indexed [cosine][roughness].
template <size_t size>
using Table = std::array<std::array<float, size>, size>;

template <size_t size>
float read(const Table<size>& table, const Place<size>& roughness, const Place<size>& cosine) {
  const auto row = [&](size_t i) { return roughness.between(table[i][roughness.low], table[i][roughness.high]); };
  return cosine.between(row(cosine.low), row(cosine.high));
}

struct White {
  Table<kEntries> albedo;
  std::array<float, kEntries> mean;

  White() {
    const Quadrature cosines = gauss_legendre(32, 0, 1);
    parallel_fill(kEntries, [&](size_t i) {
      const float roughness = at(i, kEntries);
      for (size_t k = 0; k < kEntries; ++k) albedo[k][i] = white_albedo(roughness, at(k, kEntries));
      double sum = 0;
      for (size_t k = 0; k < cosines.node.size(); ++k) {
        const double mu = cosines.node[k];
        sum += 2 * mu * cosines.weight[k] * static_cast<double>(white_albedo(roughness, static_cast<float>(mu)));
      }
      mean[i] = static_cast<float>(sum);
    });
  }
};

const White& white() {
  static const White table;
  return table;
}

/// mean_rise() for one index of refraction.
using Rises = Table<kRiseEntries>;

/// Fourth root of the reflectance at normal incidence: maps [1, infinity) to [0, 1), densest at common indices.
float place_of_index(float eta) { return std::sqrt(std::abs(eta - 1) / (eta + 1)); }

float index_at(size_t entry) {
  const float root = std::min(at(entry, kRiseEntries), 0.99f), sine = root * root;
  return (1 + sine) / (1 - sine);
}

float rise_at(float roughness, float cosine, float eta) {
  const float f0 = dielectric_fresnel(1.0f, eta);
  double sum = 0;
  for_visible_facets(view_of(cosine), Vec2(roughness * roughness), [&](double weight, float facet, float masking) {
    if (masking > 0) sum += weight * (dielectric_fresnel(facet, eta) - f0) / (1 - f0);
  });
  return std::clamp(static_cast<float>(sum), 0.0f, 1.0f);
}

const Rises& rises(size_t entry) {
  static std::array<std::once_flag, kRiseEntries> made;
  static std::array<Rises, kRiseEntries> tables;
  std::call_once(made[entry], [&] {
    const float eta = index_at(entry);
    parallel_fill(kRiseEntries, [&](size_t i) {
      for (size_t k = 0; k < kRiseEntries; ++k) {
        tables[entry][k][i] = rise_at(at(i, kRiseEntries), at(k, kRiseEntries), eta);
      }
    });
  });
  return tables[entry];
}

constexpr size_t kGlassRadii = 64, kGlassTurns = 64;  // total reflection by facets has an edge in the quadrature

/// Quadrature over visible normals, which lie symmetrically about the plane of incidence.
float glass_albedo(float roughness, float cosine, float eta) {
  static const Quadrature radii = gauss_legendre(kGlassRadii, 0, 1);
  const float alpha = roughness * roughness;
  const Vec3 wv = view_of(std::min(cosine, 0.999999f));  // its azimuth must be that of the plane
  const auto stretch = [alpha](float c) { return std::sqrt(1 + alpha * alpha * std::max(1 / (c * c) - 1, 0.0f)); };
  const float of_view = stretch(wv.z);
  const auto kept = [&](float c) { return (1 + of_view) / (of_view + stretch(std::max(c, 1e-6f))); };  // G2 / G1
  double sum = 0;
  for (size_t i = 0; i < kGlassRadii; ++i) {
    const auto radius = static_cast<float>(radii.node[i]);
    double ring = 0;
    for (size_t k = 0; k < kGlassTurns; ++k) {
      const float turn = 0.5f * (static_cast<float>(k) + 0.5f) / kGlassTurns - 0.25f;
      const Vec3 h = sample_ggx_visible_normal(wv, Vec2(alpha), {radius * radius, turn});
      const float facet = std::clamp(glm::dot(wv, h), 0.0f, 1.0f), reflected = dielectric_fresnel(facet, eta);
      const float inside_sq = eta * eta - 1 + facet * facet, up = 2 * facet * h.z - wv.z;
      if (up > 0) ring += static_cast<double>(reflected * kept(up));
      if (inside_sq <= 0) continue;
      const float down = std::abs(wv.z - (facet - std::sqrt(inside_sq)) * h.z) / eta;
      ring += static_cast<double>((1 - reflected) * kept(std::min(down, 1.0f)));
    }
    sum += 2 * radii.node[i] * radii.weight[i] * ring / kGlassTurns;
  }
  return std::clamp(static_cast<float>(sum), 0.01f, 1.0f);
}

/// Indexed by roughness, for one index of refraction.
struct Glass {
  Table<kRiseEntries> albedo;
  std::array<float, kRiseEntries> mean;

  void fill(float eta) {
    const Quadrature cosines = gauss_legendre(16, 0, 1);
    parallel_fill(kRiseEntries, [&](size_t i) {
      const float roughness = at(i, kRiseEntries);
      for (size_t k = 0; k < kRiseEntries; ++k) albedo[k][i] = glass_albedo(roughness, at(k, kRiseEntries), eta);
      double sum = 0;
      for (size_t k = 0; k < cosines.node.size(); ++k) {
        const double mu = cosines.node[k];
        sum += 2 * mu * cosines.weight[k] * static_cast<double>(glass_albedo(roughness, static_cast<float>(mu), eta));
      }
      mean[i] = static_cast<float>(sum);
    });
  }
};

const Glass& glass_tables(size_t entry, bool inside) {
  static std::array<std::once_flag, 2 * kRiseEntries> made;
  static std::array<Glass, 2 * kRiseEntries> tables;
  const size_t place = entry + (inside ? kRiseEntries : 0);
  std::call_once(made[place], [&] { tables[place].fill(inside ? 1 / index_at(entry) : index_at(entry)); });
  return tables[place];
}

}  // namespace

float ggx_albedo::of_white(float roughness, float cosine) {
  return read(white().albedo, Place<kEntries>(roughness), Place<kEntries>(cosine));
}

float ggx_albedo::mean_of_white(float roughness) {
  const Place<kEntries> place(roughness);
  return place.between(white().mean[place.low], white().mean[place.high]);
}

float ggx_albedo::mean_rise(float roughness, float cosine, float eta) {
  const Place<kRiseEntries> x(roughness), y(cosine), z(place_of_index(eta));
  return z.between(read(rises(z.low), x, y), read(rises(z.high), x, y));
}

float ggx_albedo::of_glass(float roughness, float cosine, float eta) {
  const Place<kRiseEntries> x(roughness), y(cosine), z(place_of_index(eta));
  const auto entry = [&](size_t i) { return read(glass_tables(i, eta < 1).albedo, x, y); };
  return z.between(entry(z.low), entry(z.high));
}

float ggx_albedo::mean_of_glass(float roughness, float eta) {
  const Place<kRiseEntries> x(roughness), z(place_of_index(eta));
  const auto entry = [&](size_t i) {
    const Glass& table = glass_tables(i, eta < 1);
    return x.between(table.mean[x.low], table.mean[x.high]);
  };
  return z.between(entry(z.low), entry(z.high));
}

namespace {

constexpr int kRadii = 24, kTurns = 24;
static_assert(kRadii * kTurns == VisibleFacets::kCount);

/// Points on the half of the disk of visible normals to one side of the plane of incidence; the other half is its
/// mirror image. Arrays let the compiler vectorize.
struct DiskPoints {
  static constexpr int kCount = VisibleFacets::kCount;
  float radius[kCount], sine[kCount];   // for p2 of Heitz 2018, Listing 1
  float along[kCount], beside[kCount];  // p1, and sqrt(1 - p1^2)
  double weight[kCount];

  DiskPoints() {
    const Quadrature radii = gauss_legendre(kRadii, 0, 1);
    for (int i = 0; i < kCount; ++i) {
      const auto ring = static_cast<size_t>(i / kTurns);
      const float turn = 0.5f * (static_cast<float>(i % kTurns) + 0.5f) / kTurns - 0.25f, phi = 2 * kPi * turn;
      radius[i] = static_cast<float>(radii.node[ring]);
      sine[i] = std::sin(phi);
      along[i] = radius[i] * std::cos(phi);
      beside[i] = std::sqrt(std::max(0.0f, 1 - along[i] * along[i]));
      weight[i] = 2 * radii.node[ring] * radii.weight[ring] / kTurns;
    }
  }
};

const DiskPoints& disk_points() {
  static const DiskPoints points;
  return points;
}

}  // namespace

/// Evaluates sample_ggx_visible_normal() at all points.
VisibleFacets::VisibleFacets(const Vec3& wv, const Vec2& alpha) {
  const DiskPoints& points = disk_points();
  const Vec3 stretched = glm::normalize(Vec3(alpha.x * wv.x, 0, wv.z));
  const float s = 0.5f * (1 + stretched.z), length_v = ggx_projected_length(wv, alpha);
  // The axes of the disk are y and, in the plane of incidence, (-stretched.z, 0, stretched.x), or x and y for a view
  // along the normal.
  const bool tilted = stretched.x > 0;
  const Vec3 t1 = tilted ? Vec3(0, 1, 0) : Vec3(1, 0, 0), t2 = glm::cross(stretched, t1);
  for (int i = 0; i < kCount; ++i) {
    const float p1 = points.along[i], p2 = (1 - s) * points.beside[i] + s * points.radius[i] * points.sine[i];
    const float up = std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
    const float x = alpha.x * (p1 * t1.x + p2 * t2.x + up * stretched.x);
    const float y = alpha.y * (p1 * t1.y + p2 * t2.y + up * stretched.y);
    const float z = std::max(0.0f, p1 * t1.z + p2 * t2.z + up * stretched.z);
    const float scale = 1 / std::sqrt(x * x + y * y + z * z);
    const float facing = std::min(wv.x * (x * scale) + wv.z * (z * scale), 1.0f);
    const float lx = 2 * facing * (x * scale) - wv.x, ly = 2 * facing * (y * scale);
    const float lz = 2 * facing * (z * scale) - wv.z;
    const float ax = alpha.x * lx, ay = alpha.y * ly;
    const float length_l = std::sqrt(lz * lz + ax * ax + ay * ay);
    const float kept = lz * (wv.z + length_v) / (lz * length_v + wv.z * length_l);
    cosine[i] = facing;
    masking[i] = facing > 0 && lz > 0 ? kept : 0.0f;
  }
}

const double* VisibleFacets::weights() { return disk_points().weight; }

}  // namespace velour
