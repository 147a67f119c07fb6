// Lobes of closures against plain formulas.
#include "brdf/fit/closures/closures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "closure_examples.h"
#include "math/sphere/directions.h"
#include "math/sphere/quadrature.h"

namespace velour::closures_test {
namespace {

using test::kBeckmann, test::kCorrelated, test::kGgx, test::kSeparable;
using test::lobe_of, test::network_of;

double angle_alpha_tan_sq(const Vec3d& w, double ax, double ay) {
  return (ax * ax * w.x * w.x + ay * ay * w.y * w.y) / (w.z * w.z);
}

double plain_lambda(LobeDistribution distribution, double t) {
  if (distribution == kGgx) return 0.5 * (std::sqrt(1 + t) - 1);
  const double a = 1 / std::sqrt(t);
  return a > 1.6 ? 0 : (1 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a);
}

/// Cycles' lobe as its source writes it: angles of the frame of the normal N' and of `along`, which it projects.
double plain_lobe(LobeDistribution distribution, LobeMasking masking, double ax, double ay, const Vec3d& normal,
                  const Vec3d& along, const Vec3d& wv, const Vec3d& wl) {
  const Vec3d tangent = glm::normalize(along - glm::dot(along, normal) * normal),
              bitangent = glm::cross(normal, tangent);
  const auto local = [&](const Vec3d& w) {
    return Vec3d(glm::dot(w, tangent), glm::dot(w, bitangent), glm::dot(w, normal));
  };
  const Vec3d v = local(wv), l = local(wl), h = glm::normalize(v + l);
  if (l.z <= 0 || v.z <= 0) return 0;
  const double theta = std::acos(h.z), phi = std::atan2(h.y, h.x), tangent_sq = std::tan(theta) * std::tan(theta);
  const double e = tangent_sq * (std::pow(std::cos(phi) / ax, 2) + std::pow(std::sin(phi) / ay, 2));
  const double falloff = distribution == kGgx ? std::pow(1 + e, -2) : std::exp(-e);
  const double d = falloff / (kPiD * ax * ay * std::pow(h.z, 4));
  const double of_v = plain_lambda(distribution, angle_alpha_tan_sq(v, ax, ay));
  const double of_l = plain_lambda(distribution, angle_alpha_tan_sq(l, ax, ay));
  const double g = masking == kSeparable ? 1 / ((1 + of_v) * (1 + of_l)) : 1 / (1 + of_v + of_l);
  return d * g / (4 * v.z);
}

/// Cycles' lobe of Ashikhmin and Shirley, f cos about +z.
double plain_ashikhmin_shirley(double ax, double ay, const Vec3d& wv, const Vec3d& wl) {
  const Vec3d h = glm::normalize(wv + wl);
  const double n_x = 2 / (ax * ax) - 2, n_y = 2 / (ay * ay) - 2;
  const double exponent = (n_x * h.x * h.x + n_y * h.y * h.y) / (1 - h.z * h.z);
  const double norm = std::sqrt((n_x + 1) * (n_y + 1)) / (8 * kPiD);
  return wl.z * norm * std::pow(h.z, exponent) / (glm::dot(h, wv) * std::max(wv.z, wl.z));
}

TEST(Closures, LobesOfAshikhminAndShirleyAreThoseOfAPlainImplementation) {
  const double alpha = 0.2, rho = 0.6;
  const ClosureNetwork network = network_of(Rgb(0), {lobe_of(LobeDistribution::ashikhmin_shirley, Rgb(1),
                                                             static_cast<float>(alpha), 0, static_cast<float>(rho))});
  const std::vector<Vec3> wl = hemisphere_fibonacci(200);
  for (const float theta_v : {0.1f, 0.7f, 1.4f}) {
    const std::vector<Rgb> values = test::values_of(network, kSeparable, theta_v, wl, 0.8f);
    for (size_t i = 0; i < wl.size(); ++i) {
      const double lobe = plain_ashikhmin_shirley(alpha * std::exp(rho), alpha * std::exp(-rho),
                                                  Vec3d(direction(theta_v, 0.8f)), Vec3d(wl[i]));
      EXPECT_NEAR(values[i].g, lobe, 1e-3 * lobe + 1e-6);
    }
  }
}

TEST(Closures, ValuesAreThoseOfAPlainImplementation) {
  const double alpha = 0.2, rho = 0.35;
  const std::vector<Vec3> wl = hemisphere_fibonacci(200);
  for (const auto& [tilt, phi_v] : {std::pair(0.3, 0.0f), {0.0, 0.8f}}) {  // in the frames of incidence and surface
    for (const LobeDistribution distribution : {kGgx, kBeckmann}) {
      for (const LobeMasking masking : {kSeparable, kCorrelated}) {
        const ClosureNetwork network =
            network_of(Rgb(0.3f), {lobe_of(distribution, {0.5f, 1, 2}, static_cast<float>(alpha),
                                           static_cast<float>(tilt), static_cast<float>(rho))});
        for (const float theta_v : {0.1f, 0.7f, 1.4f}) {
          const std::vector<Rgb> values = test::values_of(network, masking, theta_v, wl, phi_v);
          const Vec3d normal(std::sin(tilt * theta_v), 0, std::cos(tilt * theta_v));
          for (size_t i = 0; i < wl.size(); ++i) {
            const double lobe = plain_lobe(distribution, masking, alpha * std::exp(rho), alpha * std::exp(-rho), normal,
                                           Vec3d(1, 0, 0), Vec3d(direction(theta_v, phi_v)), Vec3d(wl[i]));
            const double diffuse = 0.3 * static_cast<double>(wl[i].z) / kPiD;
            EXPECT_NEAR(values[i].r, diffuse + 0.5 * lobe, 1e-3 * (diffuse + lobe));
            EXPECT_NEAR(values[i].b, diffuse + 2 * lobe, 2e-3 * (diffuse + lobe));
          }
        }
      }
    }
  }
}

/// Albedo by quadrature over the polar angle and azimuth of the light.
double albedo_of(const ClosureNetwork& network, LobeMasking masking, float theta_v) {
  const Quadrature z = gauss_legendre(120, 0, 1);
  constexpr int kAzimuths = 200;
  std::vector<Vec3> wl;
  for (const double node : z.node) {
    const auto theta = static_cast<float>(std::acos(node));
    for (int k = 0; k < kAzimuths; ++k) {
      wl.push_back(direction(theta, 2 * kPi * (static_cast<float>(k) + 0.5f) / kAzimuths));
    }
  }
  const std::vector<Rgb> values = test::values_of(network, masking, theta_v, wl);
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) sum += z.weight[i / kAzimuths] * static_cast<double>(values[i].g);
  return sum * 2 * kPiD / kAzimuths;
}

TEST(Closures, AlbedoOfTheDiffuseLobeIsItsColor) {
  EXPECT_NEAR(albedo_of(network_of({0.1f, 0.5f, 0.9f}, {}), kSeparable, 1.0f), 0.5, 1e-5);
}

TEST(Closures, AnUntiltedLobeGainsNoEnergy) {
  for (const LobeDistribution distribution : {kGgx, kBeckmann}) {
    for (const float alpha : {0.05f, 0.3f, 1.0f}) {
      const ClosureNetwork network = network_of(Rgb(0), {lobe_of(distribution, Rgb(1), alpha)});
      for (const float theta_v : {0.0f, 0.7f, 1.2f, 1.5f}) {
        const double albedo = albedo_of(network, kSeparable, theta_v);
        EXPECT_LT(albedo, 1.003);
        EXPECT_GE(albedo_of(network, kCorrelated, theta_v), albedo - 1e-6);  // correlated masking hides less
      }
      const double facing = albedo_of(network, kSeparable, 0);
      EXPECT_TRUE(alpha > 0.05f || facing > 0.99) << facing;
    }
  }
}

TEST(Closures, SlopesOfALobeAreThoseOfDifferences) {
  const float theta_v = 1.1f, phi_v = 0.6f, step = 0.003f;
  const ClosureLights lights = test::plain_lights(theta_v, hemisphere_fibonacci(64), phi_v);
  const LobeChain chain{.alpha_x = 1, .alpha_y = 1, .tilt = 1, .stretch_x = 1, .stretch_y = -1};
  for (const LobeDistribution distribution : {kGgx, kBeckmann, LobeDistribution::ashikhmin_shirley}) {
    for (const LobeMasking masking : {kSeparable, kCorrelated}) {
      const auto shape = [&](float size, float tilt, float stretch) {
        return ClosureLobeShape{distribution, masking, 0.3f * std::exp(size + stretch), 0.5f * std::exp(size - stretch),
                                0.1f + tilt};
      };
      AlignedArray<float> rows(4 * lights.padded()), up(lights.padded()), down(lights.padded());
      fill_lobe_slopes(lights, shape(0, 0, 0), chain, rows.data());
      for (size_t p = 0; p < 3; ++p) {
        const auto moved = [&](float by) { return shape(p == 0 ? by : 0, p == 1 ? by : 0, p == 2 ? by : 0); };
        fill_lobe(lights, moved(step), up.data());
        fill_lobe(lights, moved(-step), down.data());
        for (size_t i = 0; i < 64; ++i) {
          const float slope = rows.data()[(p + 1) * lights.padded() + i];
          const float difference = (up.data()[i] - down.data()[i]) / (2 * step);
          EXPECT_NEAR(slope, difference, 0.01f * std::abs(slope) + 2e-3f * rows.data()[i] + 1e-5f);
        }
      }
    }
  }
}

TEST(Closures, ProductsAreSumsOverRows) {
  AlignedArray<float> rows(3 * 32), fixed(4 * 32);
  for (size_t i = 0; i < rows.size(); ++i) rows.data()[i] = std::sin(static_cast<float>(i));
  for (size_t i = 0; i < fixed.size(); ++i) fixed.data()[i] = std::cos(static_cast<float>(2 * i));
  const float* const arrays[4] = {fixed.data(), fixed.data() + 32, fixed.data() + 64, fixed.data() + 96};
  float gram[9], moments[3][4];
  fill_products(rows.data(), 3, 32, arrays, gram, moments);
  const auto product = [](const float* a, const float* b) {
    double sum = 0;
    for (int i = 0; i < 32; ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
  };
  for (int i = 0; i < 3; ++i) {
    const float* row = rows.data() + 32 * i;
    for (int j = 0; j <= i; ++j) EXPECT_NEAR(gram[3 * i + j], product(row, rows.data() + 32 * j), 1e-5);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(moments[i][k], product(row, arrays[k]), 1e-5);
  }
}

TEST(Closures, ShapesStayInsideTheirBounds) {
  const ClosureBounds bounds;
  for (const double u : {-8.0, -1.0, 0.0, 0.5, 8.0}) {
    for (const double theta_v : {0.0, 0.5, 1.3, 1.5}) {
      const ClosureShape s = closure_shape(u, -8, 8, theta_v, bounds);
      EXPECT_GE(s.alpha, bounds.min_alpha);
      EXPECT_LE(s.alpha * std::exp(s.anisotropy), 1 + 1e-9);
      EXPECT_GE(s.tilt * theta_v, static_cast<double>(lowest_closure_tilt(static_cast<float>(theta_v))) - 1e-6);
      EXPECT_LT(closure_shape(u, 8, 0, theta_v, bounds).tilt, 1);
      EXPECT_NEAR(closure_shape(closure_alpha_unknown(0.1, bounds), 0, 0, theta_v, bounds).alpha, 0.1, 1e-9);
      EXPECT_NEAR(closure_shape(0, closure_tilt_unknown(0.3, theta_v), 0, theta_v, bounds).tilt, 0.3, 1e-9);
    }
  }
  EXPECT_EQ(closure_shape(0, 0, 8, 0, bounds).anisotropy, 0);  // the tangent has no direction at the normal
  EXPECT_NEAR(lowest_closure_tilt(radians_from(85.0f)), radians_from(-2.2f), radians_from(0.05f));
}

// Inputs of Blender's nodes.

TEST(Closures, TheFactorOfTheIncomingDirectionTurnsTheNormal) {
  for (const float theta_v : {1e-4f, 0.3f, 1.0f, 1.5f}) {
    for (const float tilt : {-0.03f, 0.0f, 0.4f, 1.0f}) {
      const Vec3 normal(0, 0, 1), incoming = direction(theta_v, 0);
      const Vec3 turned = glm::normalize(normal + incoming_factor(tilt, theta_v) * (incoming - normal));
      EXPECT_NEAR(std::atan2(turned.x, turned.z), tilt * theta_v, 1e-4f);
    }
  }
}

/// alpha along the tangent and across it, as Cycles sets them.
Vec2 cycles_alphas(float alpha, float anisotropy) {
  return anisotropy < 0 ? Vec2(alpha / (1 + anisotropy), alpha * (1 + anisotropy))
                        : Vec2(alpha * (1 - anisotropy), alpha / (1 - anisotropy));
}

TEST(Closures, TheAnisotropyInputGivesBothAlphas) {
  for (const float rho : {-1.0f, -0.2f, 0.0f, 0.7f}) {
    const Vec2 alphas = cycles_alphas(0.1f, anisotropy_input(rho));
    EXPECT_NEAR(alphas.x, 0.1f * std::exp(rho), 1e-6f);
    EXPECT_NEAR(alphas.y, 0.1f * std::exp(-rho), 1e-6f);
  }
}

}  // namespace
}  // namespace velour::closures_test
