// Specular reflectance of metals.
#pragma once

#include <string>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Complex index of refraction n + i k at the wavelengths 617, 549 and 471 nm: the rows of Johnson and Christy's tables
/// next to the dominant wavelengths of the Rec. 709 primaries (611, 549 and 464 nm). n = 0 reflects everything.
struct Conductor {
  Rgb n;
  Rgb k;
};

/// Unpolarised Fresnel reflectance against air or vacuum, each in [0, 1], for cos_theta in [0, 1] between the normal
/// and the ray (Born and Wolf, Principles of Optics, 14.2). Polarisation is not carried from one bounce to the next.
Rgb fresnel_reflectance(const Conductor& conductor, float cos_theta);

/// Throws Error(invalid_argument) that lists the names known. Sources stand beside the numbers in conductor.cpp.
Conductor metal(const std::string& name);

}  // namespace velour
