#include "brdf/rgl.h"

#include <cmath>

#include "brdf/rgl_measurement.h"
#include "brdf/spectrum.h"
#include "brdf/tensor_file.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr uint64_t kMaxExtent = 1 << 20;

uint32_t extent(const TensorContainer& file, const std::string& field, size_t axis) {
  const uint64_t n = file.shape(field)[axis];
  if (n < 2 || n > kMaxExtent)
    file.fail(field, "has an extent of " + std::to_string(n) + " in dimension " + std::to_string(axis) +
                         "; it must be 2 to 1048576.");
  return static_cast<uint32_t>(n);
}

void check_extent(const TensorContainer& file, const std::string& field, size_t axis, size_t expected,
                  const std::string& other) {
  if (file.shape(field)[axis] != expected)
    file.fail(field, "has an extent of " + std::to_string(file.shape(field)[axis]) + " in dimension " +
                         std::to_string(axis) + ", but " + other + " has " + std::to_string(expected) + ".");
}

std::vector<float> angles(const TensorContainer& file, const std::string& field, float low, float high) {
  auto values = file.floats(field, 1);
  for (size_t i = 0; i < values.size(); ++i) {
    const bool rises = i == 0 || values[i] > values[i - 1];
    if (!(values[i] >= low && values[i] <= high) || !rises)
      file.fail(field, "has " + std::to_string(values[i]) + " at index " + std::to_string(i) +
                           "; angles must increase from " + std::to_string(low) + " to " + std::to_string(high) + ".");
  }
  return values;
}

/// Reads densities or areas: finite and not negative.
std::vector<float> densities(const TensorContainer& file, const std::string& field, size_t rank) {
  auto values = file.floats(field, rank);
  for (size_t i = 0; i < values.size(); ++i)
    if (!(values[i] >= 0.0f && std::isfinite(values[i])))
      file.fail(field, "has " + std::to_string(values[i]) + " at index " + std::to_string(i) +
                           "; it must be finite and not negative.");
  return values;
}

AngleGrid angle_grid(const TensorContainer& file, const std::string& field) {
  AngleGrid grid;
  grid.values = densities(file, field, 2);
  grid.height = extent(file, field, 0);
  grid.width = extent(file, field, 1);
  return grid;
}

void check_views(const TensorContainer& file, const std::string& field, const RglTables& tables) {
  check_extent(file, field, 0, tables.phi_v.size(), "phi_i");
  check_extent(file, field, 1, tables.theta_v.size(), "theta_i");
}

void read_warp(const TensorContainer& file, RglTables& tables) {
  tables.visible_normals = densities(file, "vndf", 4);
  check_views(file, "vndf", tables);
  tables.warp_height = extent(file, "vndf", 2);
  tables.warp_width = extent(file, "vndf", 3);
}

/// Weights of the channels of the color field: the unit matrix for "rgb", the observer for "spectra".
std::vector<Vec3d> channel_weights(const TensorContainer& file, const std::string& field) {
  if (field == "rgb") {
    check_extent(file, field, 2, 3, "a color");
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  }
  const auto read = file.floats("wavelengths", 1);
  check_extent(file, field, 2, read.size(), "wavelengths");
  const std::vector<double> wavelengths(read.begin(), read.end());
  try {
    check_wavelengths(wavelengths, "");
  } catch (const Error& error) {
    file.fail("wavelengths", std::string(error.what()).substr(1));
  }
  return rec709_weights(wavelengths);
}

void read_colour(const TensorContainer& file, RglTables& tables) {
  const std::string field = file.has("rgb") ? "rgb" : "spectra";
  const auto values = file.floats(field, 5);
  check_views(file, field, tables);
  tables.height = extent(file, field, 3);
  tables.width = extent(file, field, 4);
  const auto weights = channel_weights(file, field);
  const size_t slice = static_cast<size_t>(tables.width) * tables.height;
  const size_t views = tables.phi_v.size() * tables.theta_v.size();
  tables.colour.resize(views * slice);
  std::vector<float> channels(weights.size());
  for (size_t i = 0; i < tables.colour.size(); ++i) {
    for (size_t c = 0; c < channels.size(); ++c)
      channels[c] = values[(i / slice * channels.size() + c) * slice + i % slice];
    tables.colour[i] = rec709_of(weights, channels);
  }
}

}  // namespace

bool looks_like_rgl(std::span<const uint8_t> head) { return looks_like_tensor_file(head); }

std::shared_ptr<const Measurement> read_rgl(std::span<const uint8_t> bytes, Provenance provenance) {
  const TensorContainer file(bytes, provenance.path);
  RglTables tables;
  tables.phi_v = angles(file, "phi_i", -4.0f * kPi, 4.0f * kPi);
  tables.theta_v = angles(file, "theta_i", 0.0f, 0.5f * kPi + 1e-4f);
  tables.normals = angle_grid(file, "ndf");
  tables.projected_area = angle_grid(file, "sigma");
  read_warp(file, tables);
  read_colour(file, tables);
  tables.microfacet_scale = file.get("jacobian", TensorType::uint8, 1).bytes[0] != 0;
  provenance.format = "rgl";
  if (file.has("description")) provenance.description = file.text("description");
  return std::make_shared<RglMeasurement>(std::move(tables), std::move(provenance));
}

}  // namespace velour
