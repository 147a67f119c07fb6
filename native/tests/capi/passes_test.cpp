// Passes across the C boundary: what is asked for is there, what is not is refused.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "capi/test_scene.h"

namespace velour::test {
namespace {

vlr_job* job_with(const TestScene& scene, const vlr_pass_options* passes) {
  vlr_render_options options;
  vlr_render_options_init(&options);
  options.width = options.height = 4;
  options.spp = 8;
  options.passes = passes;
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_OK, vlr_render_create_job(scene.scene, &options, &job)) << vlr_last_error();
  return job;
}

vlr_pass_options asked(uint32_t bits) {
  vlr_pass_options passes;
  vlr_pass_options_init(&passes);
  passes.asked = bits;
  return passes;
}

TEST(CPasses, LabelsReachThePixels) {
  const TestScene scene;
  vlr_pass_options passes = asked(VLR_PASS_OBJECT_INDEX | VLR_PASS_MATERIAL_INDEX | VLR_PASS_CRYPTO_OBJECT);
  vlr_instance_label of_square{};
  of_square.index = 4;
  of_square.uv_set = -1;
  EXPECT_EQ(VLR_OK, vlr_cryptomatte_id("Square", nullptr, &of_square.object_id));
  vlr_material_label white{};
  white.index = 6;
  passes.instances = &of_square;
  passes.materials = &white;
  passes.instance_count = passes.material_count = 1;
  vlr_job* job = job_with(scene, &passes);
  of_square.index = white.index = 0;  // they have been copied
  EXPECT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  std::vector<float> object(16), material(16), ids(64);
  EXPECT_EQ(VLR_OK, vlr_job_read_pass(job, "IndexOB", object.data(), object.size())) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_read_pass(job, "IndexMA", material.data(), material.size())) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_read_pass(job, "CryptoObject00", ids.data(), ids.size())) << vlr_last_error();
  for (size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(object[i], 4);
    EXPECT_EQ(material[i], 6);
    EXPECT_EQ(ids[4 * i], of_square.object_id);
    EXPECT_EQ(ids[4 * i + 1], 1);
  }
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_job_read_pass(job, "Mist", object.data(), object.size()));
  EXPECT_NE(std::string(vlr_last_error()).find("not requested"), std::string::npos);
  vlr_job_free(job);
}

TEST(CPasses, IdsAreTheBitsOfTheHash) {
  uint32_t hash = 0, bits = 0;
  float id = 0;
  EXPECT_EQ(VLR_OK, vlr_cryptomatte_id("hello", &hash, &id));
  std::memcpy(&bits, &id, sizeof bits);
  EXPECT_EQ(hash, 0x248bfa47u);
  EXPECT_EQ(bits, hash);
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_cryptomatte_id(nullptr, &hash, &id));
}

TEST(CPasses, WhatMakesNoSenseIsRefused) {
  const TestScene scene;
  vlr_render_options options;
  vlr_render_options_init(&options);
  vlr_job* job = nullptr;
  const auto refused = [&](const vlr_pass_options& passes) {
    options.passes = &passes;
    return vlr_render_create_job(scene.scene, &options, &job);
  };
  vlr_pass_options passes = asked(1u << 20);
  EXPECT_EQ(VLR_INVALID_ARGUMENT, refused(passes));
  passes = asked(VLR_PASS_CRYPTO_ASSET);
  passes.cryptomatte_ranks = 17;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, refused(passes));
  passes = asked(VLR_PASS_MIST);
  passes.instance_count = 1;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, refused(passes));
  passes = asked(VLR_PASS_MIST);
  passes.struct_size += 8;
  EXPECT_EQ(VLR_VERSION_MISMATCH, refused(passes));
}

}  // namespace
}  // namespace velour::test
