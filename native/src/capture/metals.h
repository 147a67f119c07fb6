// The metals that surfaces and flakes are made of.
#pragma once

#include <string>
#include <vector>

#include "capture/reflectance.h"

namespace velour {

std::vector<std::string> metal_names();

/// Reflectance of clean metal below a medium of refractive index `outside` (1: air or vacuum). Throws
/// Error(invalid_argument) that lists the known names. metals.cpp gives the sources of the data.
Reflectance metal_reflectance(const std::string& name, double outside = 1.0);

}  // namespace velour
