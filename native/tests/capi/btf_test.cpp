// BTFs through the C boundary: right and wrong calls.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/test_data.h"
#include "velour/velour.h"

namespace {

#define EXPECT_STATUS(expected, call)                    \
  do {                                                   \
    EXPECT_EQ(expected, (call)) << vlr_last_error();     \
    EXPECT_GT(std::string(vlr_last_error()).size(), 5u); \
  } while (false)

bool last_error_has(const char* text) { return std::string(vlr_last_error()).find(text) != std::string::npos; }

/// One pair of 2 x 1 texels, light at 60 degrees.
std::filesystem::path written_set() {
  const auto folder = velour::test::scratch_folder();
  const float pixels[] = {0.25f, 0.5f, 0.75f, 1, 2, 3};
  EXPECT_EQ(VLR_OK, vlr_image_write((folder / "tl060 pl000 tv000 pv000.exr").c_str(), 2, 1, 3, pixels));
  return folder;
}

class BtfHandle {
 public:
  explicit BtfHandle(const std::string& path, const vlr_btf_options* options = nullptr) {
    EXPECT_EQ(VLR_OK, vlr_btf_load(path.c_str(), options, &btf_)) << vlr_last_error();
  }
  ~BtfHandle() { vlr_btf_free(btf_); }
  BtfHandle(const BtfHandle&) = delete;
  BtfHandle& operator=(const BtfHandle&) = delete;
  vlr_btf* get() const { return btf_; }

 private:
  vlr_btf* btf_ = nullptr;
};

TEST(Btf, NullArgumentsAreNamed) {
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_load(nullptr, nullptr, nullptr));
  EXPECT_TRUE(last_error_has("path"));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_load("x", nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_info_json(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_angles(nullptr, nullptr, 0));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_read(nullptr, 0, 1, nullptr, 0));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_export_create_job(nullptr, "x", nullptr));
  vlr_btf_free(nullptr);
}

TEST(Btf, CompressOptionsAreChecked) {
  const BtfHandle btf(written_set());
  vlr_compress_options options;
  vlr_compress_options_init(&options);
  EXPECT_EQ(options.struct_size, sizeof(options));
  EXPECT_EQ(options.method, VLR_COMPRESS_SRBF);
  EXPECT_EQ(options.companding, VLR_COMPAND_ROOT);
  vlr_job* job = nullptr;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_compress_create_job(nullptr, &options, &job));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_compress_create_job(btf.get(), &options, nullptr));
  options.method = 99;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_compress_create_job(btf.get(), &options, &job));
  EXPECT_TRUE(last_error_has("vlr_compress_options.method is 99"));
  vlr_compress_options_init(&options);
  options.companding = -1;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_compress_create_job(btf.get(), &options, &job));
  EXPECT_EQ(job, nullptr);
}

/// One pair of two texels is enough for any method.
TEST(Btf, EveryMethodMakesAModel) {
  const BtfHandle btf(written_set());
  for (const int32_t method : {VLR_COMPRESS_SVD, VLR_COMPRESS_SRBF, VLR_COMPRESS_SVD_VIEW}) {
    vlr_compress_options options;
    vlr_compress_options_init(&options);
    options.method = method;
    vlr_job* job = nullptr;
    ASSERT_EQ(VLR_OK, vlr_compress_create_job(btf.get(), &options, &job)) << vlr_last_error();
    EXPECT_EQ(VLR_OK, vlr_job_start(job));
    int32_t finished = 0;
    EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, &finished)) << vlr_last_error();
    vlr_model* model = nullptr;
    ASSERT_EQ(VLR_OK, vlr_job_result_model(job, &model)) << vlr_last_error();
    const char* json = nullptr;
    ASSERT_EQ(VLR_OK, vlr_model_info_json(model, &json));
    EXPECT_NE(std::string(json).find(method == VLR_COMPRESS_SRBF ? "srbf-btf" : "factored-btf"), std::string::npos);
    vlr_model_free(model);
    vlr_job_free(job);
  }
}

TEST(Btf, MissingFilesAreNamed) {
  vlr_btf* btf = nullptr;
  EXPECT_STATUS(VLR_IO, vlr_btf_load("/nowhere/at all.btf", nullptr, &btf));
  EXPECT_TRUE(last_error_has("/nowhere/at all.btf"));
  EXPECT_EQ(btf, nullptr);
}

TEST(Btf, OptionsAreChecked) {
  const std::string path = written_set();
  vlr_btf_options options;
  vlr_btf_options_init(&options);
  EXPECT_EQ(options.struct_size, sizeof(options));
  vlr_btf* btf = nullptr;
  options.values = 4;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_load(path.c_str(), &options, &btf));
  EXPECT_TRUE(last_error_has("vlr_btf_options.values is 4"));
  vlr_btf_options_init(&options);
  options.colors = -1;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_load(path.c_str(), &options, &btf));
  vlr_btf_options_init(&options);
  options.gamma = -2;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_load(path.c_str(), &options, &btf));
  vlr_btf_options_init(&options);
  options.tile_metres[0] = 1;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_load(path.c_str(), &options, &btf));
  options.struct_size = sizeof(options) + 4;
  EXPECT_STATUS(VLR_VERSION_MISMATCH, vlr_btf_load(path.c_str(), &options, &btf));
}

TEST(Btf, GivesItsPairs) {
  const BtfHandle btf(written_set());
  double angles[4];
  ASSERT_EQ(VLR_OK, vlr_btf_angles(btf.get(), angles, 4));
  EXPECT_EQ(angles[0], 60);
  EXPECT_EQ(angles[3], 0);
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_angles(btf.get(), angles, 3));
  std::vector<uint16_t> halves(6);
  ASSERT_EQ(VLR_OK, vlr_btf_read(btf.get(), 0, 1, halves.data(), 6));
  EXPECT_EQ(halves[4], 0x3d18);  // 2 / (pi cos 60 degrees) = 1.273
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_read(btf.get(), 0, 1, halves.data(), 5));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_read(btf.get(), 1, 1, halves.data(), 6));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_read(btf.get(), 0, ~uint64_t{0}, halves.data(), 6));
}

TEST(Btf, TellsOfItselfByHandleAndByPath) {
  const std::string path = written_set();
  const BtfHandle btf(path);
  const char *of_handle = nullptr, *of_path = nullptr;
  ASSERT_EQ(VLR_OK, vlr_btf_info_json(btf.get(), &of_handle));
  ASSERT_EQ(VLR_OK, vlr_file_info_json(path.c_str(), &of_path));
  EXPECT_STREQ(of_handle, of_path);
  EXPECT_NE(std::string(of_path).find(R"("kind":"btf")"), std::string::npos);
}

TEST(Btf, IsAMaterialItself) {
  const BtfHandle btf(written_set());
  vlr_scene* scene = nullptr;
  uint32_t material = 99;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_scene_add_btf_material(scene, btf.get(), 0, &material)) << vlr_last_error();
  EXPECT_EQ(material, 0u);
  EXPECT_STATUS(VLR_UNSUPPORTED, vlr_scene_add_btf_material(scene, btf.get(), 17, &material));  // 2 + 1 texels
  EXPECT_TRUE(last_error_has("the limit is"));
  EXPECT_EQ(VLR_OK, vlr_scene_add_btf_material(scene, btf.get(), 18, &material)) << vlr_last_error();
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_add_btf_material(nullptr, btf.get(), 0, &material));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_add_btf_material(scene, nullptr, 0, &material));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_add_btf_material(scene, btf.get(), 0, nullptr));
  vlr_scene_free(scene);
}

TEST(Btf, AnExportKeepsWhatItNeeds) {
  const std::string path = written_set(), target = path + "/out";
  vlr_job* job = nullptr;
  {
    const BtfHandle btf(path);
    ASSERT_EQ(VLR_OK, vlr_btf_export_create_job(btf.get(), target.c_str(), &job));
  }
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  int32_t finished = 0;
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, &finished));
  vlr_job_free(job);
  EXPECT_TRUE(std::filesystem::exists(target + "/00000 tl060 pl000 tv000 pv000.exr"));
}

}  // namespace
