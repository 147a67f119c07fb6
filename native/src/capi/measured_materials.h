// Materials of models, raw measurements and BTFs, as surfaces and as layers of shaders.
#pragma once

#include "capi/handles.h"
#include "scene/scene.h"

namespace velour::capi {

/// `neighbors`: see make_material().
SurfaceMaterial surface_of(const std::shared_ptr<const Model>& model, uint32_t neighbors);
/// f of the measurement; null `proposal`: samples come from a coarse model made here.
SurfaceMaterial surface_of(std::shared_ptr<const Measurement> measurement, std::shared_ptr<const Model> proposal,
                           uint32_t neighbors);
/// The BTF itself, with transmitted light if it has some. `most_bytes` 0: the default limit of read_btf_table().
SurfaceMaterial surface_of(const BtfMeasurement& btf, uint64_t most_bytes);

}  // namespace velour::capi
