// Directions sampled from the surface at a vertex, and their density.
#pragma once

#include "material/material.h"
#include "render/options.h"
#include "render/vertex.h"

namespace velour {

/// How directions are sampled from the surface.
enum class SurfaceSampling { uniform, cosine, table, ggx, material };

/// For `light`, which samples no direct light from the surface, this applies to the continuation ray: light reflected
/// by other surfaces comes from directions that light sampling would never choose.
SurfaceSampling surface_sampling(Strategy strategy);

/// Prepares what `sampling` derives from the view, once per vertex; Material::prepare has its own data.
void prepare_surface(SurfaceSampling sampling, const Vertex& vertex, PreparedBrdf& prepared);

/// Local directions, one for each of up to 64 `u`; they may lie below the horizon. The batch is not padded.
void sample_surface(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared,
                    std::span<const Vec2> u, DirectionBatch& wl);

/// Density per solid angle of sample_surface at each direction of `wl`. `material_pdf`: result of Material::eval.
void surface_pdf(SurfaceSampling sampling, const Vertex& vertex, const PreparedBrdf& prepared, const DirectionBatch& wl,
                 const ScalarBatch& material_pdf, ScalarBatch& pdf);

}  // namespace velour
