// Whether the camera is inside an object.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

namespace velour {

/// The instance that encloses the camera and hides everything else: its back face is the nearest surface in all of many
/// directions from the camera and on all of many rays through the image, and is opaque wherever they hit it. Instances
/// hidden from the camera are ignored. `scene` must be committed.
std::optional<uint32_t> surrounding_instance(const Scene& scene);

}  // namespace velour
