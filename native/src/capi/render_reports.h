// JSON reports on scenes and renders, with the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "render/report.h"
#include "scene/scene.h"

namespace velour::capi {

std::string scene_json(const Scene& scene);
std::string render_json(const RenderReport& report);

}  // namespace velour::capi
