#include "image/color_primaries.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace velour {
namespace {

using Vec = glm::dvec3;
using Matrix = glm::dmat3;

constexpr double kSingular = 1e-9;

/// CIE XYZ of chromaticities x, y, for luminance y.
Vec xyz_of(const std::array<double, 2>& xy) { return {xy[0], xy[1], 1 - xy[0] - xy[1]}; }

Vec white_of(const ColorPrimaries& p) { return xyz_of(p.white) / p.white[1]; }

/// Matrix from RGB to XYZ, with columns scaled so that (1, 1, 1) is the white (Lindbloom, "RGB/XYZ Matrices").
std::optional<Matrix> xyz_of_rgb(const ColorPrimaries& p) {
  const Matrix columns(xyz_of(p.red), xyz_of(p.green), xyz_of(p.blue));
  const double determinant = glm::determinant(columns);
  if (!(std::abs(determinant) > kSingular) || !(std::abs(p.white[1]) > kSingular)) return std::nullopt;
  const Vec scale = glm::inverse(columns) * white_of(p);
  const Matrix result(columns[0] * scale[0], columns[1] * scale[1], columns[2] * scale[2]);
  if (!std::isfinite(glm::determinant(result)) || std::abs(glm::determinant(result)) < kSingular) return std::nullopt;
  return result;
}

/// Chromatic adaptation: scales Bradford's cone responses (Lam 1985) from one white to the other.
Matrix adaptation(const Vec& from, const Vec& to) {
  const Matrix cones =
      glm::transpose(Matrix(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const Vec scale = (cones * to) / (cones * from);
  return glm::inverse(cones) * Matrix(Vec(scale[0], 0, 0), Vec(0, scale[1], 0), Vec(0, 0, scale[2])) * cones;
}

bool close(const std::array<double, 2>& a, const std::array<double, 2>& b, double within) {
  return std::abs(a[0] - b[0]) <= within && std::abs(a[1] - b[1]) <= within;
}

bool is_xyz(const ColorPrimaries& p) {
  constexpr double kWritten = 1e-4;  // precision with which files state it
  return close(p.red, {1, 0}, kWritten) && close(p.green, {0, 1}, kWritten) && close(p.blue, {0, 0}, kWritten);
}

ColorMatrix rows_of(const Matrix& m) {
  ColorMatrix rows;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rows[static_cast<size_t>(r)][static_cast<size_t>(c)] = m[c][r];
  return rows;
}

Matrix rgb_of_xyz() { return glm::inverse(*xyz_of_rgb(ColorPrimaries())); }

}  // namespace

std::optional<ColorMatrix> to_rec709(const ColorPrimaries& primaries) {
  const auto xyz = xyz_of_rgb(primaries);
  if (!xyz) return std::nullopt;
  if (is_xyz(primaries)) return rows_of(rgb_of_xyz() * *xyz);
  const Matrix result = rgb_of_xyz() * adaptation(white_of(primaries), white_of(ColorPrimaries())) * *xyz;
  if (!std::isfinite(glm::determinant(result))) return std::nullopt;
  return rows_of(result);
}

bool is_stated(const ColorPrimaries& p) {
  constexpr std::array<double, 2> kZero{0, 0};
  return p.red != kZero || p.green != kZero || p.blue != kZero || p.white != kZero;
}

bool is_rec709(const ColorPrimaries& p) {
  constexpr double kWritten = 2e-3;  // D65 is written as 0.3127 0.3290, 0.31271 0.32902 and 0.313 0.329
  const ColorPrimaries own;
  return close(p.red, own.red, kWritten) && close(p.green, own.green, kWritten) && close(p.blue, own.blue, kWritten) &&
         close(p.white, own.white, kWritten);
}

void transform_colors(const ColorMatrix& matrix, size_t stride, std::span<float> values) {
  for (size_t i = 0; i + 3 <= values.size(); i += stride) {
    const std::array<double, 3> in{values[i], values[i + 1], values[i + 2]};
    for (size_t r = 0; r < 3; ++r)
      values[i + r] = static_cast<float>(matrix[r][0] * in[0] + matrix[r][1] * in[1] + matrix[r][2] * in[2]);
  }
}

}  // namespace velour
