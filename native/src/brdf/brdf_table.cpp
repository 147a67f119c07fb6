#include "brdf/brdf_table.h"

#include <charconv>
#include <cstring>

#include "brdf/entries.h"
#include "brdf/table_measurement.h"
#include "file/file.h"
#include "image/exr_tensors.h"
#include "job/error.h"

namespace velour {
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
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    throw Error(Status::bad_data, path + ": attribute " + key + " is '" + text + "'; it must be a number from " +
                                      number_text(low) + " to " + number_text(high) + ".");
  return value;
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

}  // namespace velour
