// Pictures that are named for their angles, as those of the Bonn sets: "00081 tl015 pl000 tv000 pv000.jpg".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "btf/image_set.h"

namespace velour {

struct NamedAngles {
  PolarAngles light, view;
  std::optional<uint64_t> index;  // the number before the angles
};

/// Of a file name without its extension: tl, pl, tv, pv, each once, in any order and case, followed by degrees, with
/// anything that is no letter between them. Nothing where one is missing or there twice.
std::optional<NamedAngles> angles_of_name(std::string_view stem);

/// "00081 tl015 pl000 tv000 pv000" for whole degrees below 1000.
std::string name_of_angles(const NamedAngles& angles);

/// All pictures of a folder and of folders in it. Directions come in the order of the indices where every picture has
/// one of its own, else by their angles. Throws Error(bad_data) for a picture without angles in its name, for two
/// pictures of one pair, and where a view lacks a light that another has.
std::vector<PairPicture> find_named_pictures(const std::string& folder);

}  // namespace velour
