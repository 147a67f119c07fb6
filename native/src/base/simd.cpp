#include "base/simd.h"

#include "base/simd_dispatch.h"

namespace velour {

namespace {

/// Targets that the kernels are compiled for and the processor supports, as bits; a lower bit is a better target.
int64_t available_targets() { return hwy::SupportedTargets() & HWY_TARGETS; }

template <class F>
void for_each_target(const F& f) {
  for (int64_t rest = available_targets(); rest != 0; rest &= rest - 1) f(rest & -rest);
}

}  // namespace

namespace detail {

hwy::ChosenTarget& chosen_simd_target() {
  static hwy::ChosenTarget& chosen = []() -> hwy::ChosenTarget& {
    static hwy::ChosenTarget made;
    made.Update(available_targets());
    return made;
  }();
  return chosen;
}

}  // namespace detail

const char* simd_target() {
  const size_t current = detail::chosen_simd_target().GetIndex();
  const char* name = "";
  for_each_target([&](int64_t target) {
    hwy::ChosenTarget candidate;
    candidate.Update(target);
    if (candidate.GetIndex() == current) name = hwy::TargetName(target);
  });
  return name;
}

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for_each_target([&](int64_t target) { names.emplace_back(hwy::TargetName(target)); });
  return names;
}

bool select_simd_target(const char* name) {
  const std::string wanted = name;
  int64_t mask = wanted == "auto" ? available_targets() : 0;
  for_each_target([&](int64_t target) {
    if (wanted == hwy::TargetName(target)) mask = target;
  });
  if (mask != 0) detail::chosen_simd_target().Update(mask);
  return mask != 0;
}

}  // namespace velour
