// What rough surfaces of GGX microfacets reflect of all light from one side: tables that every such material shares.
#pragma once

namespace velour {

/// Reflected energy by roughness (alpha = roughness^2) and cosine of the view. The tables are as coarse as those of
/// Blender since 4.0, and linear between entries, so that what lies under a layer gets the light that it gets in
/// Blender; a hit takes no integral. Arguments are clamped to [0, 1]. Thread-safe; made at the first use, the
/// reflectances an index at a time.
namespace ggx_albedo {

/// Albedo of the lobe whose facets reflect all light, in (0, 1]: the rest is lost between facets.
float of_white(float roughness, float cosine);
/// Its mean over a hemisphere of light, 2 int albedo(mu) mu dmu.
float mean_of_white(float roughness);

/// How far a dielectric's reflectance is from its value at normal incidence towards 1, in the mean over the facets that
/// the view sees. `eta` >= 1.
float mean_rise(float roughness, float cosine, float eta);

}  // namespace ggx_albedo
}  // namespace velour
