// Sets of directions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// `n` directions of equal solid angle 2 pi / n on the upper hemisphere (spherical Fibonacci lattice, cell centers).
std::vector<Vec3> hemisphere_fibonacci(int n);

/// `n` directions of equal solid angle 4 pi / n on the whole sphere.
std::vector<Vec3> sphere_fibonacci(int n);

/// Indices of the `k` directions of `set` with the largest dot product with `d`, nearest first; ties by lower index.
/// Writes min(k, set.size()) indices and returns how many.
int nearest_directions(std::span<const Vec3> set, const Vec3& d, int k, int* indices);
/// Considers only the directions of `set` whose indices are in `among`, which is ascending.
int nearest_directions(std::span<const Vec3> set, std::span<const uint32_t> among, const Vec3& d, int k, int* indices);

}  // namespace velour
