// Procedural tiles: one period of a small structure, to be repeated without end in x and y.
//
// Lengths are metres. The cell is [0, period.x) x [0, period.y), +z is up. Whatever crosses the cell's border is there
// once, whole, and sticks out: a part that begins at one border ends a period further on, a ring or a pebble lies where
// its centre lies. Repeated by the period the copies neither overlap nor leave a seam.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "material/principled_point.h"
#include "sphere/vec.h"

namespace velour {

/// What decides a tile's shape. The pitch, size / count, is the distance of neighbours: of yarns, cords, rings, wales,
/// or about that of pebbles; `thickness` and `gap` are given in pitches.
struct TileShape {
  double size = 0;          // side of the cell, metres
  int count = 0;            // of pitches along a side
  int resolution = 0;       // points around a yarn, wire, pebble or rib; even
  double thickness = 0;     // height of a yarn, cord or rib, diameter of a wire; of gravel: depth of the bed
  double gap = 0;           // between neighbouring yarns, cords or ribs; 0 where the kind of tile has none
  double irregularity = 0;  // 0..1: how far things shrink, here and there, from their ideal shape; they never grow
  uint64_t seed = 0;        // of that, and of where pebbles lie

  double pitch() const { return size / count; }
};

/// A shape of which some is said; the rest is the kind's own.
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
  std::vector<Vec3> corner_normals;  // 3 a triangle: unit, smooth, and the same on both sides of a border
  // 3 a triangle. Along a yarn u goes from 0 to 1 over the period and v once around it; on a ring once around each way;
  // on a pebble they are longitude and latitude; on a sheet x and y over the period.
  std::vector<Vec2> corner_uvs;
  std::vector<uint32_t> slots;  // 1 a triangle
};

struct TileMaterial {
  std::string name;
  PrincipledParameters parameters;
};

/// What a kind of tile makes of a shape.
struct TileParts {
  TileMesh mesh;
  std::vector<TileMaterial> materials;  // of the slots
  bool open = false;                    // some vertical line meets nothing
  std::optional<double> open_area{};    // share of such lines, exact; none: not known in closed form
};

struct Tile {
  std::string kind;
  TileShape shape;
  Vec2 period{0, 0};
  TileParts parts;
};

/// Its numbers bound what make_tile takes.
struct TileKind {
  const char* name;
  const char* summary;
  TileShape defaults;
  int multiple;      // `count` is a multiple of this
  double least_gap;  // 0: the kind has no gap
  double largest_thickness;
  bool has_irregularity;
  TileParts (*make)(const TileShape& shape);
};
/// In the order in which they are shown.
std::span<const TileKind> tile_kinds();

/// Deterministic. Throws Error(invalid_argument) with the name and the range of what is out of it.
Tile make_tile(const TileOptions& options);

}  // namespace velour
