#include "image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace velour {

namespace {

// Rational entries of the authors' matrix from linear Rec. 709 to XYZ, so that values agree with theirs.
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kFromXyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};
constexpr double kColorExponent = 0.7, kFeatureExponent = 0.5;
constexpr double kKnee = 0.4, kKneeError = 0.95;  // errors up to this share of the largest map to [0, kKneeError]
constexpr double kFeatureWidth = 0.082;           // degrees

/// White: the XYZ of linear Rec. 709 (1, 1, 1).
Vec3d white() {
  const auto sum = [](const double* row) { return row[0] + row[1] + row[2]; };
  return {sum(kToXyz[0]), sum(kToXyz[1]), sum(kToXyz[2])};
}

Vec3d product(const double (&m)[3][3], const Vec3d& v) {
  const auto row = [&](const double* r) { return r[0] * v.x + r[1] * v.y + r[2] * v.z; };
  return {row(m[0]), row(m[1]), row(m[2])};
}

/// YCxCz: linear in the color, with an achromatic and two opponent channels.
Vec3d to_ycxcz(const Vec3d& linear) {
  const Vec3d xyz = product(kToXyz, linear) / white();
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Vec3d from_ycxcz(const Vec3d& c) {
  const double y = (c.x + 16) / 116;
  return product(kFromXyz, Vec3d(y + c.y / 500, y, y - c.z / 200) * white());
}

double lab_curve(double t) {
  constexpr double kDelta = 6.0 / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

/// CIELAB with the chroma scaled by the lightness (Hunt effect).
Vec3d to_hunt_lab(const Vec3d& linear) {
  const Vec3d xyz = product(kToXyz, linear) / white();
  const double x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double hyab(const Vec3d& a, const Vec3d& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

using Plane = std::vector<double>;
using Weights = std::vector<double>;  // at -radius ... radius

/// in * (along_x along_y), both of one length; pixels beyond the border repeat it.
Plane convolved(const Plane& in, int width, int height, const Weights& along_x, const Weights& along_y) {
  const int radius = static_cast<int>(along_x.size() / 2);
  Plane rows(in.size()), out(in.size());
  const auto at = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = -radius; i <= radius; ++i) {
        sum += along_x[static_cast<size_t>(i + radius)] * in[at(std::clamp(x + i, 0, width - 1), y)];
      }
      rows[at(x, y)] = sum;
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int i = -radius; i <= radius; ++i) {
      const double weight = along_y[static_cast<size_t>(i + radius)];
      const double* row = &rows[at(0, std::clamp(y + i, 0, height - 1))];
      for (int x = 0; x < width; ++x) out[at(x, y)] += weight * row[x];
    }
  }
  return out;
}

template <class F>
Weights weights(int radius, const F& f) {
  Weights out;
  for (int i = -radius; i <= radius; ++i) out.push_back(f(static_cast<double>(i)));
  return out;
}

/// Scales weights to sum 1.
Weights normalized(Weights w) {
  double sum = 0;
  for (const double v : w) sum += v;
  for (double& v : w) v /= sum;
  return w;
}

/// Scales the positive weights to sum 1 and the negative ones to sum -1.
Weights balanced(Weights w) {
  double positive = 0, negative = 0;
  for (const double v : w) (v > 0 ? positive : negative) += v;
  for (double& v : w) v /= v > 0 ? positive : -negative;
  return w;
}

/// A term a sqrt(pi / b) exp(-pi^2 d^2 / b) of a contrast sensitivity function, d in degrees ([ANA20] Table 1).
struct SensitivityTerm {
  double a, b;
};
using Sensitivity = std::array<SensitivityTerm, 2>;
constexpr double kWidest = 0.04;  // largest b
constexpr Sensitivity kSensitivities[3] = {
    {{{1, 0.0047}, {0, 1e-5}}}, {{{1, 0.0053}, {0, 1e-5}}}, {{{34.1, 0.04}, {13.5, 0.025}}}};

Plane seen(const Plane& in, int width, int height, const Sensitivity& sensitivity, double pixels_per_degree) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPiD * kPiD)) * pixels_per_degree));
  Plane out(in.size());
  double total = 0;
  for (const auto& [a, b] : sensitivity) {
    if (a == 0) continue;
    const Weights line = weights(radius, [&, scale = kPiD * kPiD / (b * pixels_per_degree * pixels_per_degree)](
                                             double d) { return std::exp(-d * d * scale); });
    double sum = 0;
    for (const double v : line) sum += v;
    const double share = a * std::sqrt(kPiD / b) * sum * sum;
    total += share;
    const Plane term = convolved(in, width, height, normalized(line), normalized(line));
    for (size_t i = 0; i < out.size(); ++i) out[i] += share * term[i];
  }
  for (double& v : out) v /= total;
  return out;
}

/// What an observer sees of a picture.
struct Seen {
  std::vector<Vec3d> colors;  // Hunt-adjusted CIELAB, blurred by the contrast sensitivity
  Plane edges, points;        // magnitudes of the features of the achromatic channel
};

Plane magnitude(const Plane& in, int width, int height, const Weights& across, const Weights& along) {
  const Plane x = convolved(in, width, height, across, along), y = convolved(in, width, height, along, across);
  Plane out(in.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(x[i], y[i]);
  return out;
}

Seen look_at(const LinearPicture& picture, double pixels_per_degree) {
  const int width = picture.width, height = picture.height;
  Plane planes[3];
  for (const Rgb& c : picture.pixels) {
    const Vec3d opponent = to_ycxcz(Vec3d(c));
    for (int k = 0; k < 3; ++k) planes[k].push_back(opponent[k]);
  }
  Seen out;
  Plane blurred[3];
  for (int k = 0; k < 3; ++k) blurred[k] = seen(planes[k], width, height, kSensitivities[k], pixels_per_degree);
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    const Vec3d linear = from_ycxcz({blurred[0][i], blurred[1][i], blurred[2][i]});
    out.colors.push_back(to_hunt_lab(glm::clamp(linear, 0.0, 1.0)));
  }
  for (double& v : planes[0]) v = (v + 16) / 116;
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gauss = [&](double d) { return std::exp(-d * d / (2 * deviation * deviation)); };
  const Weights along = normalized(weights(radius, gauss));
  out.edges =
      magnitude(planes[0], width, height, balanced(weights(radius, [&](double d) { return -d * gauss(d); })), along);
  out.points = magnitude(
      planes[0], width, height,
      balanced(weights(radius, [&](double d) { return (d * d / (deviation * deviation) - 1) * gauss(d); })), along);
  return out;
}

/// Largest color difference: between green and blue.
double largest_difference() { return std::pow(hyab(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1})), kColorExponent); }

double color_error(const Vec3d& a, const Vec3d& b, double largest) {
  const double error = std::pow(hyab(a, b), kColorExponent), knee = kKnee * largest;
  if (error < knee) return kKneeError / knee * error;
  return kKneeError + (error - knee) / (largest - knee) * (1 - kKneeError);
}

}  // namespace

std::vector<float> flip_map(const LinearPicture& reference, const LinearPicture& test, double pixels_per_degree) {
  const Seen a = look_at(reference, pixels_per_degree), b = look_at(test, pixels_per_degree);
  const double largest = largest_difference();
  std::vector<float> out;
  for (size_t i = 0; i < a.colors.size(); ++i) {
    const double difference = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    const double feature = std::pow(std::clamp(difference / std::sqrt(2.0), 0.0, 1.0), kFeatureExponent);
    out.push_back(static_cast<float>(std::pow(color_error(a.colors[i], b.colors[i], largest), 1 - feature)));
  }
  return out;
}

}  // namespace velour
