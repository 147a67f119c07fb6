// Procedural tiles: one period of a small structure that repeats endlessly in x and y.
//
// Lengths are in meters. The cell is [0, period.x) x [0, period.y), +z is up. A part that crosses the border of the
// cell exists once, whole, and sticks out: a part that begins at one border ends one period further on, a ring or a
// pebble belongs to the cell of its center. Copies repeated by the period neither overlap nor leave a seam.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "material/principled/principled_material.h"
#include "math/sphere/vec.h"

namespace velour {

/// Shape parameters of a tile. The pitch, size / count, is the distance between neighboring yarns, cords, rings or
/// wales, or about that between pebbles; `thickness` and `gap` are in pitches.
struct TileShape {
  double size = 0;          // side of the cell, meters
  int count = 0;            // pitches along a side
  int resolution = 0;       // points around a yarn, wire, pebble or rib; even
  double thickness = 0;     // height of a yarn, cord or rib; diameter of a wire; depth of a bed of gravel
  double gap = 0;           // between neighboring yarns, cords or ribs; 0 for kinds of tile without gaps
  double irregularity = 0;  // 0..1: how far parts locally shrink from their ideal shape; they never grow
  uint64_t seed = 0;        // for the irregularity and the positions of pebbles

  double pitch() const { return size / count; }
};

/// A partly specified shape; the rest has the defaults of the kind.
struct TileOptions {
  std::string kind = "weave";
  std::optional<double> size{}, thickness{}, gap{}, irregularity{};
  std::optional<int> count{}, resolution{};
  uint64_t seed = 0;
};

/// Triangles, counter-clockwise seen from outside.
struct TileMesh {
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<Vec3> corner_normals;  // 3 per triangle: unit, smooth, and equal on both sides of a border
  // 3 per triangle. On yarns, u runs from 0 to 1 over the period and v once around; on rings, both run once around; on
  // pebbles they are longitude and latitude; on sheets, x and y over the period.
  std::vector<Vec2> corner_uvs;
  std::vector<uint32_t> slots;  // 1 per triangle
};

struct TileMaterial {
  std::string name;
  PrincipledParameters parameters;
};

/// Geometry and materials that a kind of tile makes of a shape.
struct TileParts {
  TileMesh mesh;
  std::vector<TileMaterial> materials;  // by slot
  bool open = false;                    // some vertical lines hit nothing
  std::optional<double> open_area{};    // exact share of such lines; empty: not known in closed form
};

struct Tile {
  std::string kind;
  TileShape shape;
  Vec2 period{0, 0};
  TileParts parts;
};

/// A kind of tile, with the limits that make_tile() checks.
struct TileKind {
  const char* name;
  const char* summary;
  TileShape defaults;
  int multiple;      // `count` must be a multiple of this
  double least_gap;  // 0: the kind has no gap
  double largest_thickness;
  bool has_irregularity;
  TileParts (*make)(const TileShape& shape);
};
/// In display order.
std::span<const TileKind> tile_kinds();

/// Deterministic. Throws Error(invalid_argument) naming the value that is out of range and its range.
Tile make_tile(const TileOptions& options);

}  // namespace velour
