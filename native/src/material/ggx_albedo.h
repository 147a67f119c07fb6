// Tables of the albedo of rough GGX surfaces, shared by all materials.
#pragma once

namespace velour {

/// Reflected energy over roughness (alpha = roughness^2) and view cosine, so that no hit computes an integral. The
/// tables have the resolution and the linear interpolation of Blender 4.0 and newer, so that a layer passes as much
/// light to the ones below as in Blender. Arguments are clamped to [0, 1]. Thread-safe; built at first use, the
/// mean_rise() tables one index at a time.
namespace ggx_albedo {

/// Albedo of the lobe with perfectly reflecting facets, in (0, 1]: the remainder is lost between facets.
float of_white(float roughness, float cosine);
/// Cosine-weighted mean of of_white() over the hemisphere, 2 int albedo(mu) mu dmu.
float mean_of_white(float roughness);

/// Mean over visible facets of (F - F0) / (1 - F0) of a dielectric: how far its reflectance rises from the value at
/// normal incidence towards 1. `eta` >= 1.
float mean_rise(float roughness, float cosine, float eta);

}  // namespace ggx_albedo
}  // namespace velour
