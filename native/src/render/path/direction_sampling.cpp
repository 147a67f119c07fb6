#include "render/path/direction_sampling.h"

#include <cmath>
#include <limits>

#include "material/normal_map.h"
#include "math/sphere/frame.h"
#include "math/sphere/warp.h"

namespace velour {

SurfaceSampling surface_sampling(Strategy strategy) {
  switch (strategy) {
    case Strategy::uniform:
      return SurfaceSampling::uniform;
    case Strategy::cosine:
      return SurfaceSampling::cosine;
    case Strategy::table:
      return SurfaceSampling::table;
    case Strategy::ggx:
    case Strategy::mis_ggx:
      return SurfaceSampling::ggx;
    case Strategy::srbf:
    case Strategy::light:
    case Strategy::mis:
    case Strategy::product:
    case Strategy::dissertation:
    case Strategy::mis_dissertation:
    case Strategy::automatic:
      break;
  }
  return SurfaceSampling::material;
}

namespace {

constexpr float kBeyond = 0.5f;  // share of samples on the far side, for one-sided densities of transmissive materials

}  // namespace

PreparedSurface::PreparedSurface(SurfaceSampling sampling, const Vertex& vertex, const PrepareOptions& options,
                                 ScratchArena& arena)
    : brdf_(vertex.material->prepare(vertex.wv, vertex.site, options, arena)),
      sampling_(sampling),
      transmits_(vertex.transmits),
      ggx_(vertex.ggx) {
  if (sampling == SurfaceSampling::ggx) ggx_->prepare(above_horizon(vertex.wv), ggx_point_);
  if (sampling == SurfaceSampling::table) vertex.table->prepare(above_horizon(vertex.wv), table_);
}

void PreparedSurface::sample_one_side(std::span<const Vec2> u, DirectionBatch& wl) const {
  switch (sampling_) {
    case SurfaceSampling::uniform:
      return wl.fill(u, sample_uniform_hemisphere);
    case SurfaceSampling::cosine:
      return wl.fill(u, sample_cosine_hemisphere);
    case SurfaceSampling::table:
      return TableSampler::sample(table_, u, wl);
    case SurfaceSampling::ggx:
      return wl.fill(u, [&](const Vec2& v) { return ggx_->sample(ggx_point_, v); });
    case SurfaceSampling::material:
      return brdf_->sample(u, wl);
  }
}

void PreparedSurface::pdf_of_one_side(const DirectionBatch& wl, const ScalarBatch& brdf_pdf, ScalarBatch& pdf) const {
  switch (sampling_) {
    case SurfaceSampling::uniform:
      for (int i = 0; i < wl.count; ++i) pdf.v[i] = pdf_uniform_hemisphere(wl.get(i));
      return;
    case SurfaceSampling::cosine:
      for (int i = 0; i < wl.count; ++i) pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
      return;
    case SurfaceSampling::table:
      return TableSampler::pdf(table_, wl, pdf);
    case SurfaceSampling::ggx:
      ggx_->pdf(ggx_point_, wl, pdf);
      return;
    case SurfaceSampling::material:
      pdf = brdf_pdf;
      return;
  }
}

void PreparedSurface::sample(std::span<const Vec2> u, DirectionBatch& wl) const {
  if (!shares_sides()) return sample_one_side(u, wl);
  sample_sides(u, kBeyond, wl,
               [&](bool, std::span<const Vec2> some, DirectionBatch& drawn) { sample_one_side(some, drawn); });
}

void PreparedSurface::pdf(const DirectionBatch& wl, const ScalarBatch& brdf_pdf, ScalarBatch& pdf) const {
  pdf_of_one_side(wl, brdf_pdf, pdf);
  if (!shares_sides()) return;
  DirectionBatch beyond = wl;
  for (int i = 0; i < wl.count; ++i) beyond.z[i] = -wl.z[i];
  ScalarBatch other;
  pdf_of_one_side(beyond, brdf_pdf, other);
  for (int i = 0; i < wl.count; ++i) pdf.v[i] = (1 - kBeyond) * pdf.v[i] + kBeyond * other.v[i];
}

std::optional<Continuation> continuation_along(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world,
                                               const Rgb& reflected, float pdf) {
  if (!vertex.receives(wl, wl_world) || reflected == Rgb(0.0f)) return std::nullopt;
  return Continuation{vertex.ray(wl_world, std::numeric_limits<float>::infinity()), reflected * (std::abs(wl.z) / pdf),
                      wl, pdf};
}

std::optional<Continuation> sample_continuation(const Vertex& vertex, const PreparedSurface& prepared,
                                                const std::optional<Mat3>& rec709_to_working, const Rgb& throughput,
                                                const Vec2& u) {
  DirectionBatch wl;
  prepared.sample({&u, 1}, wl);
  wl.pad();
  const Vec3 wl_world = vertex.frame.to_world(wl.get(0));
  if (!vertex.receives(wl.get(0), wl_world)) return std::nullopt;
  RgbBatch f;
  ScalarBatch material_pdf, pdf;
  prepared.brdf().eval(wl, f, material_pdf);
  prepared.pdf(wl, material_pdf, pdf);
  const Rgb reflected = throughput * in_working_space(rec709_to_working, vertex, f.get(0));
  return continuation_along(vertex, wl.get(0), wl_world, reflected, pdf.v[0]);
}

}  // namespace velour
