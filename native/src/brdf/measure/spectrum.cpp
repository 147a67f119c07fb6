#include "brdf/measure/spectrum.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace velour {
namespace {

using Mat3d = glm::dmat3;

/// XYZ of chromaticity (x, y) with Y = 1.
Vec3d xyz_of(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

/// Columns: the primaries of ITU-R BT.709, scaled so that (1, 1, 1) is the white D65.
Mat3d xyz_from_rec709(const Vec3d& white) {
  const Mat3d primaries(xyz_of(0.64, 0.33), xyz_of(0.30, 0.60), xyz_of(0.15, 0.06));
  const Vec3d amount = glm::inverse(primaries) * white;
  return {primaries[0] * amount.x, primaries[1] * amount.y, primaries[2] * amount.z};
}

/// From XYZ under the equal-energy illuminant, whose white is (1, 1, 1), to linear Rec. 709 with the Bradford transform
/// (Lam 1985).
Mat3d rec709_from_equal_energy() {
  const Vec3d d65 = xyz_of(0.3127, 0.3290);
  const Mat3d cones = glm::transpose(Mat3d(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const Vec3d gain = (cones * d65) / (cones * Vec3d(1.0));
  const Mat3d adapt = glm::inverse(cones) * Mat3d(gain.x, 0.0, 0.0, 0.0, gain.y, 0.0, 0.0, 0.0, gain.z) * cones;
  return glm::inverse(xyz_from_rec709(d65)) * adapt;
}

}  // namespace

std::vector<Vec3d> rec709_weights(std::span<const double> wavelengths) {
  std::vector<Vec3d> weights(wavelengths.size(), Vec3d(0.0));
  Vec3d total(0.0);
  for (int n = 0; n < kCieCount; ++n) {
    const double lambda = kCieFirst + n * kCieStep;
    const Vec3d observer(kCie1931[n][0], kCie1931[n][1], kCie1931[n][2]);
    total += observer;
    const auto above = std::upper_bound(wavelengths.begin(), wavelengths.end(), lambda);
    const auto high = static_cast<size_t>(above - wavelengths.begin());
    if (high == 0)
      weights.front() += observer;
    else if (high == wavelengths.size())
      weights.back() += observer;
    else {
      const double t = (lambda - wavelengths[high - 1]) / (wavelengths[high] - wavelengths[high - 1]);
      weights[high - 1] += (1.0 - t) * observer;
      weights[high] += t * observer;
    }
  }
  const Mat3d to_rec709 = rec709_from_equal_energy();
  for (Vec3d& w : weights) w = to_rec709 * (w / total);
  return weights;
}

Rgb rec709_of_xyz(const Vec3d& xyz) {
  static const Mat3d kToRec709 = rec709_from_equal_energy();
  return Rgb(kToRec709 * xyz);
}

Rgb rec709_of(std::span<const Vec3d> weights, std::span<const float> samples) {
  Vec3d sum(0.0);
  for (size_t i = 0; i < weights.size(); ++i) sum += weights[i] * static_cast<double>(samples[i]);
  return Rgb(sum);
}

void check_wavelengths(std::span<const double> wavelengths, const std::string& where) {
  if (wavelengths.empty()) throw Error(Status::bad_data, where + " is empty.");
  double previous = 100.0;
  for (const double lambda : wavelengths) {
    if (!(lambda > previous && lambda <= 5000.0))
      throw Error(Status::bad_data, where + " has " + std::to_string(lambda) + " after " + std::to_string(previous) +
                                        "; wavelengths must increase and lie between 100 and 5000 nm.");
    previous = lambda;
  }
}

}  // namespace velour
