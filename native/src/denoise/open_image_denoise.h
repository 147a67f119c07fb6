// C interface of Intel's Open Image Denoise 2, bound at run time. Velour builds and runs without the library.
#pragma once

#include <cstddef>
#include <string>

#include "base/private_library.h"

namespace velour {

/// Table of the functions in use, declared as in oidn.h 2.0. Enumerator values are defined where they are used.
struct OpenImageDenoise {
  using Device = struct OpaqueDevice*;
  using Filter = struct OpaqueFilter*;
  using Monitor = bool(void* user, double fraction);  // false: cancel

  /// `file`: library file to try first; empty: none.
  explicit OpenImageDenoise(const std::string& file);

  PrivateLibrary library;
#define VELOUR_OIDN(type, name, ...) type (*const name)(__VA_ARGS__) = library.function<type(__VA_ARGS__)>("oidn" #name)
  VELOUR_OIDN(Device, NewDevice, int type);
  VELOUR_OIDN(void, SetDeviceInt, Device, const char* name, int value);
  VELOUR_OIDN(void, SetDeviceBool, Device, const char* name, bool value);
  VELOUR_OIDN(int, GetDeviceInt, Device, const char* name);
  VELOUR_OIDN(void, CommitDevice, Device);
  VELOUR_OIDN(int, GetDeviceError, Device, const char** message);
  VELOUR_OIDN(void, ReleaseDevice, Device);
  VELOUR_OIDN(Filter, NewFilter, Device, const char* type);
  VELOUR_OIDN(void, SetSharedFilterImage, Filter, const char* name, void* pixels, int format, size_t width,
              size_t height, size_t byte_offset, size_t pixel_stride, size_t row_stride);
  VELOUR_OIDN(void, SetFilterBool, Filter, const char* name, bool value);
  VELOUR_OIDN(void, SetFilterInt, Filter, const char* name, int value);
  VELOUR_OIDN(void, SetFilterProgressMonitorFunction, Filter, Monitor* monitor, void* user);
  VELOUR_OIDN(void, CommitFilter, Filter);
  VELOUR_OIDN(void, ExecuteFilter, Filter);
  VELOUR_OIDN(void, ReleaseFilter, Filter);
#undef VELOUR_OIDN
};

/// Sets the file that open_image_denoise() tries first. Empty: only libOpenImageDenoise.so.2 beside our own library and
/// on the system's library path. Has no effect once the library is open. Thread-safe.
void set_open_image_denoise_file(const std::string& file);

/// Opened by the first call and never closed. Throws Error(unsupported) that says what was tried and what to do.
const OpenImageDenoise& open_image_denoise();

}  // namespace velour
