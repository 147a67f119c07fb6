#include "brdf/measure/brdf_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "base/text_number.h"
#include "brdf/measure/measurement.h"
#include "image/tensors/exr_tensors.h"
#include "math/sphere/directions.h"

namespace velour {

DirectionPair pair_of_half_diff(double theta_h, double phi_h, double theta_d, double phi_d) {
  const double sin_h = std::sin(theta_h), cos_h = std::cos(theta_h);
  const double sin_p = std::sin(phi_h), cos_p = std::cos(phi_h);
  const Vec3d half{sin_h * cos_p, sin_h * sin_p, cos_h};
  const Vec3d along{cos_h * cos_p, cos_h * sin_p, -sin_h}, across{-sin_p, cos_p, 0.0};
  const Vec3d side = std::sin(theta_d) * (std::cos(phi_d) * along + std::sin(phi_d) * across);
  const Vec3d up = std::cos(theta_d) * half;
  return {Vec3(up + side), Vec3(up - side)};
}

namespace {

constexpr char kKind[] = "brdf_table";
constexpr char kVersion[] = "1";

const std::string& attribute(const TensorFile& file, const std::string& key, const std::string& path) {
  const auto found = file.attributes.find(key);
  if (found == file.attributes.end())
    throw Error(Status::bad_data,
                path + ": attribute " + key + " is missing; this is not a complete BRDF table. Write it again.");
  return found->second;
}

/// The shortest text that reads back the same, independent of the locale.
std::string number_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

double number_attribute(const TensorFile& file, const std::string& key, double low, double high,
                        const std::string& path) {
  const std::string text = attribute(file, key, path);
  const auto value = number_from(text);
  if (!value || !(*value >= low && *value <= high))
    throw Error(Status::bad_data, path + ": attribute " + key + " is '" + text + "'; it must be a number from " +
                                      number_text(low) + " to " + number_text(high) + ".");
  return *value;
}

void check_kind(const TensorFile& file, const std::string& path) {
  if (attribute(file, "velour.kind", path) != kKind)
    throw Error(Status::bad_data,
                path + ": velour.kind is '" + file.attributes.at("velour.kind") + "'; a BRDF table has 'brdf_table'.");
  const std::string version = attribute(file, "velour.format_version", path);
  if (version != kVersion)
    throw Error(Status::unsupported, path + ": velour.format_version is '" + version +
                                         "'; this Velour reads version 1. Use a newer Velour.");
}

const Tensor& table_tensor(const TensorFile& file, const std::string& path) {
  const auto found = file.tensors.find("f");
  if (found == file.tensors.end())
    throw Error(Status::bad_data, path + ": tensor f is missing; this is not a complete BRDF table. Write it again.");
  const Tensor& tensor = found->second;
  if (tensor.shape.size() != 5 || tensor.shape[4] != 3)
    throw Error(Status::bad_data, path + ": tensor f has " + std::to_string(tensor.shape.size()) +
                                      " dimensions; it must be theta_h x phi_h x theta_d x phi_d x 3.");
  for (const uint64_t extent : tensor.shape)
    if (extent > 100000)
      throw Error(Status::bad_data,
                  path + ": tensor f has an extent of " + std::to_string(extent) + "; at most 100000 is allowed.");
  return tensor;
}

BrdfTableLayout layout_of(const TensorFile& file, const Tensor& tensor, const std::string& path) {
  const auto extent = [&](size_t axis) { return static_cast<int>(tensor.shape[axis]); };
  BrdfTableLayout layout{.theta_h = extent(0), .phi_h = extent(1), .theta_d = extent(2), .phi_d = extent(3)};
  layout.folds = static_cast<int>(number_attribute(file, "velour.folds", 1, 1000, path));
  layout.theta_h_power = number_attribute(file, "velour.theta_h_power", 0.1, 10, path);
  return layout;
}

std::vector<TableNode> read_nodes(const BrdfTableLayout& layout, const Tensor& tensor, EntryCounts& counts) {
  const HorizonTest horizon(layout);
  std::vector<TableNode> nodes(layout.size());
  for (int i = 0; i < layout.theta_h; ++i)
    for (int j = 0; j < layout.phi_h; ++j)
      for (int k = 0; k < layout.theta_d; ++k)
        for (int l = 0; l < layout.phi_d; ++l) {
          const size_t index = layout.index(i, j, k, l);
          const float* at = tensor.data.data() + 3 * index;
          if (!horizon.above(i, k, l))
            count_below_horizon(counts);
          else if (count_entry({at[0], at[1], at[2]}, NegativeRule::luminance, counts))
            nodes[index] = {{at[0], at[1], at[2], 1.0f}};
        }
  return nodes;
}

TableMeasurement::Details describe(const BrdfTableLayout& layout) {
  return {{"table", std::to_string(layout.theta_h) + " theta_half x " + std::to_string(layout.phi_h) + " phi_half x " +
                        std::to_string(layout.theta_d) + " theta_diff x " + std::to_string(layout.phi_d) +
                        " phi_diff, 3 channels of float32"},
          {"holds", "f without cosine, 1/sr, linear Rec. 709"},
          {"folds", std::to_string(layout.folds)},
          {"invalid", "nodes that are not finite or have negative luminance"},
          {"interpolation",
           "multilinear over valid nodes, theta_half warped by power " + number_text(layout.theta_h_power)}};
}

}  // namespace

void write_brdf_table(const std::string& path, const BrdfTable& table) {
  const BrdfTableLayout& layout = table.layout;
  if (layout.theta_h < 1 || layout.phi_h < 1 || layout.theta_d < 1 || layout.phi_d < 1 || layout.folds < 1 ||
      table.f.size() != layout.size())
    throw Error(Status::invalid_argument, path + ": the BRDF table has " + std::to_string(table.f.size()) +
                                              " numbers, which does not match its layout.");
  Tensor tensor;
  for (const int extent : {layout.theta_h, layout.phi_h, layout.theta_d, layout.phi_d, 3})
    tensor.shape.push_back(static_cast<uint64_t>(extent));
  tensor.data.resize(3 * table.f.size());
  std::memcpy(tensor.data.data(), table.f.data(), tensor.data.size() * sizeof(float));
  TensorFile file;
  file.attributes = {{"velour.kind", kKind},
                     {"velour.format_version", kVersion},
                     {"velour.description", table.description},
                     {"velour.units", "f in 1/sr, without cosine, linear Rec. 709"},
                     {"velour.folds", std::to_string(layout.folds)},
                     {"velour.theta_h_power", number_text(layout.theta_h_power)}};
  file.tensors.emplace("f", std::move(tensor));
  write_file(path, encode_tensors(file));
}

std::shared_ptr<const Measurement> read_brdf_table(std::span<const uint8_t> bytes, Provenance provenance) {
  const std::string path = provenance.path;
  const TensorFile file = decode_tensors(bytes, path, {{"f"}, usual_max_bytes(bytes.size())});
  check_kind(file, path);
  const Tensor& tensor = table_tensor(file, path);
  const BrdfTableLayout layout = layout_of(file, tensor, path);
  EntryCounts counts;
  auto nodes = read_nodes(layout, tensor, counts);
  provenance.format = "velour-table";
  if (const auto text = file.attributes.find("velour.description"); text != file.attributes.end())
    provenance.description = text->second;
  return std::make_shared<TableMeasurement>(HalfDiffTable(layout, std::move(nodes)), std::move(provenance), counts,
                                            describe(layout));
}

namespace {

double theta_h_node(const BrdfTableLayout& layout, int i) {
  return kPiD / 2 * std::pow(static_cast<double>(i) / layout.theta_h, layout.theta_h_power);
}
double theta_d_node(const BrdfTableLayout& layout, int k) { return kPiD / 2 * k / layout.theta_d; }
double phi_d_node(const BrdfTableLayout& layout, int l) { return kPiD * l / layout.phi_d; }

}  // namespace

DirectionPair BrdfTableLayout::pair(int i, int j, int k, int l) const {
  return pair_of_half_diff(theta_h_node(*this, i), 2 * kPiD / folds * j / phi_h, theta_d_node(*this, k),
                           phi_d_node(*this, l));
}

HorizonTest::HorizonTest(const BrdfTableLayout& layout) {
  for (int i = 0; i < layout.theta_h; ++i) {
    sin_h_.push_back(std::sin(theta_h_node(layout, i)));
    cos_h_.push_back(std::cos(theta_h_node(layout, i)));
  }
  for (int k = 0; k < layout.theta_d; ++k) {
    sin_d_.push_back(std::sin(theta_d_node(layout, k)));
    cos_d_.push_back(std::cos(theta_d_node(layout, k)));
  }
  for (int l = 0; l < layout.phi_d; ++l) cos_phi_.push_back(std::cos(phi_d_node(layout, l)));
}

HalfDiffTable::HalfDiffTable(const BrdfTableLayout& layout, std::vector<TableNode> nodes)
    : layout_(layout), nodes_(std::move(nodes)) {
  if (nodes_.size() != layout_.size())
    throw Error(Status::invalid_argument, "A BRDF table of " + std::to_string(layout_.size()) + " nodes cannot have " +
                                              std::to_string(nodes_.size()) + " values.");
}

HalfDiffTable::Step HalfDiffTable::clamped(float position, int count) {
  const int low = std::clamp(static_cast<int>(position), 0, count - 1);
  const int high = std::min(low + 1, count - 1);
  return {static_cast<size_t>(low), static_cast<size_t>(high), position - static_cast<float>(low)};
}

HalfDiffTable::Step HalfDiffTable::periodic(float position, int count) {
  const int floor = static_cast<int>(position);
  const int low = std::clamp(floor >= count ? floor - count : floor, 0, count - 1);
  const int high = low + 1 == count ? 0 : low + 1;
  return {static_cast<size_t>(low), static_cast<size_t>(high), position - static_cast<float>(floor)};
}

HalfDiffTable::Step HalfDiffTable::theta_h_step(float theta_h) const {
  const float share = theta_h * (2.0f / kPi);
  const float warped = layout_.theta_h_power == 2.0 ? std::sqrt(share)
                                                    : std::pow(share, static_cast<float>(1.0 / layout_.theta_h_power));
  Step step = clamped(warped * static_cast<float>(layout_.theta_h), layout_.theta_h);
  const size_t row =
      static_cast<size_t>(layout_.phi_h) * static_cast<size_t>(layout_.theta_d) * static_cast<size_t>(layout_.phi_d);
  return {step.low * row, step.high * row, step.weight};
}

void HalfDiffTable::add_plane(size_t base, const Step& theta_d, const Step& phi_d, float weight, float sum[4]) const {
  const TableNode* low = nodes_.data() + base + theta_d.low;
  const TableNode* high = nodes_.data() + base + theta_d.high;
  const float w_high = weight * theta_d.weight, w_low = weight - w_high;
  const float w01 = w_low * phi_d.weight, w00 = w_low - w01, w11 = w_high * phi_d.weight, w10 = w_high - w11;
  for (int c = 0; c < 4; ++c)
    sum[c] += w00 * low[phi_d.low].value[c] + w01 * low[phi_d.high].value[c] + w10 * high[phi_d.low].value[c] +
              w11 * high[phi_d.high].value[c];
}

bool HalfDiffTable::lookup(const Vec3& wl, const Vec3& wv, Rgb& f) const {
  const HalfDiff angle = half_diff(wl, wv);
  const Step theta_h = theta_h_step(angle.theta_h);
  Step theta_d = clamped(angle.theta_d * (2.0f / kPi) * static_cast<float>(layout_.theta_d), layout_.theta_d);
  theta_d.low *= static_cast<size_t>(layout_.phi_d);
  theta_d.high *= static_cast<size_t>(layout_.phi_d);
  const Step phi_d = periodic(angle.phi_d * (1.0f / kPi) * static_cast<float>(layout_.phi_d), layout_.phi_d);
  alignas(16) float sum[4] = {0, 0, 0, 0};
  if (layout_.phi_h == 1) {
    add_plane(theta_h.low, theta_d, phi_d, 1.0f - theta_h.weight, sum);
    add_plane(theta_h.high, theta_d, phi_d, theta_h.weight, sum);
  } else {
    const size_t plane = static_cast<size_t>(layout_.theta_d) * static_cast<size_t>(layout_.phi_d);
    const float turns = angle.phi_h * (0.5f / kPi) * static_cast<float>(layout_.folds);
    const Step phi_h = periodic((turns - std::floor(turns)) * static_cast<float>(layout_.phi_h), layout_.phi_h);
    for (const auto& [row, w] : {std::pair{theta_h.low, 1.0f - theta_h.weight}, {theta_h.high, theta_h.weight}}) {
      add_plane(row + phi_h.low * plane, theta_d, phi_d, w * (1.0f - phi_h.weight), sum);
      add_plane(row + phi_h.high * plane, theta_d, phi_d, w * phi_h.weight, sum);
    }
  }
  const bool covered = sum[3] > 0.0f;
  f = covered ? Rgb(sum[0], sum[1], sum[2]) / sum[3] : Rgb(0.0f);
  return covered;
}

TableMeasurement::TableMeasurement(HalfDiffTable table, Provenance provenance, const EntryCounts& counts,
                                   Details details)
    : table_(std::move(table)), details_(std::move(details)) {
  provenance_ = std::move(provenance);
  counts_ = counts;
  coverage_ = ViewCoverage(*this);
}

void TableMeasurement::eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
                            std::span<uint8_t> valid) const {
  for (size_t i = 0; i < wl.size(); ++i) {
    const bool above = wv.z > 0.0f && wl[i].z > 0.0f;
    if (!above) f[i] = Rgb(0.0f);
    valid[i] = above && table_.lookup(wl[i], wv, f[i]);
  }
}

ViewCoverage::ViewCoverage(const Measurement& measurement) {
  const auto lights = hemisphere_fibonacci(256);
  std::vector<Rgb> f(lights.size());
  std::vector<uint8_t> valid(lights.size());
  for (size_t degree = 0; degree < covered_.size(); ++degree) {
    measurement.eval(direction(radians_from(static_cast<float>(degree)), 0.0f), lights, f, valid);
    const auto hits = std::count(valid.begin(), valid.end(), uint8_t{1});
    covered_[degree] = static_cast<size_t>(hits) * 2 >= lights.size();
  }
}

bool ViewCoverage::covers(float theta_v) const {
  if (!(theta_v >= 0.0f && theta_v < kPi / 2)) return false;
  const auto degree = static_cast<size_t>(std::lround(theta_v * (180.0f / kPi)));
  return covered_[std::min(degree, covered_.size() - 1)];
}

}  // namespace velour
