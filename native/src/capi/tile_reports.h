// JSON reports on procedural mesostructure, with the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "tile/tile.h"

namespace velour::capi {

std::string tile_json(const Tile& tile);
std::string tile_kinds_json();

}  // namespace velour::capi
