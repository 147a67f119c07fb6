#include "base/private_library.h"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>
#include <vector>

namespace velour {
namespace {

/// Folder of the shared object (or program) that contains this code; empty if unknown.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code ignored;
  return std::filesystem::absolute(info.dli_fname, ignored).parent_path();
}

std::vector<std::string> candidates(const std::string& file_name, const std::string& first) {
  std::vector<std::string> paths;
  if (!first.empty()) paths.push_back(first);
  const std::filesystem::path folder = own_folder();
  std::error_code ignored;
  for (const char* neighbor : {".", "lib", "../lib"}) {
    const auto path = folder / neighbor / file_name;
    if (!folder.empty() && std::filesystem::exists(path, ignored)) paths.push_back(path.lexically_normal());
  }
  paths.push_back(file_name);
  return paths;
}

std::string path_of(void* handle, const std::string& otherwise) {
  link_map* map = nullptr;
  const bool known = dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 && map->l_name != nullptr && *map->l_name != '\0';
  return known ? map->l_name : otherwise;
}

}  // namespace

PrivateLibrary::PrivateLibrary(const std::string& file_name, const std::string& remedy, const std::string& first) {
  std::string reasons;
  for (const std::string& path : candidates(file_name, first)) {
    handle_ = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) {
      path_ = path_of(handle_, path);
      return;
    }
    const char* reason = dlerror();
    reasons += (reasons.empty() ? "" : "; ") + std::string(reason != nullptr ? reason : path.c_str());
  }
  throw Error(Status::unsupported, file_name + " cannot be loaded (" + reasons + "): " + remedy);
}

PrivateLibrary::~PrivateLibrary() {
  if (handle_ != nullptr) dlclose(handle_);
}

void* PrivateLibrary::address(const char* name) const {
  void* found = dlsym(handle_, name);
  if (found == nullptr) {
    throw Error(Status::version_mismatch,
                path_ + " has no function " + name + ": install the version that Velour was built for.");
  }
  return found;
}

}  // namespace velour
