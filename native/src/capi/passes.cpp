#include "capi/passes.h"

#include "capi/guard.h"
#include "render/cryptomatte_id.h"

using namespace velour;
using namespace velour::capi;

void vlr_pass_options_init(vlr_pass_options* options) {
  const PassOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_pass_options);
  options->cryptomatte_ranks = static_cast<uint32_t>(defaults.cryptomatte_ranks);
  options->mist_start = defaults.mist.start;
  options->mist_depth = defaults.mist.depth;
  options->mist_exponent = defaults.mist.exponent;
}

vlr_status vlr_cryptomatte_id(const char* name, uint32_t* hash, float* id) {
  return guard([&] {
    require(name, "name");
    if (hash != nullptr) *hash = murmur_hash(name);
    if (id != nullptr) *id = cryptomatte_id(name);
  });
}

namespace velour::capi {

PassOptions passes_of(const vlr_pass_options* given) {
  const vlr_pass_options asked = read_options(given, vlr_pass_options_init, "vlr_pass_options");
  if (asked.instance_count > 0) require(asked.instances, "vlr_pass_options.instances");
  if (asked.material_count > 0) require(asked.materials, "vlr_pass_options.materials");
  PassOptions options;
  options.asked = asked.asked;
  options.cryptomatte_ranks = static_cast<int>(asked.cryptomatte_ranks);
  options.mist = {asked.mist_start, asked.mist_depth, asked.mist_exponent};
  for (uint64_t i = 0; i < asked.instance_count; ++i) {
    const vlr_instance_label& label = asked.instances[i];
    options.instances.push_back({label.index, label.object_id, label.asset_id, label.uv_set});
  }
  for (uint64_t i = 0; i < asked.material_count; ++i) {
    options.materials.push_back({asked.materials[i].index, asked.materials[i].id});
  }
  return options;
}

}  // namespace velour::capi
