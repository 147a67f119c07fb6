#include "brdf/formats/rgl.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "brdf/formats/tensor_file.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"
#include "brdf/measure/spectrum.h"

namespace velour {

namespace {

/// Integral over [0, t] of a function that is linear from a to b over [0, 1].
float ramp_integral(float a, float b, float t) { return t * (a + 0.5f * t * (b - a)); }

/// t with ramp_integral(a, b, t) = `area`: the form of the quadratic's root that is stable for a = b.
float ramp_inverse(float a, float b, float area) {
  const float root = std::sqrt(std::max(0.0f, a * a + 2.0f * area * (b - a)));
  return a + root > 0.0f ? std::clamp(2.0f * area / (a + root), 0.0f, 1.0f) : 0.0f;
}

/// The last of nodes 0 to `count` - 2 whose running sum is at most `target`; 0 if there is none. Sums must not
/// decrease.
uint32_t last_within(uint32_t count, float target, const auto& running_sum) {
  uint32_t last = 0;
  for (uint32_t end = std::max(count, 2u) - 1; end - last > 1;) {
    const uint32_t middle = last + (end - last) / 2;
    (running_sum(middle) <= target ? last : end) = middle;
  }
  return last;
}

}  // namespace

BilinearWarp::BilinearWarp(std::span<const float> values, uint32_t width, uint32_t height)
    : width_(width), height_(height), nodes_(values.size()), rows_below_(values.size() / width) {
  const size_t slice_size = static_cast<size_t>(width) * height;
  for (size_t slice = 0; slice * slice_size < values.size(); ++slice)
    build_slice(values.subspan(slice * slice_size, slice_size), static_cast<uint32_t>(slice));
}

void BilinearWarp::build_slice(std::span<const float> values, uint32_t slice) {
  Node* nodes = nodes_.data() + static_cast<size_t>(slice) * values.size();
  float* below = rows_below_.data() + static_cast<size_t>(slice) * height_;
  std::vector<double> running(values.size());
  double total = 0.0, previous = 0.0;
  for (size_t y = 0; y < height_; ++y) {
    for (size_t x = 1; x < width_; ++x) {
      const size_t i = y * width_ + x;
      running[i] = running[i - 1] + 0.5 * (double{values[i - 1]} + double{values[i]});
    }
    const double row = running[y * width_ + width_ - 1];
    if (y > 0) total += 0.5 * (previous + row);
    previous = row;
  }
  const double scale = total > 0.0 ? 1.0 / total : 0.0;
  for (size_t i = 0; i < values.size(); ++i)
    nodes[i] = {static_cast<float>(scale * values[i]), static_cast<float>(scale * running[i])};
  double sum = 0.0;
  for (size_t y = 1; y < height_; ++y) {
    sum += 0.5 * scale * (running[y * width_ - 1] + running[(y + 1) * width_ - 1]);
    below[y] = static_cast<float>(sum);
  }
}

float BilinearWarp::row_sum(const SliceMix& mix, uint32_t y) const {
  float sum = 0.0f;
  for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s)
    sum += mix.weight[s] * node(mix.slice[s], y, width_ - 1).running;
  return sum;
}

float BilinearWarp::rows_below(const SliceMix& mix, uint32_t y) const {
  float sum = 0.0f;
  for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s)
    sum += mix.weight[s] * rows_below_[static_cast<size_t>(mix.slice[s]) * height_ + y];
  return sum;
}

bool BilinearWarp::invert(const SliceMix& mix, const Vec2& position, Vec2& u) const {
  const AxisCell x = axis_cell(position.x, width_), y = axis_cell(position.y, height_);
  float left = 0.0f, right = 0.0f, before = 0.0f, row_low = 0.0f, row_high = 0.0f, below = 0.0f;
  for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s) {
    const Node* low = &node(mix.slice[s], y.low, 0);
    const Node* high = low + width_;
    const float w_high = mix.weight[s] * y.t, w_low = mix.weight[s] - w_high;
    left += w_low * low[x.low].density + w_high * high[x.low].density;
    right += w_low * low[x.low + 1].density + w_high * high[x.low + 1].density;
    before += w_low * low[x.low].running + w_high * high[x.low].running;
    row_low += mix.weight[s] * low[width_ - 1].running;
    row_high += mix.weight[s] * high[width_ - 1].running;
    below += mix.weight[s] * rows_below_[static_cast<size_t>(mix.slice[s]) * height_ + y.low];
  }
  const float row = row_low + y.t * (row_high - row_low);
  if (!(row > 0.0f)) return false;
  u = {std::min((before + ramp_integral(left, right, x.t)) / row, 1.0f),
       std::min(below + ramp_integral(row_low, row_high, y.t), 1.0f)};
  return true;
}

Vec2 BilinearWarp::warp(const SliceMix& mix, const Vec2& u) const {
  const uint32_t y = last_within(height_, u.y, [&](uint32_t row) { return rows_below(mix, row); });
  const float row_low = row_sum(mix, y), row_high = row_sum(mix, y + 1);
  const float t_y = ramp_inverse(row_low, row_high, u.y - rows_below(mix, y));

  const auto along = [&](uint32_t x, float Node::*member) {
    float sum = 0.0f;
    for (size_t s = 0; s < static_cast<size_t>(mix.count); ++s)
      sum += mix.weight[s] *
             ((1.0f - t_y) * node(mix.slice[s], y, x).*member + t_y * node(mix.slice[s], y + 1, x).*member);
    return sum;
  };
  const float target = u.x * along(width_ - 1, &Node::running);
  const uint32_t x = last_within(width_, target, [&](uint32_t column) { return along(column, &Node::running); });
  const float t_x =
      ramp_inverse(along(x, &Node::density), along(x + 1, &Node::density), target - along(x, &Node::running));
  return {(static_cast<float>(x) + t_x) / static_cast<float>(width_ - 1),
          (static_cast<float>(y) + t_y) / static_cast<float>(height_ - 1)};
}

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

void read_color(const TensorContainer& file, RglTables& tables) {
  const std::string field = file.has("rgb") ? "rgb" : "spectra";
  const auto values = file.floats(field, 5);
  check_views(file, field, tables);
  tables.height = extent(file, field, 3);
  tables.width = extent(file, field, 4);
  const auto weights = channel_weights(file, field);
  const size_t slice = static_cast<size_t>(tables.width) * tables.height;
  const size_t views = tables.phi_v.size() * tables.theta_v.size();
  tables.color.resize(views * slice);
  std::vector<float> channels(weights.size());
  for (size_t i = 0; i < tables.color.size(); ++i) {
    for (size_t c = 0; c < channels.size(); ++c)
      channels[c] = values[(i / slice * channels.size() + c) * slice + i % slice];
    tables.color[i] = rec709_of(weights, channels);
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
  read_color(file, tables);
  tables.microfacet_scale = file.get("jacobian", TensorType::uint8, 1).bytes[0] != 0;
  provenance.format = "rgl";
  if (file.has("description")) provenance.description = file.text("description");
  return std::make_shared<RglMeasurement>(std::move(tables), std::move(provenance));
}

namespace {

/// Angles in the paper's units, which give half vectors near the normal the most nodes.
float u_of_theta(float theta) { return std::sqrt(std::clamp(theta * (2.0f / kPi), 0.0f, 1.0f)); }
float u_of_phi(float phi) {
  const float u = (phi + kPi) * (0.5f / kPi);
  return u - std::floor(u);
}
float theta_of_u(float u) { return u * u * (kPi / 2); }
float phi_of_u(float u) { return (2.0f * u - 1.0f) * kPi; }

/// Minimum cosine of the light in f = (f cos) / cos, which keeps f finite at the horizon.
constexpr float kMinCosine = 1e-6f;

/// Node below `value` on an increasing axis and the weight of the next; clamped at the ends.
std::pair<uint32_t, float> locate(const std::vector<float>& axis, float value) {
  if (axis.size() < 2 || value <= axis.front()) return {0, 0.0f};
  if (value >= axis.back()) return {static_cast<uint32_t>(axis.size() - 2), 1.0f};
  const auto above = std::upper_bound(axis.begin(), axis.end(), value);
  const auto low = static_cast<size_t>(above - axis.begin()) - 1;
  return {static_cast<uint32_t>(low), (value - axis[low]) / (axis[low + 1] - axis[low])};
}

/// Number of equivalent sectors into which the surface's symmetry divides the views; the file holds one of them.
int sectors_of(const std::vector<float>& phi_v, const std::string& path) {
  const float sectors = std::round(2.0f * kPi / (phi_v.back() - phi_v.front()));
  if (sectors != 1.0f && sectors != 2.0f && sectors != 4.0f)
    throw Error(Status::unsupported, path + ": field phi_i spans " + std::to_string(phi_v.back() - phi_v.front()) +
                                         " radians; it must span 2 pi, pi or pi/2.");
  return static_cast<int>(sectors);
}

float theta_of(const Vec3& w) { return fast_atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); }

}  // namespace

float AngleGrid::at(const Vec2& u) const {
  const AxisCell x = axis_cell(u.x, width), y = axis_cell(u.y, height);
  const float* low = values.data() + static_cast<size_t>(y.low) * width + x.low;
  const float* high = low + width;
  const float bottom = low[0] + x.t * (low[1] - low[0]), top = high[0] + x.t * (high[1] - high[0]);
  return bottom + y.t * (top - bottom);
}

RglMeasurement::RglMeasurement(RglTables tables, Provenance provenance)
    : tables_(std::move(tables)), warp_(tables_.visible_normals, tables_.warp_width, tables_.warp_height) {
  provenance_ = std::move(provenance);
  if (!isotropic()) sectors_ = sectors_of(tables_.phi_v, provenance_.path);
  build_nodes();
  tables_.visible_normals = {};  // the warp keeps its own form of them
  tables_.color = {};
  coverage_ = ViewCoverage(*this);
}

void RglMeasurement::build_nodes() {
  nodes_.resize(tables_.color.size());
  const size_t slice_size = static_cast<size_t>(tables_.width) * tables_.height;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const auto slice = static_cast<uint32_t>(i / slice_size);
    const auto y = static_cast<uint32_t>(i % slice_size / tables_.width), x = static_cast<uint32_t>(i % tables_.width);
    const Rgb& c = tables_.color[i];
    if (!texel_above_horizon(slice, y, x)) {
      // The published interpolation runs to f cos = 0 at and below the horizon; the texel stays part of it.
      count_below_horizon(counts_);
      if (std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b)) nodes_[i] = {{c.r, c.g, c.b, 1.0f}};
    } else if (count_entry(c, NegativeRule::luminance, counts_)) {
      nodes_[i] = {{c.r, c.g, c.b, 1.0f}};
    }
  }
}

bool RglMeasurement::texel_above_horizon(uint32_t slice, uint32_t y, uint32_t x) const {
  SliceMix mix;
  mix.add(slice, 1.0f);
  const Vec2 u(static_cast<float>(x) / static_cast<float>(tables_.width - 1),
               static_cast<float>(y) / static_cast<float>(tables_.height - 1));
  const Vec2 position = warp_.warp(mix, u);
  const auto phi_index = slice / static_cast<uint32_t>(tables_.theta_v.size());
  const Vec3 wv =
      direction(tables_.theta_v[slice % tables_.theta_v.size()], isotropic() ? 0.0f : tables_.phi_v[phi_index]);
  const Vec3 half = direction(theta_of_u(position.x), phi_of_u(position.y));
  return 2.0f * glm::dot(wv, half) * half.z - wv.z > 0.0f;
}

SliceMix RglMeasurement::mix_of(float phi, float theta) const {
  const auto stride = static_cast<uint32_t>(tables_.theta_v.size());
  const auto [row, t_row] = isotropic() ? std::pair<uint32_t, float>{0, 0.0f} : locate(tables_.phi_v, phi);
  const auto [column, t_column] = locate(tables_.theta_v, theta);
  const uint32_t first = row * stride + column;
  SliceMix mix;
  mix.add(first, (1.0f - t_row) * (1.0f - t_column));
  mix.add(first + 1, (1.0f - t_row) * t_column);
  mix.add(first + stride, t_row * (1.0f - t_column));
  mix.add(first + stride + 1, t_row * t_column);
  return mix;
}

RglMeasurement::View RglMeasurement::prepare(const Vec3& wv) const {
  View view;
  RglView& frame = view.frame;
  if (!isotropic() && sectors_ >= 2) {
    // The measured sector lies at phi <= 0. Two sectors map to it by half a turn, four by mirroring in x and y.
    const float by_y = wv.y > 0.0f ? -1.0f : 1.0f, by_x = wv.x > 0.0f ? -1.0f : 1.0f;
    frame.flip = {sectors_ == 4 ? by_x : by_y, by_y};
  }
  frame.wv = {wv.x * frame.flip.x, wv.y * frame.flip.y, wv.z};
  const float theta = theta_of(wv), phi = fast_atan2(frame.wv.y, frame.wv.x);
  const float side = std::sqrt(wv.x * wv.x + wv.y * wv.y);
  if (isotropic() && side > 0.0f) {
    frame.cos_phi = wv.x / side;
    frame.sin_phi = wv.y / side;
  }
  view.mix = mix_of(phi, theta);
  const float area = tables_.projected_area.at({u_of_theta(theta), isotropic() ? 0.5f : u_of_phi(phi)});
  view.scale = tables_.microfacet_scale ? 0.25f / area : 1.0f;
  view.covered = wv.z > 0.0f && theta <= tables_.theta_v.back() + 1e-5f && area > 0.0f;
  return view;
}

/// `u`: the point that the warp maps to `position`.
bool RglMeasurement::lookup(const View& view, const Vec2& position, const Vec2& u, float cosine, Rgb& f) const {
  const AxisCell cx = axis_cell(u.x, tables_.width), cy = axis_cell(u.y, tables_.height);
  alignas(16) float total[4] = {0, 0, 0, 0};
  for (size_t s = 0; s < static_cast<size_t>(view.mix.count); ++s) {
    const TableNode* low =
        nodes_.data() + (static_cast<size_t>(view.mix.slice[s]) * tables_.height + cy.low) * tables_.width + cx.low;
    const TableNode* high = low + tables_.width;
    const float w = view.mix.weight[s], w_high = w * cy.t, w_low = w - w_high;
    const float w01 = w_low * cx.t, w00 = w_low - w01, w11 = w_high * cx.t, w10 = w_high - w11;
    for (int c = 0; c < 4; ++c)
      total[c] += w00 * low[0].value[c] + w01 * low[1].value[c] + w10 * high[0].value[c] + w11 * high[1].value[c];
  }
  if (!(total[3] > 0.0f)) return false;
  const float normals = tables_.microfacet_scale ? tables_.normals.at(position) : 1.0f;
  f = Rgb(total[0], total[1], total[2]) * (normals * view.scale / (total[3] * std::max(cosine, kMinCosine)));
  return std::isfinite(f.r + f.g + f.b);
}

void RglMeasurement::eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const {
  // Each of the three steps reads tables that are rarely in cache. One step for several directions before the next one
  // keeps many reads in flight.
  constexpr size_t kTogether = kRglPositions;
  const View view = prepare(wv);
  for (size_t first = 0; first < wl.size(); first += kTogether) {
    const size_t count = std::min(kTogether, wl.size() - first);
    Vec2 position[kTogether], u[kTogether];
    half_vector_positions(view.frame, wl.subspan(first, count), position);
    for (size_t i = 0; i < count; ++i) valid[first + i] = view.covered && wl[first + i].z > 0.0f;
    for (size_t i = 0; i < count; ++i) {
      if (valid[first + i]) valid[first + i] = warp_.invert(view.mix, position[i], u[i]);
    }
    for (size_t i = 0; i < count; ++i) {
      const size_t at = first + i;
      if (valid[at]) valid[at] = lookup(view, position[i], u[i], wl[at].z, f[at]);
      if (!valid[at]) f[at] = Rgb(0.0f);
    }
  }
}

std::vector<std::pair<std::string, std::string>> RglMeasurement::details() const {
  const auto size = [](size_t n) { return std::to_string(n); };
  return {{"table", size(tables_.phi_v.size()) + " phi_v x " + size(tables_.theta_v.size()) + " theta_v x " +
                        size(tables_.height) + " x " + size(tables_.width) + " of float32"},
          {"holds", tables_.microfacet_scale ? "f cos = value x D / (4 sigma); f is given without cosine, 1/sr"
                                             : "f cos; f is given without cosine, 1/sr"},
          {"invalid", "entries that are not finite or have negative luminance"},
          {"interpolation", "bilinear in warped half vectors, linear between views, as defined by the file format"}};
}

}  // namespace velour
