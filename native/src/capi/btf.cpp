// Bidirectional texture functions.
#include "btf/btf_export.h"
#include "btf/load_btf.h"
#include "capi/btf_reports.h"
#include "capi/guard.h"
#include "capi/handles.h"

using namespace velour;
using namespace velour::capi;

namespace {

void require_enum(const char* field, int32_t value, int32_t last) {
  if (value >= 0 && value <= last) return;
  throw Error(Status::invalid_argument, std::string("vlr_btf_options.") + field + " is " + std::to_string(value) +
                                            ", which is not a valid value.");
}

BtfLoadOptions converted(const vlr_btf_options& given) {
  require_enum("values", given.values, VLR_BTF_RADIANCE);
  require_enum("colors", given.colors, VLR_BTF_XYZ);
  BtfLoadOptions options;
  options.values = static_cast<BtfValues>(given.values);
  options.colors = static_cast<BtfColors>(given.colors);
  if (given.gamma != 0) options.curve.gamma = given.gamma;
  const Vec2 tile(given.tile_metres[0], given.tile_metres[1]);
  if (tile != Vec2(0)) options.tile_metres = tile;
  if (given.layer) options.layer = given.layer;
  require_enum("angles", given.angles, VLR_BTF_RADIANS);
  options.angles = static_cast<BtfAngles>(given.angles);
  return options;
}

void require_count(const char* what, uint64_t given, uint64_t needed) {
  if (given == needed) return;
  throw Error(Status::invalid_argument, std::string("The array for ") + what + " has " + std::to_string(given) +
                                            " numbers; it must have " + std::to_string(needed) + ".");
}

}  // namespace

void vlr_btf_options_init(vlr_btf_options* options) {
  *options = {};
  options->struct_size = sizeof(vlr_btf_options);
}

vlr_status vlr_btf_load(const char* path, const vlr_btf_options* options, vlr_btf** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    const BtfLoadOptions given = converted(read_options(options, vlr_btf_options_init, "vlr_btf_options"));
    *out = new vlr_btf{load_btf(path, given), {}};
  });
}

void vlr_btf_free(vlr_btf* btf) { delete btf; }

vlr_status vlr_btf_info_json(vlr_btf* btf, const char** json) {
  return guard([&] {
    require(btf, "btf");
    require(json, "json");
    btf->info = btf_json(*btf->btf);
    *json = btf->info.c_str();
  });
}

vlr_status vlr_btf_angles(const vlr_btf* btf, double* angles, uint64_t count) {
  return guard([&] {
    require(btf, "btf");
    require(angles, "angles");
    const auto source = kept(btf->btf);
    const PairLayout& layout = source->layout();
    require_count("angles", count, 4 * layout.pairs());
    for (uint64_t p = 0; p < layout.pairs(); ++p) {
      const PolarAngles &light = layout.lights()[layout.light_of(p)], &view = layout.views()[layout.view_of(p)];
      const double four[] = {light.theta, light.phi, view.theta, view.phi};
      std::copy_n(four, 4, angles + 4 * p);
    }
  });
}

vlr_status vlr_btf_read(const vlr_btf* btf, uint64_t first, uint64_t pairs, uint16_t* halves, uint64_t count) {
  return guard([&] {
    require(btf, "btf");
    require(halves, "halves");
    const auto source = kept(btf->btf);
    if (pairs > source->layout().pairs())
      throw Error(Status::invalid_argument, "pairs is " + std::to_string(pairs) + ", more than the pairs of the BTF.");
    require_count("halves", count, pairs * source->grid().texels() * 3);
    source->read_pairs(first, pairs, {halves, static_cast<size_t>(count)});
  });
}

vlr_status vlr_btf_export_create_job(const vlr_btf* btf, const char* path, vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(path, "path");
    require(out, "out");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, source = btf->btf, target = std::string(path)](Progress& progress) {
      output->set(btf_export_json(export_btf(*source, target, progress)));
    });
  });
}
