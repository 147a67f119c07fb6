// What an instruction of a program does, and the registers that it reads and writes.
#pragma once

#include <array>
#include <cstdint>

namespace velour {

// Values of velour.h; append only. Each follows Blender's node of the same name; intern/cycles/kernel/svm of the Cycles
// renderer describes the formulas.

enum class Operation : int {
  source = 0,
  image = 1,
  math = 2,
  vector_math = 3,
  mix_color = 4,
  mix_vector = 5,
  combine = 6,
  separate = 7,
  ramp = 8,
  curves = 9,
  hue_saturation = 10,
  invert = 11,
  gamma = 12,
  bright_contrast = 13,
  clamp = 14,
  map_range = 15,
  mapping = 16,
  transform = 17,
  fresnel = 18,
  layer_weight = 19,
  noise = 20,
  voronoi = 21,
  wave = 22,
  gradient = 23,
  checker = 24,
  brick = 25,
  magic = 26,
  white_noise = 27,
  normal_map = 28,
  bump = 29,
  mix_number = 30,
  map_range_vector = 31,
};
inline constexpr int kOperations = 32;

/// Properties of the surface at a point.
enum class Source : int {
  uv = 0,                // coordinates of set `choice 1`, and 0
  corner = 1,            // corner colors of set `choice 1`
  position = 2,          // world space, meters
  object_position = 3,   // object space
  normal = 4,            // shading normal towards the viewer, unit, world space
  object_normal = 5,     // the same, object space
  geometric_normal = 6,  // true normal towards the viewer, unit, world space
  incoming = 7,          // unit direction towards the viewer, world space
  backfacing = 8,        // 1 where the viewer is behind the mesh's normal
  map_tangent = 9,       // axes of a tangent-space normal map, world space, on the viewer's side, not normalized
  map_bitangent = 10,
  map_normal = 11,
  step_x = 12,  // the offset of shifted points, world space, meters
  step_y = 13,
  camera_ray = 14,  // 1 for rays from the camera
  shadow_ray = 15,  // 1 for rays between a surface and a light
};
inline constexpr int kSources = 16;

/// Points at which a source is read: the point itself, or one a pixel's width beside it, for bump.
enum class Shift : int { none = 0, x = 1, y = 2 };

enum class MathOperation : int {
  add,
  subtract,
  multiply,
  divide,
  multiply_add,
  power,
  logarithm,
  sqrt,
  inverse_sqrt,
  absolute,
  exponent,
  minimum,
  maximum,
  less_than,
  greater_than,
  sign,
  compare,
  smooth_min,
  smooth_max,
  round,
  floor,
  ceil,
  trunc,
  fract,
  modulo,
  floored_modulo,
  wrap,
  snap,
  pingpong,
  sine,
  cosine,
  tangent,
  arcsine,
  arccosine,
  arctangent,
  arctan2,
  sinh,
  cosh,
  tanh,
  radians,
  degrees
};
enum class VectorOperation : int {
  add,
  subtract,
  multiply,
  divide,
  multiply_add,
  cross_product,
  project,
  reflect,
  refract,
  faceforward,
  dot_product,
  distance,
  length,
  scale,
  normalize,
  absolute,
  minimum,
  maximum,
  floor,
  ceil,
  fraction,
  modulo,
  wrap,
  snap,
  sine,
  cosine,
  tangent,
  power,
  sign,
  round
};
enum class BlendMode : int {
  mix,
  darken,
  multiply,
  burn,
  lighten,
  screen,
  dodge,
  add,
  overlay,
  soft_light,
  linear_light,
  difference,
  exclusion,
  subtract,
  divide,
  hue,
  saturation,
  color,
  value
};
enum class ColorModel : int { rgb, hsv, hsl };
enum class RangeCurve : int { linear, stepped, smoothstep, smootherstep };
enum class MappingKind : int { point, texture, vector, normal };
enum class NoiseKind : int { fbm, multifractal, hybrid_multifractal, ridged_multifractal, hetero_terrain };
enum class VoronoiFeature : int { f1, f2, smooth_f1, distance_to_edge, n_sphere_radius };
enum class VoronoiMetric : int { euclidean, manhattan, chebychev, minkowski };
enum class WaveKind : int { bands, rings };
enum class WaveAxis : int { x, y, z, whole };  // whole: diagonal bands, spherical rings
enum class WaveProfile : int { sin, saw, tri };
enum class GradientKind : int { linear, quadratic, easing, diagonal, spherical, quadratic_sphere, radial };

/// One step of a program. A value is one register, a vector or color three consecutive ones; an operand names the
/// first.
struct Instruction {
  static constexpr int kMaxInputs = 12, kChoices = 4;

  Operation operation{};
  std::array<int32_t, kChoices> choice{};    // enumerators, flags and integers; Signature::last_choice bounds them
  std::array<uint32_t, kMaxInputs> input{};  // first registers
  uint32_t output = 0;                       // first register of all outputs
  uint32_t table = 0, table_size = 0;        // range of the program's tables
};

/// Registers of an operation's operands, in order.
struct Signature {
  const char* name;
  std::array<uint8_t, Instruction::kMaxInputs> inputs;       // registers of each; 0: there are no more
  uint8_t outputs;                                           // registers of all outputs
  std::array<int32_t, Instruction::kChoices> last_choice{};  // highest value of each choice
  /// Floats of a table: a multiple of this, at least `least_table`; 0: no table.
  uint8_t table_row = 0, least_table = 0;
};

const Signature& signature(Operation operation);

}  // namespace velour
