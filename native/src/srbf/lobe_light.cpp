#include "srbf/lobe_light.h"

#include <algorithm>
#include <cmath>

#include "sphere/frame.h"

namespace velour {
namespace {

constexpr int kZeniths = 256, kDraws = 377;
constexpr double kGolden = 0.6180339887498949;

/// Share above the horizon of the directions at angle `zenith` from a center (both given by sine and cosine).
double share_above(const glm::dvec2& center, const glm::dvec2& zenith) {
  const double needed = -center.y * zenith.y, reach = center.x * zenith.x;
  if (needed <= -reach) return 1;
  if (needed >= reach) return 0;
  return std::acos(needed / reach) / kPiD;
}

}  // namespace

double kernel_integral_above(Kernel kernel, double bandwidth, double cosine) {
  const glm::dvec2 center(std::sqrt(std::max(1 - cosine * cosine, 0.0)), cosine);
  double sum = 0;
  for (int i = 0; i < kZeniths; ++i) {
    const double d = kernel_sample(kernel, bandwidth, (i + 0.5) / kZeniths);
    sum += share_above(center, {std::sqrt(d * (2 - d)), 1 - d});
  }
  return kernel_integral(kernel, bandwidth) * sum / kZeniths;
}

double reflected_light(const WarpedLobe& lobe, const Vec3d& wv) {
  const Frame frame = Frame::about(Vec3(lobe.center));
  const double integral = kernel_integral(Kernel::gaussian, lobe.bandwidth);
  double sum = 0;
  const auto add = [&](const Vec3d& wl) {
    const double kernel = warped_kernel(lobe, wl, wv), cosine = wl.z;
    sum += kernel * cosine / (kernel * warp_jacobian(lobe, wl, wv) / integral + cosine / kPiD);
  };
  for (int i = 0; i < kDraws; ++i) {  // a Fibonacci lattice samples both the lobe and the cosine
    const double u = (i + 0.5) / kDraws, phi = 2 * kPiD * std::fmod(i * kGolden, 1.0);
    const double c = std::cos(phi), s = std::sin(phi);
    const double d = kernel_sample(Kernel::gaussian, lobe.bandwidth, u), sine = std::sqrt(d * (2 - d));
    const Vec3d psi = sine * (c * Vec3d(frame.x) + s * Vec3d(frame.y)) + (1 - d) * lobe.center;
    const auto wl = unwarped(lobe, glm::normalize(psi), wv);
    if (wl && wl->z > 0) add(*wl);
    add({std::sqrt(u) * c, std::sqrt(u) * s, std::sqrt(1 - u)});
  }
  return sum / kDraws;
}

}  // namespace velour
