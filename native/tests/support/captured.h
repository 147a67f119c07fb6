// Captures of small tiles, ready to be looked at.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "btf/formats/btf_folder.h"
#include "capture/btf/btf_capture.h"
#include "support/statistics.h"
#include "support/test_data.h"
#include "support/test_scene.h"

namespace velour::test {

/// A folder that is there while this is; empty at first.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name) : path_(scratch_root() / name) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_.parent_path());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// A committed scene of one mesh.
inline std::unique_ptr<Scene> tile_of(Mesh mesh, std::shared_ptr<const Material> material) {
  auto scene = std::make_unique<Scene>();
  scene->add_material({.material = std::move(material)});
  scene->add_instance(scene->add_mesh(std::move(mesh)), {}, {0});
  scene->commit(1);
  return scene;
}

/// Rectangle (x0, y0) to (x1, y1) at height z, as two triangles.
struct Corners {
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;

  Corners& quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto first = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c, d});
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
    return *this;
  }
  Corners& rectangle(float x0, float y0, float x1, float y1, float z = 0) {
    return quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
  }
  Mesh mesh() const {
    return Mesh({.positions = positions, .triangles = triangles, .smooth = std::vector<uint8_t>(triangles.size(), 0)});
  }
};

/// Grooves along y with faces of 45 degrees; ridge at x = 0, period 1, height 1/2.
inline Mesh sawtooth() {
  Corners c;
  c.quad({0, 0, 0.5f}, {0.5f, 0, 0}, {0.5f, 1, 0}, {0, 1, 0.5f});
  c.quad({0.5f, 0, 0}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0.5f, 1, 0});
  return c.mesh();
}

/// 16 texels a side, few directions, one side.
inline BtfCaptureOptions small_capture(std::vector<PolarAngles> views, std::vector<PolarAngles> lights) {
  BtfCaptureOptions options;
  options.place.period = {1, 1};
  options.texels[0] = options.texels[1] = 16;
  options.views = std::move(views);
  options.lights = std::move(lights);
  options.sides = CaptureSides::one;
  options.reference_height = 0;
  options.sampling.seed = 3;
  options.threads = 2;
  return options;
}

/// A capture that was made, and read again.
struct Captured {
  Captured(const Scene& scene, const BtfCaptureOptions& options, const std::string& name = "capture") {
    const ScratchFolder folder(name);
    Progress progress;
    report = capture_btf(scene, options, folder.path(), progress);
    const auto btf = load_btf_folder(folder.path());
    texels = btf->grid().texels();
    lights = btf->layout().lights().size();
    const uint64_t pairs = btf->layout().pairs();
    values.resize(pairs * texels * 3);
    errors.resize(pairs * texels);
    std::vector<HalfBits> bits(values.size());
    btf->read_pairs(0, pairs, bits);
    halves_to_floats(bits, values);
    bits.resize(errors.size());
    if (btf->read_errors(0, pairs, bits)) halves_to_floats(bits, errors);
    for (uint32_t v = 0; v < btf->layout().views().size(); ++v) structure.push_back(*btf->read_structure(v));
  }

  float green(size_t pair, size_t texel) const { return values[3 * (pair * texels + texel) + 1]; }
  float error(size_t pair, size_t texel) const { return errors[pair * texels + texel]; }
  /// Mean over the texels, with a standard error that is an upper bound.
  Estimate mean(size_t pair) const {
    double sum = 0, variance = 0;
    for (size_t t = 0; t < texels; ++t) {
      sum += static_cast<double>(green(pair, t));
      variance += static_cast<double>(error(pair, t)) * static_cast<double>(error(pair, t));
    }
    const double n = static_cast<double>(texels);
    return {sum / n, std::sqrt(variance) / n};
  }

  BtfCaptureReport report;
  size_t texels = 0, lights = 0;
  std::vector<float> values, errors;
  std::vector<ViewStructure> structure;
};

}  // namespace velour::test
