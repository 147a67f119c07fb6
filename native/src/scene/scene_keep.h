// Cache for data derived from a state of a scene, kept with that scene.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <typeinfo>

namespace velour {

/// One object, of one type, for one revision of a scene. Thread-safe.
class SceneKeep {
 public:
  /// The T of `revision`, default-constructed at the first call. Holders of a T of another revision keep theirs.
  template <typename T>
  std::shared_ptr<T> of(uint64_t revision) {
    const std::lock_guard lock(mutex_);
    if (!kept_ || type_ != &typeid(T) || revision_ != revision) {
      kept_ = std::make_shared<T>();
      type_ = &typeid(T);
      revision_ = revision;
    }
    return std::static_pointer_cast<T>(kept_);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<void> kept_;
  const std::type_info* type_ = nullptr;
  uint64_t revision_ = 0;
};

}  // namespace velour
