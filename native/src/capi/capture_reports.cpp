#include "capi/capture_reports.h"

#include "capi/json_text.h"

namespace velour::capi {

std::string capture_json(const BtfCaptureReport& report) {
  return text({{"seconds", report.seconds},
               {"rays", report.rays},
               {"rays_per_second", report.rays_per_second},
               {"ray_share", report.ray_share ? Json(*report.ray_share) : Json()},
               {"bytes", report.bytes},
               {"views", report.views},
               {"lights", report.lights},
               {"pairs", report.pairs},
               {"views_resumed", report.views_resumed},
               {"sides", report.two_sided ? 2 : 1},
               {"open", report.open},
               {"thickness", report.thickness},
               {"reference_height", report.reference_height},
               {"warnings", report.warnings}});
}

std::string microsurface_json(const MicrosurfaceReport& report) {
  return text({{"seconds", report.seconds},
               {"rays", report.rays},
               {"rays_per_second", report.rays_per_second},
               {"bytes", report.bytes},
               {"resolution_degrees", report.resolution_degrees},
               {"relative_standard_error", report.relative_standard_error},
               {"albedo", report.albedo}});
}

}  // namespace velour::capi
