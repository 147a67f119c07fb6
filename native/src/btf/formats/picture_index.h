// Pairs of directions of the images of a set, from the names of the files or from an index in CSV.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "btf/formats/image_set.h"
#include "btf/formats/load_btf.h"

namespace velour {

// Image files named by their angles, as in the Bonn sets: "00081 tl015 pl000 tv000 pv000.jpg".

struct NamedAngles {
  PolarAngles light, view;
  std::optional<uint64_t> index;  // the number before the angles
};

/// Parses a file name without extension: tl, pl, tv and pv, each once, in any order and case, followed by degrees and
/// separated by anything but letters. Empty if one is missing or repeated, or has a comma before further digits
/// ("tl15,5"): a decimal comma, or a separator.
std::optional<NamedAngles> angles_of_name(std::string_view stem);

/// "00081 tl015 pl000 tv000 pv000" for whole degrees below 1000.
std::string name_of_angles(const NamedAngles& angles);

/// Finds all images in a folder and its subfolders. Directions are ordered by index if every image has a unique one,
/// otherwise by angle. Throws Error(bad_data) if a name lacks angles, if two images have the same pair, or if a view
/// lacks a light that another view has.
std::vector<PairPicture> find_named_pictures(const std::string& folder);

// CSV index of images and their angles, one line per image.

/// The first line that is neither empty nor a comment (#) names the columns, in any order: file, theta_l, phi_l,
/// theta_v, phi_v (degrees or radians). Other columns are ignored, except view and light, which number the views and
/// lights, determine their order, and must appear together. Fields with commas are enclosed in double quotes. Files are
/// relative to the index. Pairs may be missing. Throws Error(bad_data) with file, line and field; also if the angles
/// look like radians and no unit is given.
std::vector<PairPicture> read_csv_index(const std::string& path, BtfAngles angles = BtfAngles::automatic);

/// Whether a file begins like such an index.
bool is_csv_index(const std::string& path);

}  // namespace velour
