#include <algorithm>
#include <cmath>

#include "btf/measure/pair_layout.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "capture/btf/btf_capture.h"
#include "capture/tile/tile.h"
#include "votf/capture/data_votf.h"
#include "votf/capture/votf_capture.h"

using namespace velour;
using namespace velour::capi;

namespace {

void initialize(vlr_capture_options* options) {
  static const BtfCaptureOptions defaults;  // immutable; lends its name to every caller
  *options = {};
  options->struct_size = sizeof(vlr_capture_options);
  std::copy(std::begin(defaults.texels), std::end(defaults.texels), options->texels);
  options->samples = defaults.sampling.samples;
  options->bounces = defaults.sampling.bounces;
  options->seed = defaults.sampling.seed;
  options->metres_per_unit = defaults.metres_per_unit;
  options->reference_height = std::nan("");
  options->memory_limit = defaults.memory_limit;
  options->source = defaults.source.c_str();
}

std::vector<PolarAngles> directions_from(const double* angles, uint64_t count, const char* what) {
  if (count > kMaxDirections) {
    throw Error(Status::invalid_argument, "A capture cannot have " + std::to_string(count) + " " + what +
                                              " directions; at most " + std::to_string(kMaxDirections) +
                                              " are supported.");
  }
  std::vector<PolarAngles> set;
  for (uint64_t i = 0; i < count; ++i) set.push_back({angles[2 * i], angles[2 * i + 1]});
  return set;
}

CaptureSides sides_from(int32_t value) {
  if (value < VLR_SIDES_AUTOMATIC || value > VLR_SIDES_TWO) {
    throw Error(Status::invalid_argument,
                "vlr_capture_options.sides is " + std::to_string(value) + ", not a VLR_SIDES value.");
  }
  return static_cast<CaptureSides>(value);
}

BtfCaptureOptions converted(const vlr_capture_options& given) {
  BtfCaptureOptions options;
  for (int i = 0; i < 2; ++i) {
    options.place.origin[i] = static_cast<float>(given.origin[i]);
    options.place.period[i] = static_cast<float>(given.period[i]);
    options.texels[i] = given.texels[i];
  }
  options.metres_per_unit = given.metres_per_unit;
  if (given.views) options.views = directions_from(given.views, given.view_count, "view");
  if (given.lights) options.lights = directions_from(given.lights, given.light_count, "light");
  options.sides = sides_from(given.sides);
  options.held_out = given.held_out;
  options.sampling = {.samples = given.samples, .bounces = given.bounces, .seed = given.seed};
  if (!std::isnan(given.reference_height)) options.reference_height = given.reference_height;
  options.memory_limit = given.memory_limit;
  options.threads = static_cast<int>(given.threads);
  options.resume = given.resume != 0;
  options.measure_ray_share = given.measure_ray_share != 0;
  if (given.source) options.source = given.source;
  return options;
}

}  // namespace

void vlr_capture_options_init(vlr_capture_options* options) { initialize(options); }

vlr_status vlr_directions(const char* name, double* angles, uint64_t* count) {
  return guard([&] {
    require(name, "name");
    require(count, "count");
    const std::vector<PolarAngles> set = named_directions(name);
    if (angles && *count != set.size()) {
      throw Error(Status::invalid_argument, "The direction set " + std::string(name) + " has " +
                                                std::to_string(set.size()) + " directions, but count is " +
                                                std::to_string(*count) + ".");
    }
    *count = set.size();
    if (!angles) return;
    for (const PolarAngles& d : set) {
      *angles++ = d.theta;
      *angles++ = d.phi;
    }
  });
}

vlr_status vlr_capture_create_job(const vlr_scene* tile, const vlr_capture_options* options, const char* path,
                                  vlr_job** out) {
  return guard([&] {
    require(tile, "tile");
    require(path, "path");
    require(out, "out");
    const auto given = read_options(options, vlr_capture_options_init, "vlr_capture_options");
    auto output = std::make_shared<JobOutput>();
    const auto task = [output, scene = tile->scene, capture = converted(given),
                       folder = std::string(path)](Progress& progress) {
      output->set(capture_json(capture_btf(*scene, capture, folder, progress)));
    };
    *out = new vlr_job(output, task);
  });
}

namespace {

std::optional<double> given(double value) { return value < 0 ? std::nullopt : std::optional(value); }

std::optional<int> given(uint32_t value) {
  constexpr uint32_t kLargest = 1u << 20;  // beyond the limit of any tile, and within int
  return value == 0 ? std::nullopt : std::optional(static_cast<int>(std::min(value, kLargest)));
}

TileOptions converted(const vlr_tile_options& options) {
  require(options.kind, "vlr_tile_options.kind");
  return {.kind = options.kind,
          .size = given(options.size),
          .thickness = given(options.thickness),
          .gap = given(options.gap),
          .irregularity = given(options.irregularity),
          .count = given(options.count),
          .resolution = given(options.resolution),
          .seed = options.seed};
}

vlr_mesh_desc described(const TileMesh& mesh) {
  vlr_mesh_desc desc = {};
  desc.vertex_count = static_cast<uint32_t>(mesh.positions.size());
  desc.triangle_count = static_cast<uint32_t>(mesh.triangles.size());
  desc.positions = &mesh.positions.front().x;
  desc.triangles = &mesh.triangles.front().x;
  desc.corner_normals = &mesh.corner_normals.front().x;
  desc.corner_uvs = &mesh.corner_uvs.front().x;
  desc.material_slots = mesh.slots.data();
  return desc;
}

vlr_principled_desc described(const PrincipledParameters& parameters) {
  vlr_principled_desc desc;
  vlr_principled_desc_init(&desc);
  for (int i = 0; i < 3; ++i) desc.base_color[i] = parameters.base_color[i];
  desc.metallic = parameters.metallic;
  desc.roughness = parameters.roughness;
  desc.specular = parameters.specular;
  return desc;
}

}  // namespace

void vlr_tile_options_init(vlr_tile_options* options) {
  static const std::string kKind = TileOptions().kind;
  *options = {};
  options->struct_size = sizeof(vlr_tile_options);
  options->kind = kKind.c_str();
  options->size = options->thickness = options->gap = options->irregularity = -1;
}

vlr_status vlr_tile_kinds_json(const char** json) {
  return guard([&] {
    require(json, "json");
    static const std::string kText = tile_kinds_json();
    *json = kText.c_str();
  });
}

vlr_status vlr_tile_create(const vlr_tile_options* options, vlr_tile** out) {
  return guard([&] {
    require(out, "out");
    *out = new vlr_tile{make_tile(converted(read_options(options, vlr_tile_options_init, "vlr_tile_options"))), {}};
  });
}

void vlr_tile_free(vlr_tile* tile) { delete tile; }

vlr_status vlr_tile_desc(const vlr_tile* tile, vlr_mesh_desc* desc) {
  return guard([&] {
    require(tile, "tile");
    write_struct(described(tile->tile.parts.mesh), desc, "vlr_mesh_desc");
  });
}

vlr_status vlr_tile_material(const vlr_tile* tile, uint32_t slot, vlr_principled_desc* material) {
  return guard([&] {
    require(tile, "tile");
    const auto& materials = tile->tile.parts.materials;
    if (slot >= materials.size()) {
      throw Error(Status::invalid_argument, "The tile " + tile->tile.kind + " has " + std::to_string(materials.size()) +
                                                " material slots; slot " + std::to_string(slot) + " does not exist.");
    }
    write_struct(described(materials[slot].parameters), material, "vlr_principled_desc");
  });
}

vlr_status vlr_tile_info_json(vlr_tile* tile, const char** json) {
  return guard([&] {
    require(tile, "tile");
    require(json, "json");
    tile->info = tile_json(tile->tile);
    *json = tile->info.c_str();
  });
}

namespace {

VotfCaptureOptions converted(const vlr_votf_options& given) {
  VotfCaptureOptions options;
  for (int i = 0; i < 2; ++i) {
    options.place.origin[i] = static_cast<float>(given.origin[i]);
    options.place.period[i] = static_cast<float>(given.period[i]);
  }
  options.metres_per_unit = given.metres_per_unit;
  options.texels = given.texels;
  options.surface = given.surface;
  if (!std::isnan(given.reference_height)) options.reference_height = given.reference_height;
  options.check_views = given.check_views;
  options.seed = given.seed;
  options.threads = static_cast<int>(given.threads);
  return options;
}

DataVotfOptions of_data(const vlr_votf_options& given) {
  return {.texels = given.texels,
          .surface = given.surface,
          .check_views = given.check_views,
          .threads = static_cast<int>(given.threads)};
}

/// Whether a BTF's model has views from below; nothing for a BRDF.
std::optional<bool> seen_from_below(const Model& model) {
  if (!is_btf(model)) return std::nullopt;
  return with_btf(model.body, [](const auto& btf) {
    return std::ranges::any_of(btf.layout.views(), [](const PolarAngles& view) { return view.theta > 90; });
  });
}

/// Creates a job that adds the VOTF found by `find(progress)` to a copy of `model`.
template <typename Find>
vlr_job* shell_job(const vlr_model* model, const char* source, Find find) {
  auto output = std::make_shared<JobOutput>();
  const auto task = [output, base = model->model, source = std::string(source ? source : ""),
                     find = std::move(find)](Progress& progress) {
    VotfCapture captured = find(progress);
    auto result = std::make_shared<Model>(*base);
    result->shell = ModelShell{std::make_shared<const VotfVolume>(std::move(captured.volume)), source, captured.errors};
    captured.volume = {};
    output->set(votf_json(*result->shell, captured.seconds, captured.warnings), result);
  };
  return new vlr_job(output, task);
}

}  // namespace

void vlr_votf_options_init(vlr_votf_options* options) {
  const VotfCaptureOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_votf_options);
  options->texels = defaults.texels;
  options->check_views = defaults.check_views;
  options->metres_per_unit = defaults.metres_per_unit;
  options->reference_height = std::nan("");
  options->source = "tile";
}

vlr_status vlr_votf_create_job(const vlr_scene* tile, const vlr_model* model, const vlr_votf_options* options,
                               vlr_job** out) {
  return guard([&] {
    require(tile, "tile");
    require(model, "model");
    require(out, "out");
    const auto given = read_options(options, vlr_votf_options_init, "vlr_votf_options");
    VotfCaptureOptions capture = converted(given);
    capture.two_sided = seen_from_below(*model->model);
    *out = shell_job(model, given.source, [scene = tile->scene, capture](Progress& progress) {
      return capture_votf(*scene, capture, progress);
    });
  });
}

vlr_status vlr_votf_data_create_job(const vlr_btf* btf, const vlr_model* model, const vlr_votf_options* options,
                                    vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(model, "model");
    require(out, "out");
    const auto given = read_options(options, vlr_votf_options_init, "vlr_votf_options");
    *out = shell_job(model, given.source, [data = btf->btf, capture = of_data(given)](Progress& progress) {
      return votf_of_data(*data, capture, progress);
    });
  });
}
