#include <algorithm>
#include <cmath>

#include "btf/direction_sets.h"
#include "capi/capture_reports.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capture/btf_capture.h"

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
