// Radiance of the world as a program computes it: Blender's world nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>
#include "light/environment.h"
#include "material/program/program.h"
#include "math/sphere/directions.h"

namespace velour {

/// Rays that leave the scene, as sources tell them apart. Values of VLR_WORLD_RAYS_*.
enum class WorldRays : int { others = 0, camera = 1, shadow = 2 };

/// One color output of a program, as a function of the direction of a ray that leaves the scene. Immutable; copies
/// share the program.
///
/// Sources in a unit world direction d, as Cycles sets up its background: positions are d, normals and the incoming
/// direction -d, those of kinds of rays 0 or 1, others 0.
class WorldProgram {
 public:
  /// Throws Error(invalid_argument) unless `output` is a color of `program`.
  WorldProgram(std::shared_ptr<const Program> program, size_t output);

  /// Whether rays of one kind see the same color in all directions.
  bool even() const { return even_; }
  /// Radiance in each of the `count` directions of `world` for one kind of rays. Negative and non-finite channels are
  /// 0.
  void look_up(const DirectionBatch& world, WorldRays rays, RgbBatch& radiance) const;
  /// What WorldRays::others see: a color if even(), else an image of `width` x `height` texels, each computed at its
  /// center.
  Environment baked(int width, int height) const;

 private:
  std::shared_ptr<const Program> program_;  // only that output
  ProgramOutput output_;
  bool even_ = true;
};

}  // namespace velour
