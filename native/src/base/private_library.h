// A shared library for our own use: entry points are looked up on its own handle, so that a symbol of the same name in
// the process (Blender links its own Embree) is never called by accident.
#pragma once

#include <string>

#include "base/error.h"

namespace velour {

/// Keeps a library open for its own lifetime. Loads it with RTLD_LOCAL and never with RTLD_DEEPBIND, which breaks the
/// allocator and `environ` of the host.
class PrivateLibrary {
 public:
  /// Tries the file `first` if given, then our own shared object's folder, its `lib` and `../lib`, then the system's
  /// library path. Throws Error(unsupported) naming what was tried and `remedy`.
  PrivateLibrary(const std::string& file_name, const std::string& remedy, const std::string& first = {});
  ~PrivateLibrary();
  PrivateLibrary(const PrivateLibrary&) = delete;
  PrivateLibrary& operator=(const PrivateLibrary&) = delete;

  /// Address of `name` in this library. Throws Error(version_mismatch) if it is missing.
  template <typename Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }
  /// File that the library was loaded from.
  const std::string& path() const { return path_; }

 private:
  void* address(const char* name) const;

  void* handle_ = nullptr;
  std::string path_;
};

}  // namespace velour
