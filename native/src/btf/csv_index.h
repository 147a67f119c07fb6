// A list of pictures with their angles: text with one line a picture.
#pragma once

#include <string>
#include <vector>

#include "btf/image_set.h"
#include "btf/load_btf.h"

namespace velour {

/// The first line that is neither empty nor a comment (#) names the columns, in any order: file, theta_l, phi_l,
/// theta_v, phi_v (degrees or radians); others are ignored except view and light, the numbers of a view and of a light,
/// which set their order and are there together. Fields with commas stand in double quotes. Files are relative to the
/// index. Not every pair needs to be there. Throws Error(bad_data) with file, line and field, also where nobody says
/// what unit angles have that look like radians.
std::vector<PairPicture> read_csv_index(const std::string& path, BtfAngles angles = BtfAngles::automatic);

/// Whether the text of a file begins as such an index does.
bool is_csv_index(const std::string& path);

}  // namespace velour
