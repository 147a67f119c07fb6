// The environment's kernels against a scalar reference in double, on every instruction set.
#include <cmath>
#include <limits>

#include "light/equirectangular.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/simd_targets.h"

namespace velour::equirectangular_kernels_test {
namespace {

constexpr int kWidth = 37, kHeight = 18;

const Mat3 kTurn = glm::transpose(Mat3({0.36f, 0.48f, -0.8f}, {-0.8f, 0.6f, 0}, {0.48f, 0.64f, 0.6f}));

const EnvironmentPlacement kPlacement{1.5f, kTurn};

struct Fixture {
  std::vector<float> rgb;
  EquirectangularImage image;
  Fixture() : rgb(noise()), image({kWidth, kHeight, 3, rgb}) {}

  static std::vector<float> noise() {
    std::vector<float> values(3 * kWidth * kHeight);
    RandomStream random(4, 5, 6);
    for (float& v : values) v = std::pow(random.next(), 4.0f);
    return values;
  }

  /// Radiance of a texel; columns wrap, rows end at the first and the last.
  std::array<double, 3> texel(int x, int y) const {
    const int row = std::clamp(y, 0, kHeight - 1), column = (x % kWidth + kWidth) % kWidth;
    const size_t at = 3 * static_cast<size_t>(row * kWidth + column);
    return {1.5 * rgb[at], 1.5 * rgb[at + 1], 1.5 * rgb[at + 2]};
  }
};

/// Texel coordinates, in texels from the upper left corner of the image.
struct Place {
  double x, y;
};

Place place_of(const Vec3& world) {
  const Vec3d w = glm::normalize(Vec3d(kTurn * world));
  const double phi = std::atan2(w.y, w.x), theta = std::atan2(std::hypot(w.x, w.y), w.z);
  return {(0.5 - phi / (2 * kPiD)) * kWidth, theta / kPiD * kHeight};
}

std::array<double, 3> bilinear(const Fixture& f, const Place& p) {
  const double x = std::floor(p.x - 0.5), y = std::floor(p.y - 0.5), fx = p.x - 0.5 - x, fy = p.y - 0.5 - y;
  std::array<double, 3> sum{};
  for (int i = 0; i < 4; ++i) {
    const double weight = (i % 2 ? fx : 1 - fx) * (i / 2 ? fy : 1 - fy);
    const auto t = f.texel(static_cast<int>(x) + i % 2, static_cast<int>(y) + i / 2);
    for (size_t c = 0; c < 3; ++c) sum[c] += weight * t[c];
  }
  return sum;
}

/// Node of the density: luminance times the sine of the row's polar angle; 0 at the poles.
double node(const Fixture& f, int x, int y) {
  if (y < 0 || y >= kHeight) return 0;
  const auto t = f.texel(x, y);
  return (0.2126 * t[0] + 0.7152 * t[1] + 0.0722 * t[2]) * std::sin(kPiD * (y + 0.5) / kHeight);
}

/// The bilinear density between nodes, not normalized, as a function on the image; towards a pole it falls to 0 over
/// half a row.
double image_density(const Fixture& f, const Place& p) {
  const double x = std::floor(p.x - 0.5), y = std::floor(p.y - 0.5), fx = p.x - 0.5 - x;
  double fy = p.y - 0.5 - y;
  if (y < 0) fy = 2 * p.y;  // the pole lies half a row above the first center, not a whole one
  if (y >= kHeight - 1) fy = 1 - 2 * (kHeight - p.y);
  const int cx = static_cast<int>(x), cy = static_cast<int>(y);
  const double above = (1 - fx) * node(f, cx, cy) + fx * node(f, cx + 1, cy);
  const double below = (1 - fx) * node(f, cx, cy + 1) + fx * node(f, cx + 1, cy + 1);
  return (1 - fy) * above + fy * below;
}

/// Its integral over the image, in texels: trapezia between centers, and half as high at the poles.
double image_mass(const Fixture& f) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y) {
    const double height = y == 0 || y == kHeight - 1 ? 0.5 + 0.25 : 1;
    for (int x = 0; x < kWidth; ++x) sum += height * node(f, x, y);
  }
  return sum;
}

std::vector<DirectionBatch> batches() {
  std::vector<DirectionBatch> all;
  RandomStream random(1, 1, 1);
  for (int count = 1; count <= 64; count += 7) {
    DirectionBatch batch;
    while (batch.count < count) batch.push(sample_uniform_sphere(random.next2()));
    batch.pad();
    all.push_back(batch);
  }
  return all;
}

TEST(EquirectangularKernels, LookUpMatchesTheScalarReferenceOnEveryTarget) {
  const Fixture f;
  const double mass = image_mass(f);
  test::on_every_simd_target([&] {
    for (const DirectionBatch& batch : batches()) {
      RgbBatch radiance;
      ScalarBatch pdf;
      equirectangular_look_up(f.image, kPlacement, batch, radiance, pdf);
      for (int i = 0; i < batch.count; ++i) {
        const Place p = place_of(batch.get(i));
        const auto expected = bilinear(f, p);
        // Angles are within 8e-7 radians, that is 1e-5 texels, and texels differ by up to 1.5.
        EXPECT_NEAR(radiance.r[i], expected[0], 2e-5);
        EXPECT_NEAR(radiance.g[i], expected[1], 2e-5);
        EXPECT_NEAR(radiance.b[i], expected[2], 2e-5);
        // Per texel of the image, then per solid angle.
        const double texels = kWidth * kHeight / (2 * kPiD * kPiD * std::sin(kPiD * p.y / kHeight));
        const double density = image_density(f, p) / mass * texels;
        EXPECT_NEAR(pdf.v[i], density, 2e-5 * (1 + texels / mass) + 1e-4 * density);
      }
    }
  });
}

TEST(EquirectangularKernels, CoordinatesMatchTheScalarReferenceOnEveryTarget) {
  const Fixture f;
  test::on_every_simd_target([&] {
    for (const DirectionBatch& batch : batches()) {
      EquirectangularCoordinates at;
      equirectangular_coordinates(f.image, kTurn, batch, at);
      for (int i = 0; i < batch.count; ++i) {
        const Place p = place_of(batch.get(i));
        double x = at.x[i] + static_cast<double>(at.fx[i]) - 0.5;
        if (x - p.x > kWidth / 2.0) x -= kWidth;
        if (p.x - x > kWidth / 2.0) x += kWidth;
        EXPECT_NEAR(x, p.x, 1e-5);
        EXPECT_NEAR(at.y[i] + static_cast<double>(at.fy[i]) - 0.5, p.y, 1e-5);
        const double from_pole = std::min(p.y, kHeight - p.y);
        const double sine = std::sin(kPiD * p.y / kHeight);
        EXPECT_NEAR(at.inverse_sin[i] * sine, std::min(1.0, 2 * from_pole), 2e-5);
      }
    }
  });
}

/// Cells of directions that are not numbers must exist, because they are read.
TEST(EquirectangularKernels, CellsOfBrokenDirectionsLieInTheImage) {
  const Fixture f;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  test::on_every_simd_target([&] {
    DirectionBatch batch;
    for (const Vec3& w : {Vec3(kNan), Vec3(kInfinity), Vec3(0, kNan, 1), Vec3(1, 0, kNan), Vec3(3e38f), Vec3(0.0f)}) {
      batch.push(w);
      batch.push(-w);
    }
    batch.pad();
    EquirectangularCoordinates at;
    equirectangular_coordinates(f.image, kTurn, batch, at);
    for (int i = 0; i < batch.count; ++i) {
      EXPECT_TRUE(at.x[i] >= 0 && at.x[i] < kWidth) << i << ' ' << at.x[i];
      EXPECT_TRUE(at.y[i] >= 0 && at.y[i] <= kHeight) << i << ' ' << at.y[i];
    }
  });
}

/// Directions of places on the image, by the inverse of place_of.
TEST(EquirectangularKernels, DirectionsMatchTheScalarReferenceOnEveryTarget) {
  const Fixture f;
  test::on_every_simd_target([&] {
    RandomStream random(7, 7, 7);
    ScalarBatch u, v;
    for (int i = 0; i < 64; ++i) u.v[i] = random.next(), v.v[i] = random.next();
    for (int count = 1; count <= 64; count += 9) {
      DirectionBatch world;
      equirectangular_directions(kTurn, u.v, v.v, count, world);
      for (int i = 0; i < count; ++i) {
        const double theta = kPiD * static_cast<double>(v.v[i]), phi = 2 * kPiD * (0.5 - static_cast<double>(u.v[i]));
        const Vec3d in_image(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        const Vec3d expected = glm::transpose(glm::mat<3, 3, double>(kTurn)) * in_image;
        EXPECT_LT(glm::distance(Vec3d(world.get(i)), expected), 1e-6) << i;
      }
    }
  });
}

}  // namespace
}  // namespace velour::equirectangular_kernels_test
