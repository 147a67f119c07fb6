// Vectorized look-ups and ray marching in a shell.
#pragma once

#include <span>

#include "votf/eval/shell_trace.h"

namespace velour {

/// ShellField::distance at each of `places`.
void shell_distances(const ShellTable& table, std::span<const Vec3> places, float* distance);

/// trace_shells() for at most kWaysTogether ways.
inline constexpr size_t kWaysTogether = 256;
void march_shells(const ShellTable& table, std::span<const ShellWay> ways, ShellHit* hits);

/// Implementation of ShellRay::at.
Vec3 place_on_ray(const ShellRay& ray, float s);

}  // namespace velour
