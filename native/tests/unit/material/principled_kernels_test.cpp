// Both formulas of the Principled material on every instruction set, against the same in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "material/microfacet/ggx.h"
#include "material/principled/principled_material.h"
#include "math/sphere/directions.h"
#include "support/simd_targets.h"

namespace velour::principled_kernels_test {
namespace {

constexpr PrincipledFormula kDisney = PrincipledFormula::disney;
const PrincipledParameters kMaterials[] = {
    {},
    {.base_color = {0.9f, 0.2f, 0.05f}, .metallic = 1, .roughness = 0.2f, .specular_tint = {0.3f, 1, 0.6f}},
    {.metallic = 0.4f, .roughness = 0.05f, .specular = 0.9f, .coat = 0.7f, .coat_roughness = 0.1f},
    {.base_color = Rgb(0), .specular = 0, .coat = 1, .coat_roughness = 0.2f},
    {.specular_tint = {1.6f, 0.4f, 0},
     .coat = 0.8f,
     .coat_roughness = 0.5f,
     .coat_index = 2,
     .coat_tint = {0.9f, 0.2f, 0.6f}},
    {.metallic = 0.2f, .coat = 0.6f, .coat_roughness = 0.4f, .coat_lobe = GgxLobe::single},
    {.base_color = {0.9f, 0.2f, 0.05f}, .metallic = 0.5f, .roughness = 0.8f, .lobe = GgxLobe::single},
    {.base_color = {0.9f, 0.2f, 0.05f}, .roughness = 0.8f, .formula = kDisney, .lobe = GgxLobe::separable},
    {.base_color = {0.1f, 0.7f, 0.5f}, .metallic = 0.3f, .specular = 1, .formula = kDisney, .lobe = GgxLobe::single},
};

/// All around, more than fill vectors, and not a multiple of them.
DirectionBatch directions() {
  DirectionBatch batch;
  for (const Vec3& d : sphere_fibonacci(53)) batch.push(d);
  batch.pad();
  return batch;
}

double fresnel(double cosine, double eta) {
  if (eta <= 1) return 0;
  const double inside = std::sqrt(eta * eta - 1 + cosine * cosine);
  const double parallel = (eta * eta * cosine - inside) / (eta * eta * cosine + inside);
  const double perpendicular = (cosine - inside) / (cosine + inside);
  return (parallel * parallel + perpendicular * perpendicular) / 2;
}

double lobe(GgxLobe kind, double roughness, const Vec3d& wv, const Vec3d& wl) {
  const Vec3d h = glm::normalize(wv + wl);
  const double square = std::pow(roughness, 4), bottom = 1 + (square - 1) * h.z * h.z;
  const auto lambda = [&](double z) { return (std::sqrt(1 + square * (1 / (z * z) - 1)) - 1) / 2; };
  const double masked = kind == GgxLobe::separable ? 1 / ((1 + lambda(wv.z)) * (1 + lambda(wl.z)))
                                                   : 1 / (1 + lambda(wv.z) + lambda(wl.z));
  return square / (kPiD * bottom * bottom) * masked / (4 * wv.z * wl.z);
}

/// 1, and what light has that facets send to each other [KC17].
double gain(GgxLobe lobe, float roughness, double z, double mean) {
  if (lobe != GgxLobe::whole) return 1;
  const double albedo = ggx_albedo::of_white(roughness, static_cast<float>(z));
  const double average = ggx_albedo::mean_of_white(roughness);
  return 1 + mean * average / (1 - mean * (1 - average)) * (1 - albedo) / albedo;
}

double rise_at(double roughness, double z, double eta) {
  return ggx_albedo::mean_rise(static_cast<float>(roughness), static_cast<float>(z), static_cast<float>(eta));
}

Vec3d layered(const PrincipledParameters& p, const Vec3d& wv, const Vec3d& wl) {
  const double cosine = glm::dot(wv, glm::normalize(wv + wl));
  const double root = std::sqrt(0.08 * static_cast<double>(p.specular)), eta = (1 + root) / (1 - root);
  const double f0 = fresnel(1, eta), rise = (fresnel(cosine, eta) - f0) / (1 - f0), share = std::pow(1 - cosine, 5);
  const double coat_eta = p.coat_index, coat_f0 = fresnel(1, coat_eta), coat = p.coat, metallic = p.metallic;
  const double coat_rise = coat > 0 ? rise_at(p.coat_roughness, wv.z, coat_eta) : 0;
  const double coat_gain = gain(p.coat_lobe, p.coat_roughness, wv.z, (coat_eta - 1) / (4.08567 + 1.00071 * coat_eta));
  const double coat_white = ggx_albedo::of_white(p.coat_roughness, static_cast<float>(wv.z));
  const double coat_albedo = p.coat_lobe == GgxLobe::whole
                                 ? coat_gain * coat_white * (coat_f0 + (1 - coat_f0) * coat_rise)
                                 : fresnel(wv.z, coat_eta);
  const double unreflected = 1 - coat * coat_albedo;
  const double refracted = std::sqrt(1 - (1 - wv.z * wv.z) / (coat_eta * coat_eta));
  Vec3d through;
  for (int c = 0; c < 3; ++c) {
    through[c] = unreflected * (1 - coat + coat * std::pow(static_cast<double>(p.coat_tint[c]), 1 / refracted));
  }
  const double mean_rise = ((eta - 1) / (4.08567 + 1.00071 * eta) - f0) / (1 - f0);
  const double albedo = p.lobe == GgxLobe::whole ? ggx_albedo::of_white(p.roughness, static_cast<float>(wv.z)) : 1;
  Vec3d dielectric, metal;
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    const double base = p.base_color[c], tint = p.specular_tint[c], normal = f0 * tint;
    const double of_facets = gain(p.lobe, p.roughness, wv.z, normal + (1 - normal) * mean_rise);
    dielectric[c] = eta > 1 ? of_facets * (normal + (1 - normal) * rise) : 0;
    const double passed = eta > 1 ? of_facets * albedo * (normal + (1 - normal) * rise_at(p.roughness, wv.z, eta)) : 0;
    most = std::max(most, passed);
    const double at_82 = base + (1 - base) * std::pow(6 / 7.0, 5),
                 depth = at_82 * (1 - tint) * 7 * std::pow(7 / 6.0, 6);
    const double f = base + (1 - base) * share - depth * cosine * share * (1 - cosine);
    metal[c] = gain(p.lobe, p.roughness, wv.z, base + (1 - base) / 21 - depth / 126) * std::max(f, 0.0);
  }
  return through * (metallic * metal + (1 - metallic) * dielectric) * lobe(p.lobe, p.roughness, wv, wl) +
         Vec3d(p.base_color) * through * (1 - metallic) * (1 - most) / kPiD +
         (coat > 0 ? coat * coat_gain * fresnel(cosine, coat_eta) * lobe(GgxLobe::single, p.coat_roughness, wv, wl)
                   : 0.0);
}

Vec3d disney(const PrincipledParameters& p, const Vec3d& wv, const Vec3d& wl) {
  const double cosine = glm::dot(wv, glm::normalize(wv + wl)), metallic = p.metallic, roughness = p.roughness;
  const double normal = 0.08 * static_cast<double>(p.specular), eta = 2 / (1 - std::sqrt(normal)) - 1;
  const double rise = (fresnel(cosine, eta) - fresnel(1, eta)) / (1 - fresnel(1, eta));
  const double light = std::pow(1 - wl.z, 5), view = std::pow(1 - wv.z, 5);
  const double retro = 2 * roughness * cosine * cosine;
  const double base = (1 - light / 2) * (1 - view / 2) + retro * (light + view + light * view * (retro - 1));
  const Vec3d color(p.base_color), at_normal = normal * (1 - metallic) + metallic * color;
  return (1 - metallic) * base / kPiD * color + (at_normal * (1 - rise) + rise) * lobe(p.lobe, roughness, wv, wl);
}

TEST(PrincipledKernels, AreTheFormulaOnEveryTarget) {
  const DirectionBatch batch = directions();
  for (const PrincipledParameters& p : kMaterials) {
    const auto material = make_principled_material(p);
    for (const Vec3& wv : hemisphere_fibonacci(12)) {
      ScratchArena arena;
      const PreparedBrdf* const point = material->prepare(wv, arena);
      std::optional<RgbBatch> first;
      std::optional<ScalarBatch> density;
      test::on_every_simd_target([&] {
        RgbBatch f;
        ScalarBatch pdf;
        point->eval(batch, f, pdf);
        for (int i = 0; i < batch.count; ++i) {
          const Vec3d l(batch.get(i)), v(wv);
          const Vec3d expected = l.z <= 0 ? Vec3d(0) : p.formula == kDisney ? disney(p, v, l) : layered(p, v, l);
          EXPECT_LT(glm::distance(Vec3d(f.get(i)), expected), 1e-4 * (1e-3 + glm::length(expected)))
              << &p - kMaterials << ' ' << i;
          EXPECT_EQ(f.get(i), first.value_or(f).get(i)) << i;
          EXPECT_EQ(pdf.v[i], density.value_or(pdf).v[i]) << i;
        }
        first = f;
        density = pdf;
      });
    }
  }
}

}  // namespace
}  // namespace velour::principled_kernels_test
