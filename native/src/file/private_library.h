// A shared library bound for our own use: its entry points are looked up on its own handle, so an equally named symbol
// that is already in the process (Blender links its own Embree) is never called by accident.
#pragma once

#include <string>

#include "job/error.h"

namespace velour {

/// Open for the life of the object. Loaded with RTLD_LOCAL and never with RTLD_DEEPBIND, which breaks the allocator and
/// `environ` of the host.
class PrivateLibrary {
 public:
  /// Looks at the file `first`, if one is given, beside our own shared object, in its `lib` neighbours, then on the
  /// system's library path. Throws Error(unsupported) naming what was tried and `remedy`.
  PrivateLibrary(const std::string& file_name, const std::string& remedy, const std::string& first = {});
  ~PrivateLibrary();
  PrivateLibrary(const PrivateLibrary&) = delete;
  PrivateLibrary& operator=(const PrivateLibrary&) = delete;

  /// Address of `name` in this very library. Throws Error(version_mismatch) when it is not there.
  template <typename Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }
  /// File the library was loaded from.
  const std::string& path() const { return path_; }

 private:
  void* address(const char* name) const;

  void* handle_ = nullptr;
  std::string path_;
};

}  // namespace velour
