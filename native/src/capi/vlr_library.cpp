#include <tbb/info.h>

#include "base/job.h"
#include "base/simd.h"
#include "capi/guard.h"
#include "capi/reports/reports.h"
#include "scene/embree_scene.h"
#include "velour/version.h"

using namespace velour;
using namespace velour::capi;

namespace {

std::string system_json() {
  const EmbreeInfo embree = embree_info();
  return text({{"version", VELOUR_VERSION_TEXT},
               {"embree", {{"version", embree.version}, {"path", embree.path}}},
               {"simd", simd_target()},
               {"simd_targets", simd_targets()},
               {"threads", tbb::info::default_concurrency()},
               {"build_type", VELOUR_BUILD_TYPE}});
}

}  // namespace

uint32_t vlr_version() { return VELOUR_VERSION_NUMBER; }

uint32_t vlr_abi_version() { return VLR_ABI_VERSION; }

vlr_status vlr_self_test() {
  return guard([] { embree_self_test(); });
}

vlr_status vlr_system_json(const char** json) {
  return guard([&] {
    require(json, "json");
    thread_local std::string text;
    text = system_json();
    *json = text.c_str();
  });
}

vlr_status vlr_select_simd(const char* target) {
  return guard([&] {
    require(target, "target");
    if (Job::running_count() > 0) {
      throw Error(Status::invalid_state, "The instruction set cannot be changed while a job is running.");
    }
    if (!select_simd_target(target)) {
      throw Error(
          Status::invalid_argument,
          "The instruction set '" + std::string(target) +
              "' is not available on this processor or in this build; vlr_system_json lists the available ones.");
    }
  });
}
