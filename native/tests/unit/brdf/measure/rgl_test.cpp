#include "brdf/formats/rgl.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/process.h"
#include "measurement_support.h"
#include "support/test_data.h"

namespace velour::rgl_test {
namespace {

using test::eval_one;
using test::small_rgl;
using test::TensorFileBuilder;

std::shared_ptr<const Measurement> read(const TensorFileBuilder& builder) {
  return read_rgl(builder.bytes(), test::provenance_named("x.bsdf"));
}
std::string refusal(const TensorFileBuilder& builder) {
  return test::refusal([&] { read(builder); });
}
Rgb gray(size_t, size_t, size_t, size_t) { return Rgb(1.0f); }

TEST(BilinearWarp, InverseOfItself) {
  std::vector<float> values;
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 3 * 6 * 7; ++i) values.push_back(i % 11 == 0 ? 0.0f : random.next());
  const BilinearWarp warp(values, 7, 6);
  SliceMix mix;
  mix.add(0, 0.25f);
  mix.add(2, 0.75f);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 u = random.next2();
    Vec2 back;
    ASSERT_TRUE(warp.invert(mix, warp.warp(mix, u), back));
    EXPECT_NEAR(back.x, u.x, 2e-5f);
    EXPECT_NEAR(back.y, u.y, 2e-5f);
  }
}

/// A file may have 2^20 nodes a side; a search from the first would take minutes for all of them.
TEST(BilinearWarp, ManyNodesTakeNoTime) {
  constexpr uint32_t kNodes = 1 << 18;
  const std::vector<float> values(2 * kNodes, 1.0f);
  SliceMix mix;
  mix.add(0, 1.0f);
  const BilinearWarp wide(values, kNodes, 2), high(values, 2, kNodes);
  const double start = thread_seconds();
  for (int i = 0; i < 20000; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / 20000;
    ASSERT_NEAR(wide.warp(mix, {u, 0.5f}).x, u, 1e-4f);
    ASSERT_NEAR(high.warp(mix, {0.5f, u}).y, u, 1e-4f);
  }
  EXPECT_LT(thread_seconds() - start, 1.0);
}

TEST(BilinearWarp, MarginalsOfAProductDensity) {
  // Density 2x of x and 1 of y: u = (x^2, y).
  std::vector<float> values;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) values.push_back(static_cast<float>(x));
  const BilinearWarp warp(values, 5, 4);
  SliceMix mix;
  mix.add(0, 1.0f);
  for (const float x : {0.1f, 0.37f, 0.5f, 0.99f}) {
    Vec2 u;
    ASSERT_TRUE(warp.invert(mix, {x, 0.3f}, u));
    EXPECT_NEAR(u.x, x * x, 1e-5f);
    EXPECT_NEAR(u.y, 0.3f, 1e-5f);
  }
}

TEST(BilinearWarp, EmptyRowIsNotInverted) {
  const BilinearWarp warp(std::vector<float>{0, 0, 0, 0, 1, 1}, 2, 3);
  SliceMix mix;
  mix.add(0, 1.0f);
  Vec2 u;
  EXPECT_FALSE(warp.invert(mix, {0.5f, 0.25f}, u));
  EXPECT_TRUE(warp.invert(mix, {0.5f, 0.75f}, u));
}

TEST(Rgl, ScaleOfTheMicrofacetForm) {
  // With color 1, D = 2 and sigma = 0.5: f cos = 1.
  const auto measurement = read(small_rgl({0.0f}, gray));
  EXPECT_TRUE(measurement->isotropic());
  EXPECT_EQ(measurement->provenance().description, "synthetic");
  for (const auto& [wl, wv] : test::random_pairs(2000, 1)) {
    const auto [f, valid] = eval_one(*measurement, wl, wv);
    ASSERT_TRUE(valid);
    EXPECT_NEAR(f.g * wl.z, 1.0f, 1e-5f);
  }
}

TEST(Rgl, WithoutJacobianTheColorIsFCos) {
  auto builder = small_rgl({0.0f}, gray).remove("jacobian").add("jacobian", 1, {1}, std::vector<uint8_t>{0});
  builder.remove("sigma").floats("sigma", {2, 2}, {9, 9, 9, 9});
  const auto [f, valid] = eval_one(*read(builder), direction(0.3f, 1), direction(0.8f, 2));
  EXPECT_NEAR(f.r * std::cos(0.3f), 1.0f, 1e-6f);
}

TEST(Rgl, ColorBelongsToTheViewAndNotToTheLight) {
  // A deliberately non-reciprocal file: color grows with the view's index.
  const auto measurement =
      read(small_rgl({0.0f}, [](size_t, size_t t, size_t, size_t) { return Rgb(static_cast<float>(t)); }));
  const Vec3 at_half = direction(0.5f, 0.2f), at_one = direction(1.0f, 3.0f);
  EXPECT_NEAR(eval_one(*measurement, at_one, at_half).f.r * at_one.z, 1.0f, 1e-5f);
  EXPECT_NEAR(eval_one(*measurement, at_half, at_one).f.r * at_half.z, 2.0f, 1e-5f);
}

TEST(Rgl, ColorIsLookedUpAtTheHalfVector) {
  // The warp is the identity, so the texel is sqrt(2 theta_h / pi) across and (phi_h - phi_v + pi) / (2 pi) up.
  const auto measurement = read(small_rgl({0.0f}, [](size_t, size_t, size_t y, size_t x) {
    return Rgb(static_cast<float>(x) / 4, static_cast<float>(y) / 3, 1.0f);
  }));
  for (const auto& [wl, wv] : test::random_pairs(2000, 4)) {
    const Vec3 h = glm::normalize(wl + wv);
    const double theta = std::acos(std::min(1.0, double{h.z}));
    if (theta < 0.01) continue;
    double turns = (std::atan2(double{h.y}, double{h.x}) - std::atan2(double{wv.y}, double{wv.x})) / (2 * kPiD) + 0.5;
    turns -= std::floor(turns);
    const Rgb f = eval_one(*measurement, wl, wv).f * wl.z;
    EXPECT_NEAR(double{f.r}, std::sqrt(theta * 2 / kPiD), 2e-4);
    EXPECT_TRUE(turns < 0.001 || turns > 0.999 || std::abs(double{f.g} - turns) < 2e-4) << turns;
  }
}

TEST(Rgl, SymmetryOfSectors) {
  const auto color = [](size_t p, size_t t, size_t y, size_t x) {
    return Rgb(static_cast<float>(p * 7 + t * 3 + y * 2 + x));
  };
  const auto half = read(small_rgl({-kPi, -2.0f, -1.0f, 0.0f}, color));
  const auto quarter = read(small_rgl({-kPi, -2.4f, -1.9f, -kPi / 2}, color));
  EXPECT_FALSE(half->isotropic());
  float most = 0;
  for (const auto& [wl, wv] : test::random_pairs(500, 2)) {
    const Rgb a = eval_one(*half, wl, wv).f, b = eval_one(*half, test::rotated(wl, kPi), test::rotated(wv, kPi)).f;
    EXPECT_LT(glm::length(a - b), 2e-3f * glm::length(a));
    const Rgb c = eval_one(*quarter, wl, wv).f;
    const Rgb d = eval_one(*quarter, wl * Vec3(-1, 1, 1), wv * Vec3(-1, 1, 1)).f;
    EXPECT_LT(glm::length(c - d), 2e-3f * glm::length(c));
    most = std::max(most, glm::length(a - eval_one(*half, test::rotated(wl, 1), test::rotated(wv, 1)).f));
  }
  EXPECT_GT(most, 1.0f);
}

TEST(Rgl, FlatSpectraAreGray) {
  auto builder = small_rgl({0.0f}, gray).remove("rgb");
  builder.floats("wavelengths", {2}, {400, 700}).floats("spectra", {1, 4, 2, 4, 5}, std::vector<float>(160, 0.25f));
  const auto [f, valid] = eval_one(*read(builder), direction(0.3f, 1), direction(0.8f, 2));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[c] * std::cos(0.3f), 0.25f, 1e-6f);
  builder.remove("wavelengths").floats("wavelengths", {2}, {700, 400});
  EXPECT_NE(refusal(builder).find("field wavelengths has 400"), std::string::npos) << refusal(builder);
}

TEST(Rgl, CountsItsEntries) {
  const auto measurement = read(small_rgl({0.0f}, [](size_t, size_t t, size_t y, size_t x) {
    if (t != 0 || y != 2) return Rgb(1.0f);
    return x == 0 ? Rgb(-1.0f) : x == 1 ? Rgb(NAN) : Rgb(-0.1f, 1.0f, 1.0f);
  }));
  const auto& counts = measurement->counts();
  EXPECT_EQ(counts.total, 80u);
  EXPECT_EQ(counts.negative, 1u);
  EXPECT_EQ(counts.not_finite, 1u);
  EXPECT_GE(counts.out_of_gamut, 1u);
  EXPECT_GT(counts.below_horizon, 0u);
  EXPECT_EQ(counts.total, counts.valid + counts.invalid() + counts.below_horizon);
}

TEST(Rgl, NoViewBeyondTheLastTheta) {
  auto builder = small_rgl({0.0f}, gray).remove("theta_i").floats("theta_i", {4}, {0.0f, 0.3f, 0.6f, 1.0f});
  const auto measurement = read(builder);
  EXPECT_TRUE(measurement->covers_view(0.99f));
  EXPECT_FALSE(measurement->covers_view(1.1f));
  EXPECT_FALSE(eval_one(*measurement, Vec3(0, 0, 1), direction(1.1f, 0)).valid);
}

TEST(Rgl, RefusesLies) {
  const std::vector<float> phi{0.0f};
  const auto good = small_rgl(phi, gray);
  EXPECT_EQ(refusal(good), "");
  for (const char* field : {"phi_i", "theta_i", "ndf", "sigma", "vndf", "rgb", "jacobian"})
    EXPECT_NE(refusal(TensorFileBuilder(good).remove(field)).find("missing"), std::string::npos) << field;
  const auto with = [&](const char* field, std::vector<uint64_t> shape, std::vector<float> values) {
    return refusal(TensorFileBuilder(good).remove(field).floats(field, shape, values));
  };
  EXPECT_NE(with("theta_i", {4}, {0, 2, 1, 1.5f}).find("theta_i has"), std::string::npos);
  EXPECT_NE(with("theta_i", {4}, {0, 0.5f, NAN, 1.5f}).find("theta_i has nan"), std::string::npos);
  EXPECT_NE(with("theta_i", {3}, {0, 0.5f, 1.0f}).find("but theta_i has 3"), std::string::npos);
  EXPECT_NE(with("ndf", {2, 2}, {1, 1, -1, 1}).find("ndf has -1"), std::string::npos);
  EXPECT_NE(with("sigma", {1, 4}, {1, 1, 1, 1}).find("sigma has an extent of 1"), std::string::npos);
  EXPECT_NE(with("vndf", {1, 4, 2, 2}, std::vector<float>(16, INFINITY)).find("vndf has inf"), std::string::npos);
  EXPECT_NE(with("rgb", {1, 4, 2, 4, 5}, std::vector<float>(160)).find("rgb has an extent of 2"), std::string::npos);
  EXPECT_NE(refusal(small_rgl({0.0f, 0.1f, 0.2f}, gray)).find("phi_i spans"), std::string::npos);
}

/// Values of Mitsuba 3.9.1's `measured` (f cos) at these directions: (theta_v, phi_v, theta_l, phi_l).
TEST(Rgl, AgreesWithThePublishedImplementation) {
  constexpr float kAngles[][4] = {{0.6f, 0.3f, 0.5f, 3.3f}, {0.2f, 1.0f, 0.9f, 2.0f},  {1.2f, 4.0f, 1.0f, 1.0f},
                                  {1.4f, 0.0f, 0.1f, 2.5f}, {0.01f, 0.0f, 0.7f, 5.0f}, {0.8f, 2.2f, 0.82f, 5.3f}};
  const std::map<std::string, std::vector<Rgb>> expected = {{"satin_rosaline_rgb",
                                                             {{0.879055917f, 0.553575814f, 0.663461387f},
                                                              {0.0992779359f, 0.12842162f, 0.119289704f},
                                                              {0.38630718f, 0.226830363f, 0.216414317f},
                                                              {0.139151201f, 0.165186256f, 0.154790193f},
                                                              {0.135197252f, 0.169041991f, 0.155865878f},
                                                              {2.2376616f, 1.57924235f, 1.66577613f}}},
                                                            {"paper_white_rgb",
                                                             {{0.239115834f, 0.242082044f, 0.280604869f},
                                                              {0.153411731f, 0.156186476f, 0.183866322f},
                                                              {0.197152361f, 0.196658283f, 0.215352088f},
                                                              {0.248092994f, 0.251315475f, 0.293760419f},
                                                              {0.201522499f, 0.205365226f, 0.241769344f},
                                                              {0.207943082f, 0.209198833f, 0.237893581f}}},
                                                            {"cc_iris_purple_gem_rgb",
                                                             {{0.221877918f, 0.419255406f, 1.53492534f},
                                                              {-0.000414652663f, 0.000965072482f, 0.00509393867f},
                                                              {0.295853227f, 0.106175713f, 0.240811408f},
                                                              {9.86950618e-05f, 0.00109836936f, 0.00470131775f},
                                                              {-0.000197745772f, 0.00601672847f, 0.0187641848f},
                                                              {2.22272468f, 1.58355522f, 3.03917742f}}}};
  for (const auto& [name, values] : expected) {
    VELOUR_NEED_DATA(path, "brdf/" + name + ".bsdf");
    const auto measurement = load_measurement(path);
    for (size_t i = 0; i < values.size(); ++i) {
      const Vec3 wv = direction(kAngles[i][0], kAngles[i][1]), wl = direction(kAngles[i][2], kAngles[i][3]);
      const auto [f, valid] = eval_one(*measurement, wl, wv);
      ASSERT_TRUE(valid);
      EXPECT_LT(glm::length(f * wl.z - values[i]), 1e-5f * glm::length(values[i]) + 1e-7f) << name << " " << i;
    }
  }
}

TEST(Rgl, RealFilesHaveSaneAlbedo) {
  VELOUR_NEED_DATA(path, "brdf/paper_white_rgb.bsdf");
  const auto paper = load_measurement(path);
  Rgb albedo(0.0f);
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 20000; ++i)
    albedo += kPi * eval_one(*paper, sample_cosine_hemisphere(random.next2()), direction(0.5f, 0)).f / 20000.0f;
  EXPECT_GT(albedo.g, 0.75f);
  EXPECT_LT(albedo.g, 0.9f);
}

}  // namespace
}  // namespace velour::rgl_test
