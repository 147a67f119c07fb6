#include "render/direction_sampling.h"

#include "brdf/eval/table_sampler.h"
#include "material/microfacet/ggx_sampler.h"
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
      break;
  }
  return SurfaceSampling::material;
}

void prepare_surface(SurfaceSampling sampling, const Vertex& vertex, PreparedBrdf& prepared) {
  if (sampling == SurfaceSampling::ggx) vertex.ggx->prepare(vertex.wv, prepared.ggx);
  if (sampling == SurfaceSampling::table) vertex.table->prepare(vertex.wv, prepared.table);
}

namespace {

constexpr float kBeyond = 0.5f;  // share of samples on the far side, for one-sided densities of transmissive materials

void sample_one_side(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared,
                     std::span<const Vec2> u, DirectionBatch& wl) {
  switch (sampling) {
    case SurfaceSampling::uniform:
      return wl.fill(u, sample_uniform_hemisphere);
    case SurfaceSampling::cosine:
      return wl.fill(u, sample_cosine_hemisphere);
    case SurfaceSampling::table:
      return TableSampler::sample(prepared.table, u, wl);
    case SurfaceSampling::ggx:
      return wl.fill(u, [&](const Vec2& v) { return vertex.ggx->sample(prepared.ggx, v); });
    case SurfaceSampling::material:
      return vertex.surface->material->sample(prepared, u, wl);
  }
}

void pdf_of_one_side(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared,
                     const DirectionBatch& wl, const ScalarBatch& material_pdf, ScalarBatch& pdf) {
  switch (sampling) {
    case SurfaceSampling::uniform:
      for (int i = 0; i < wl.count; ++i) pdf.v[i] = pdf_uniform_hemisphere(wl.get(i));
      return;
    case SurfaceSampling::cosine:
      for (int i = 0; i < wl.count; ++i) pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
      return;
    case SurfaceSampling::table:
      return TableSampler::pdf(prepared.table, wl, pdf);
    case SurfaceSampling::ggx:
      vertex.ggx->pdf(prepared.ggx, wl, pdf);
      return;
    case SurfaceSampling::material:
      pdf = material_pdf;
      return;
  }
}

}  // namespace

void sample_surface(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared,
                    std::span<const Vec2> u, DirectionBatch& wl) {
  if (!vertex.transmits || sampling == SurfaceSampling::material) {
    return sample_one_side(sampling, vertex, prepared, u, wl);
  }
  sample_sides(u, kBeyond, wl, [&](bool, std::span<const Vec2> some, DirectionBatch& drawn) {
    sample_one_side(sampling, vertex, prepared, some, drawn);
  });
}

void surface_pdf(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared, const DirectionBatch& wl,
                 const ScalarBatch& material_pdf, ScalarBatch& pdf) {
  pdf_of_one_side(sampling, vertex, prepared, wl, material_pdf, pdf);
  if (!vertex.transmits || sampling == SurfaceSampling::material) return;
  DirectionBatch beyond = wl;
  for (int i = 0; i < wl.count; ++i) beyond.z[i] = -wl.z[i];
  ScalarBatch other;
  pdf_of_one_side(sampling, vertex, prepared, beyond, material_pdf, other);
  for (int i = 0; i < wl.count; ++i) pdf.v[i] = (1 - kBeyond) * pdf.v[i] + kBeyond * other.v[i];
}

}  // namespace velour
