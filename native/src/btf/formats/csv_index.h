// CSV index of images and their angles, one line per image.
#pragma once

#include <string>
#include <vector>

#include "btf/formats/image_set.h"
#include "btf/formats/load_btf.h"

namespace velour {

/// The first line that is neither empty nor a comment (#) names the columns, in any order: file, theta_l, phi_l,
/// theta_v, phi_v (degrees or radians). Other columns are ignored, except view and light, which number the views and
/// lights, determine their order, and must appear together. Fields with commas are enclosed in double quotes. Files are
/// relative to the index. Pairs may be missing. Throws Error(bad_data) with file, line and field; also if the angles
/// look like radians and no unit is given.
std::vector<PairPicture> read_csv_index(const std::string& path, BtfAngles angles = BtfAngles::automatic);

/// Whether a file begins like such an index.
bool is_csv_index(const std::string& path);

}  // namespace velour
