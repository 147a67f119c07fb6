#include "render/direction_sampling.h"

#include "material/ggx_sampler.h"
#include "material/table_sampler.h"
#include "sphere/warp.h"

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
      break;
  }
  return SurfaceSampling::material;
}

void prepare_surface(SurfaceSampling sampling, const Vertex& vertex, PreparedBrdf& prepared) {
  if (sampling == SurfaceSampling::ggx) vertex.ggx->prepare(vertex.wv, prepared.ggx);
}

void sample_surface(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared,
                    std::span<const Vec2> u, DirectionBatch& wl) {
  switch (sampling) {
    case SurfaceSampling::uniform:
      return wl.fill(u, sample_uniform_hemisphere);
    case SurfaceSampling::cosine:
      return wl.fill(u, sample_cosine_hemisphere);
    case SurfaceSampling::table:
      return wl.fill(u, [&](const Vec2& v) { return vertex.table->sample(vertex.wv, v); });
    case SurfaceSampling::ggx:
      return wl.fill(u, [&](const Vec2& v) { return vertex.ggx->sample(prepared.ggx, v); });
    case SurfaceSampling::material:
      return vertex.surface->material->sample(prepared, u, wl);
  }
}

void surface_pdf(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared, const DirectionBatch& wl,
                 const ScalarBatch& material_pdf, ScalarBatch& pdf) {
  switch (sampling) {
    case SurfaceSampling::uniform:
      for (int i = 0; i < wl.count; ++i) pdf.v[i] = pdf_uniform_hemisphere(wl.get(i));
      return;
    case SurfaceSampling::cosine:
      for (int i = 0; i < wl.count; ++i) pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
      return;
    case SurfaceSampling::table:
      vertex.table->pdf(vertex.wv, wl, pdf);
      return;
    case SurfaceSampling::ggx:
      vertex.ggx->pdf(prepared.ggx, wl, pdf);
      return;
    case SurfaceSampling::material:
      pdf = material_pdf;
      return;
  }
}

}  // namespace velour
