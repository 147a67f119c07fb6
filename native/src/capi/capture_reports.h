// JSON reports on virtual measurements, with the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "capture/btf_capture.h"
#include "capture/microsurface.h"

namespace velour::capi {

std::string capture_json(const BtfCaptureReport& report);
std::string microsurface_json(const MicrosurfaceReport& report);

}  // namespace velour::capi
