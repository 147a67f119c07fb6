// Look-ups and rays in a shell, many side by side.
#pragma once

#include <span>

#include "votf/shell_trace.h"

namespace velour {

/// ShellField::distance at each of `places`.
void shell_distances(const ShellTable& table, std::span<const Vec3> places, float* distance);

/// trace_shells() for at most kWaysTogether of them.
inline constexpr size_t kWaysTogether = 256;
void march_shells(const ShellTable& table, std::span<const ShellWay> ways, ShellHit* hits);

/// ShellRay::at.
Vec3 place_on_ray(const ShellRay& ray, float s);

}  // namespace velour
