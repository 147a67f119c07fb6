// Image files named by their angles, as in the Bonn sets: "00081 tl015 pl000 tv000 pv000.jpg".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "btf/formats/image_set.h"

namespace velour {

struct NamedAngles {
  PolarAngles light, view;
  std::optional<uint64_t> index;  // the number before the angles
};

/// Parses a file name without extension: tl, pl, tv and pv, each once, in any order and case, followed by degrees and
/// separated by anything but letters. Empty if one is missing or repeated.
std::optional<NamedAngles> angles_of_name(std::string_view stem);

/// "00081 tl015 pl000 tv000 pv000" for whole degrees below 1000.
std::string name_of_angles(const NamedAngles& angles);

/// Finds all images in a folder and its subfolders. Directions are ordered by index if every image has a unique one,
/// otherwise by angle. Throws Error(bad_data) if a name lacks angles, if two images have the same pair, or if a view
/// lacks a light that another view has.
std::vector<PairPicture> find_named_pictures(const std::string& folder);

}  // namespace velour
