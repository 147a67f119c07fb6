// Measurement -> fit -> model file -> model, through the C API alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "capi/test_scene.h"
#include "support/test_data.h"
#include "velour/velour.h"

namespace velour::test {
namespace {

/// A MERL file of f = (0.1, 0.2, 0.3) + a cosine-power highlight about the normal in theta_h.
std::string write_merl_file(const std::filesystem::path& folder) {
  constexpr int kThetaH = 90, kThetaD = 90, kPhiD = 180;
  const double scale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  std::vector<double> plane(size_t{kThetaH} * kThetaD * kPhiD);
  const std::string path = folder / "synthetic.binary";
  std::ofstream file(path, std::ios::binary);
  const int32_t header[3] = {kThetaH, kThetaD, kPhiD};
  file.write(reinterpret_cast<const char*>(header), sizeof header);
  for (int c = 0; c < 3; ++c) {
    size_t at = 0;
    for (int i = 0; i < kThetaH; ++i) {
      const double theta_h = i * i / 90.0 * 3.14159265358979 / 180;
      const double f = 0.1 * (c + 1) + 2.0 * std::pow(std::cos(theta_h), 60.0);
      for (int k = 0; k < kThetaD * kPhiD; ++k) plane[at++] = f / scale[c];
    }
    file.write(reinterpret_cast<const char*>(plane.data()),
               static_cast<std::streamsize>(plane.size() * sizeof(double)));
  }
  return path;
}

vlr_model* fitted(const vlr_measurement* measurement, int32_t kind) {
  vlr_fit_options options;
  vlr_fit_options_init(&options);
  options.model = kind;
  options.max_lobes = 6;
  options.tolerance = 0.05;
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_OK, vlr_fit_create_job(measurement, &options, &job)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  vlr_model* model = nullptr;
  EXPECT_EQ(VLR_OK, vlr_job_result_model(job, &model)) << vlr_last_error();
  vlr_job_free(job);
  return model;
}

class RoundTrip : public ::testing::TestWithParam<int32_t> {
 protected:
  void SetUp() override {
    folder_ = scratch_folder();
    ASSERT_EQ(VLR_OK, vlr_measurement_load(write_merl_file(folder_).c_str(), &measurement_)) << vlr_last_error();
    model_ = fitted(measurement_, GetParam());
    ASSERT_NE(model_, nullptr);
  }
  void TearDown() override {
    vlr_model_free(model_);
    vlr_measurement_free(measurement_);
  }
  std::filesystem::path folder_;
  vlr_measurement* measurement_ = nullptr;
  vlr_model* model_ = nullptr;
};
INSTANTIATE_TEST_SUITE_P(Models, RoundTrip, ::testing::Values(VLR_MODEL_SCATTERED, VLR_MODEL_PARAMETRIC));

/// The mean color of `scene`.
std::vector<double> mean_of(const TestScene& scene) {
  constexpr uint32_t kSide = 8;
  vlr_job* job = scene.render_job(kSide, 256);
  EXPECT_EQ(VLR_OK, vlr_job_start(job)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  std::vector<float> pixels(size_t{kSide} * kSide * 4);
  EXPECT_EQ(VLR_OK, vlr_job_read_pass(job, "Combined", pixels.data(), pixels.size())) << vlr_last_error();
  vlr_job_free(job);
  std::vector<double> mean(3);
  for (size_t i = 0; i < pixels.size(); ++i) {
    if (i % 4 < 3) mean[i % 4] += static_cast<double>(pixels[i]) / (kSide * kSide);
  }
  return mean;
}

TEST_P(RoundTrip, AModelTakesThePlaceOfAMaterialInACommittedScene) {
  const TestScene scene;
  const auto white = mean_of(scene);
  ASSERT_EQ(VLR_OK, vlr_scene_set_model_material(scene.scene, 0, model_, 0)) << vlr_last_error();
  const auto measured = mean_of(scene);
  EXPECT_NEAR(white[0], white[2], 1e-4);
  EXPECT_GT(measured[2], measured[0] + 0.2) << "0.5 pi (0.3 - 0.1) of the base";
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_scene_set_model_material(scene.scene, 1, model_, 0));
  EXPECT_NE(std::strstr(vlr_last_error(), "Material 1 does not exist"), nullptr) << vlr_last_error();
}

/// Leaves in `scene` only a square whose interpolated normals lean so far away that the camera is below their horizon,
/// of a measured layer and a black one. Returns its material.
uint32_t keep_leaning_square(const TestScene& scene, const vlr_measurement* measurement, int32_t surface_correction) {
  vlr_shader* shader = nullptr;
  EXPECT_EQ(VLR_OK, vlr_shader_create(&shader));
  vlr_principled_desc black;
  vlr_principled_desc_init(&black);
  std::fill_n(black.base_color, 3, 0.0f);
  black.specular = 0;
  black.surface_correction = surface_correction;
  vlr_layer_desc layer;
  vlr_layer_desc_init(&layer);
  layer.surface = &black;
  EXPECT_EQ(VLR_OK, vlr_shader_add_layer(shader, &layer)) << vlr_last_error();
  vlr_measured_layer_desc measured;
  vlr_measured_layer_desc_init(&measured);
  measured.measurement = measurement;
  EXPECT_EQ(VLR_OK, vlr_shader_add_measured_layer(shader, &measured)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_scene_clear_instances(scene.scene)) << vlr_last_error();
  const float positions[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const float normals[12] = {0.9f, 0, 0.4f, 0.9f, 0, 0.4f, 0.9f, 0, 0.4f, 0.9f, 0, 0.4f};
  const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
  vlr_mesh_desc desc{};
  desc.struct_size = sizeof desc;
  desc.vertex_count = 4;
  desc.triangle_count = 2;
  desc.positions = positions;
  desc.triangles = triangles;
  desc.vertex_normals = normals;
  uint32_t mesh = 0, dropped = 0, material = 0;
  EXPECT_EQ(VLR_OK, vlr_scene_add_mesh(scene.scene, &desc, &mesh, &dropped)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_scene_add_shader_material(scene.scene, shader, &material)) << vlr_last_error();
  vlr_shader_free(shader);
  const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  EXPECT_EQ(VLR_OK, vlr_scene_add_instance(scene.scene, mesh, identity, &material, 1)) << vlr_last_error();
  const float eye[3] = {-4, 0, 3}, target[3] = {0, 0, 0};
  EXPECT_EQ(VLR_OK, vlr_scene_look_at(scene.scene, eye, target, 0.1f, 1.0f));
  EXPECT_EQ(VLR_OK, vlr_scene_commit(scene.scene)) << vlr_last_error();
  return material;
}

/// Observes a material and reads the observation from its file.
vlr_status status_of_read_observation(const TestScene& scene, uint32_t material) {
  vlr_observe_options options;
  vlr_observe_options_init(&options);
  options.width = options.height = 8;
  vlr_job* job = nullptr;
  vlr_observation *observed = nullptr, *read = nullptr;
  EXPECT_EQ(VLR_OK, vlr_observe_create_job(scene.scene, material, &options, &job)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_result_observation(job, &observed)) << vlr_last_error();
  const std::string path = scratch_folder() / "observation.json";
  EXPECT_EQ(VLR_OK, vlr_observation_save(observed, path.c_str())) << vlr_last_error();
  const vlr_status status = vlr_observation_load(path.c_str(), &read);
  vlr_observation_free(read);
  vlr_observation_free(observed);
  vlr_job_free(job);
  return status;
}

TEST(MeasuredLayer, IsSeenAboveItsHorizonWhereTheNormalsOfAnotherLayerAreCorrected) {
  vlr_measurement* measurement = nullptr;
  ASSERT_EQ(VLR_OK, vlr_measurement_load(write_merl_file(scratch_folder()).c_str(), &measurement)) << vlr_last_error();
  const TestScene bent, corrected;
  keep_leaning_square(bent, measurement, VLR_RELIEF_AS_IT_IS);
  const uint32_t material = keep_leaning_square(corrected, measurement, VLR_RELIEF_TURNED);
  vlr_measurement_free(measurement);
  const auto expected = mean_of(bent), found = mean_of(corrected);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, 0.6) << c;
  EXPECT_EQ(VLR_OK, status_of_read_observation(corrected, material)) << vlr_last_error();
}

/// What an add-on does whose user cancels: `handle` is freed while `add` reads it.
template <typename Add, typename Free, typename Handle>
vlr_status status_when_freed_meanwhile(const Add& add, const Free& release, Handle*& handle) {
  vlr_status status = VLR_UNKNOWN;
  std::thread adding([&, borrowed = handle] { status = add(borrowed); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // of what takes some hundreds
  release(std::exchange(handle, nullptr));
  adding.join();
  return status;
}

TEST_P(RoundTrip, WhatBecomesAMaterialMayBeFreedMeanwhile) {
  const TestScene scene;
  uint32_t material = 0;
  const auto raw = [&](const vlr_measurement* measurement) {
    return vlr_scene_add_measurement_material(scene.scene, measurement, nullptr, 0, &material);
  };
  EXPECT_EQ(VLR_OK, status_when_freed_meanwhile(raw, vlr_measurement_free, measurement_)) << vlr_last_error();
}

TEST_P(RoundTrip, TheModelIsCloseToTheMeasurement) {
  const float wv[3] = {0.5f, 0, std::sqrt(0.75f)}, wl[3] = {-0.4f, 0.1f, std::sqrt(1 - 0.17f)};
  float raw[3], model[3];
  uint8_t valid = 0;
  ASSERT_EQ(VLR_OK, vlr_measurement_eval(measurement_, wv, 1, wl, raw, &valid));
  ASSERT_EQ(VLR_OK, vlr_model_eval(model_, wv, 1, wl, model, nullptr));
  EXPECT_EQ(valid, 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(model[c], raw[c], 0.15f * raw[c]);
}

TEST_P(RoundTrip, ARougherModelHasALowerAndWiderHighlight) {
  vlr_model *same = nullptr, *rougher = nullptr;
  ASSERT_EQ(VLR_OK, vlr_model_roughened(model_, 0, &same)) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_model_roughened(model_, 0.6f, &rougher)) << vlr_last_error();
  const float wv[3] = {0, 0, 1}, wl[6] = {0, 0, 1, 0.8f, 0, 0.6f};  // at the peak, and 53 degrees from it
  float before[6], zero[6], after[6];
  vlr_model_eval(model_, wv, 2, wl, before, nullptr);
  vlr_model_eval(same, wv, 2, wl, zero, nullptr);
  vlr_model_eval(rougher, wv, 2, wl, after, nullptr);
  EXPECT_EQ(0, std::memcmp(before, zero, sizeof before));
  EXPECT_LT(after[1], 0.8f * before[1]);
  EXPECT_GT(after[4], 1.1f * before[4]);
  vlr_model_free(same);
  vlr_model_free(rougher);
  vlr_model* none = nullptr;
  for (const float bad : {-0.1f, 1.5f, std::nanf("")}) {
    EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_model_roughened(model_, bad, &none));
    EXPECT_NE(std::strstr(vlr_last_error(), "it must be 0 to 1"), nullptr) << vlr_last_error();
  }
  EXPECT_EQ(none, nullptr);
}

TEST_P(RoundTrip, FileAndMemoryGiveTheSameModel) {
  const std::string path = folder_ / "model.velour";
  ASSERT_EQ(VLR_OK, vlr_model_save(model_, path.c_str())) << vlr_last_error();
  const void* bytes = nullptr;
  uint64_t size = 0;
  ASSERT_EQ(VLR_OK, vlr_model_bytes(model_, &bytes, &size));
  EXPECT_EQ(size, std::filesystem::file_size(path));
  vlr_model *from_file = nullptr, *from_memory = nullptr;
  ASSERT_EQ(VLR_OK, vlr_model_load(path.c_str(), &from_file)) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_model_load_memory(bytes, size, "memory", &from_memory)) << vlr_last_error();
  const float wv[3] = {0.6f, 0, 0.8f}, wl[3] = {-0.6f, 0, 0.8f};
  float a[3], b[3], c[3];
  vlr_model_eval(model_, wv, 1, wl, a, nullptr);
  vlr_model_eval(from_file, wv, 1, wl, b, nullptr);
  vlr_model_eval(from_memory, wv, 1, wl, c, nullptr);
  EXPECT_EQ(0, std::memcmp(a, b, sizeof a));
  EXPECT_EQ(0, std::memcmp(a, c, sizeof a));
  vlr_model_free(from_file);
  vlr_model_free(from_memory);
}

TEST_P(RoundTrip, SamplesCarryTheDensityThatEvalReports) {
  const float wv[3] = {0.6f, 0, 0.8f}, u[4] = {0.3f, 0.1f, 0.99f, 0.7f};
  float wl[6], pdf[2], f[6], again[2];
  ASSERT_EQ(VLR_OK, vlr_model_sample(model_, wv, 2, u, wl, pdf)) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_model_eval(model_, wv, 2, wl, f, again));
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(pdf[i], 0.0f);
    EXPECT_EQ(pdf[i], again[i]);
  }
  const float below[3] = {0, 0, -1};
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_model_sample(model_, below, 2, u, wl, pdf));
}

TEST_P(RoundTrip, TheBestGgxLobeIsJudgedToo) {
  vlr_job* job = nullptr;
  ASSERT_EQ(VLR_OK, vlr_compare_peer_create_job(measurement_, VLR_PEER_GGX, &job)) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  const char* text = nullptr;
  ASSERT_EQ(VLR_OK, vlr_job_report_json(job, &text)) << vlr_last_error();
  const std::string json = text;
  vlr_job_free(job);
  EXPECT_NE(json.find("\"by_view_angle\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"alpha\""), std::string::npos) << json;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_compare_peer_create_job(nullptr, VLR_PEER_GGX, &job));
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_compare_peer_create_job(measurement_, 7, &job));
}

TEST_P(RoundTrip, AModelHasAPeerWithoutItsMeasurement) {
  for (const int32_t peer : {VLR_PEER_GGX, VLR_PEER_PRINCIPLED, VLR_PEER_PLAIN_PRINCIPLED}) {
    vlr_job* job = nullptr;
    ASSERT_EQ(VLR_OK, vlr_model_peer_create_job(model_, peer, &job)) << vlr_last_error();
    ASSERT_EQ(VLR_OK, vlr_job_start(job));
    ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
    const char* text = nullptr;
    ASSERT_EQ(VLR_OK, vlr_job_report_json(job, &text)) << vlr_last_error();
    const char* own = peer == VLR_PEER_GGX ? "\"f90\"" : "\"specular_tint\"";
    EXPECT_NE(std::strstr(text, own), nullptr) << text;
    EXPECT_NE(std::strstr(text, "\"by_view_angle\""), nullptr) << text;
    vlr_job_free(job);
  }
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_model_peer_create_job(nullptr, VLR_PEER_PRINCIPLED, &job));
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_model_peer_create_job(model_, 3, &job));
}

TEST_P(RoundTrip, InfoNamesTheSource) {
  const char* json = nullptr;
  ASSERT_EQ(VLR_OK, vlr_model_info_json(model_, &json));
  EXPECT_NE(std::strstr(json, "\"name\":\"synthetic\""), nullptr) << json;
  EXPECT_NE(std::strstr(json, "\"85\""), nullptr) << json;
}

TEST_P(RoundTrip, InfoSaysWhatTheModelIs) {
  const char* json = nullptr;
  ASSERT_EQ(VLR_OK, vlr_model_info_json(model_, &json));
  const bool scattered = GetParam() == VLR_MODEL_SCATTERED;
  for (const char* key : {"\"lobes\":", "\"parameter_bytes\":", "\"bytes\":", "\"order\":", "\"chosen\":"}) {
    EXPECT_NE(std::strstr(json, key), nullptr) << key << " in " << json;
  }
  const std::string own[] = {"\"model\":\"scattered\"", "\"views\":", "\"max_lobes_per_view\":"};
  const std::string others[] = {"\"model\":\"parametric\"", "\"cells\":", "\"spaces\":{\"light\":"};
  for (const std::string& key : own) EXPECT_EQ(std::strstr(json, key.c_str()) != nullptr, scattered) << key;
  for (const std::string& key : others) EXPECT_EQ(std::strstr(json, key.c_str()) == nullptr, scattered) << key;
}

TEST_P(RoundTrip, AModelDrawsTheSamplesOfItsMeasurement) {
  vlr_scene* scene = nullptr;
  uint32_t material = 99;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_scene_add_measurement_material(scene, measurement_, model_, 0, &material)) << vlr_last_error();
  EXPECT_EQ(material, 0u);
  vlr_scene_free(scene);
}

/// What the call says to `options` with a measurement.
std::string fit_refusal(const vlr_measurement* measurement, const vlr_fit_options& options) {
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_fit_create_job(measurement, &options, &job));
  EXPECT_EQ(job, nullptr);
  return vlr_last_error();
}

TEST(FitOptions, UnknownModelsAndKernelsAreRefused) {
  vlr_measurement* measurement = nullptr;
  ASSERT_EQ(VLR_OK, vlr_measurement_load(write_merl_file(scratch_folder()).c_str(), &measurement)) << vlr_last_error();
  vlr_fit_options options;
  vlr_fit_options_init(&options);
  EXPECT_EQ(options.model, VLR_MODEL_AUTO);
  for (const int32_t unknown : {-1, 3}) {
    vlr_fit_options wrong = options;
    wrong.model = unknown;
    EXPECT_NE(fit_refusal(measurement, wrong).find("VLR_MODEL"), std::string::npos);
    wrong = options;
    wrong.kernel = unknown;
    EXPECT_NE(fit_refusal(measurement, wrong).find("VLR_KERNEL"), std::string::npos);
  }
  options.model = VLR_MODEL_PARAMETRIC;
  options.kernel = VLR_KERNEL_ABEL_POISSON;
  EXPECT_NE(fit_refusal(measurement, options).find("Gaussian"), std::string::npos);
  options.model = VLR_MODEL_SCATTERED;
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_OK, vlr_fit_create_job(measurement, &options, &job)) << vlr_last_error();
  vlr_job_free(job);
  vlr_measurement_free(measurement);
}

}  // namespace
}  // namespace velour::test
