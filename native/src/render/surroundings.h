// Whether the camera stands inside of something.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

namespace velour {

/// The instance that the camera is inside of and sees nothing but: the back of its surface is the nearest one in all of
/// many directions about the camera and on all of many rays through the picture, and all of it that they meet is
/// opaque. Instances that are hidden from the camera are looked through. `scene` is committed.
std::optional<uint32_t> surrounding_instance(const Scene& scene);

}  // namespace velour
