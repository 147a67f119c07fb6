#include "material/program/operations.h"

#include "material/surface_site.h"

namespace velour {
namespace {

constexpr int32_t kMaxSet = static_cast<int32_t>(SurfaceSite::kMaxSets) - 1;
static_assert(SurfaceSite::kMaxColorSets == SurfaceSite::kMaxSets);
constexpr int32_t kMaxImages = 1023, kMaxFrequency = 1 << 20;

// Comments name inputs -> outputs; choices.
constexpr Signature kSignatures[kOperations] = {
    {"source", {}, 3, {kSources - 1, kMaxSet, 2}},  // -> value; Source, set, Shift
    {"image", {3}, 3, {kMaxImages}},                // place -> color or number; image
    {"math", {1, 1, 1}, 1, {40, 1}},                // a, b, c -> value; MathOperation, clamp
    {"vector_math", {3, 3, 3, 1}, 4, {29}},         // a, b, c, scale -> vector, value; VectorOperation
    {"mix_color", {1, 3, 3}, 3, {18, 1, 1}},        // factor, a, b -> color; BlendMode, clamp factor, clamp result
    {"mix_vector", {3, 3, 3}, 3, {1}},              // factor, a, b -> vector; clamp factor
    {"combine", {1, 1, 1}, 3, {2}},                 // components -> color; ColorModel
    {"separate", {3}, 3, {2}},                      // color -> components; ColorModel
    {"ramp", {1}, 4, {1}, 4, 8},                    // factor -> color, alpha; interpolate; table: RGBA
    {"curves", {1, 3, 1, 1}, 3, {1}, 3, 6},         // factor, color, first and last place -> color; extrapolate;
                                                    // table: RGB
    {"hue_saturation", {1, 1, 1, 1, 3}, 3},         // hue, saturation, value, factor, color -> color
    {"invert", {1, 3}, 3},                          // factor, color -> color
    {"gamma", {3, 1}, 3},                           // color, gamma -> color
    {"bright_contrast", {3, 1, 1}, 3},              // color, bright, contrast -> color
    {"clamp", {1, 1, 1}, 1, {1}},                   // value, min, max -> value; range: swaps min and max
    {"map_range", {1, 1, 1, 1, 1, 1}, 1, {3, 1}},   // value, from min, max, to min, max, steps -> value; RangeCurve,
                                                    // clamp
    {"mapping", {3, 3, 3, 3}, 3, {3}},              // vector, location, rotation, scale -> vector; MappingKind
    {"transform", {3}, 3, {}, 12, 12},              // point -> point; table: 3 x 4 matrix, row-major
    {"fresnel", {1, 3, 3, 1}, 1},                   // ior, normal, incoming, backfacing -> factor
    {"layer_weight", {1, 3, 3, 1}, 2},              // blend, normal, incoming, backfacing -> fresnel, facing
    // vector, w, scale, detail, roughness, lacunarity, offset, gain, distortion -> value, color; dimensions - 1,
    // NoiseKind, normalize, needs color
    {"noise", {3, 1, 1, 1, 1, 1, 1, 1, 1}, 4, {3, 4, 1, 1}},
    // vector, w, scale, detail, roughness, lacunarity, smoothness, exponent, randomness -> distance, color, position,
    // w, radius; dimensions - 1, VoronoiFeature, VoronoiMetric, flags: 1 normalize, 2 integer hash
    {"voronoi", {3, 1, 1, 1, 1, 1, 1, 1, 1}, 9, {3, 4, 3, 3}},
    // vector, scale, distortion, detail, detail scale, detail roughness, phase -> factor; WaveKind, WaveAxis, profile
    {"wave", {3, 1, 1, 1, 1, 1, 1}, 1, {1, 3, 2}},
    {"gradient", {3}, 1, {6}},     // vector -> factor; GradientKind
    {"checker", {3, 3, 3, 1}, 4},  // vector, color 1, color 2, scale -> factor, color
    // vector, color 1, color 2, mortar, scale, mortar size, smoothness, bias, width, height, offset, squash -> factor,
    // color; frequencies of offset and squash
    {"brick", {3, 3, 3, 3, 1, 1, 1, 1, 1, 1, 1, 1}, 4, {kMaxFrequency, kMaxFrequency}},
    {"magic", {3, 1, 1}, 4, {10, 1}},       // vector, scale, distortion -> factor, color; depth, scaled first
    {"white_noise", {3, 1}, 4, {3}},        // vector, w -> value, color; dimensions - 1
    {"normal_map", {3, 1, 3, 3, 3, 3}, 3},  // color, strength, tangent, bitangent, normal, otherwise -> unit normal
    // strength, distance, height at the point, and shifted by x and y, normal, step x, step y -> unit normal
    {"bump", {1, 1, 1, 1, 1, 3, 3, 3}, 3},
    {"mix_number", {1, 1, 1}, 1, {1}},                    // factor, a, b -> value; clamp factor
    {"map_range_vector", {3, 3, 3, 3, 3, 3}, 3, {3, 1}},  // as map_range
};

}  // namespace

const Signature& signature(Operation operation) { return kSignatures[static_cast<int>(operation)]; }

}  // namespace velour
