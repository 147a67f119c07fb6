// Replaces the two functions that Highway's headers need from its library, so Velour does not link it. Inside Blender
// the loader would find Blender's own copy first, whatever its version, and the bits of its answer change meaning from
// one version to the next.
#include <hwy/targets.h>

#include "base/simd_dispatch.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace hwy {
namespace {

#if defined(__x86_64__)
/// Checks the processor, and whether the operating system saves the registers.
#define VELOUR_HAS(feature) (__builtin_cpu_supports(feature) != 0)

/// Tests a bit of register ecx of the instruction cpuid, for features whose names clang 14 does not know.
bool has_bit(unsigned leaf, unsigned bit) {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __get_cpuid(leaf, &eax, &ebx, &ecx, &edx) != 0 && (ecx >> bit & 1) != 0;
}
bool has_lzcnt() { return has_bit(0x80000001, 5); }
bool has_f16c() { return has_bit(1, 29); }

bool has_ssse3() { return VELOUR_HAS("ssse3"); }
bool has_sse4() {
  return has_ssse3() && VELOUR_HAS("sse4.1") && VELOUR_HAS("sse4.2") && VELOUR_HAS("pclmul") && VELOUR_HAS("aes");
}
bool has_avx2() {
  return has_sse4() && VELOUR_HAS("avx") && VELOUR_HAS("avx2") && has_lzcnt() && VELOUR_HAS("bmi") &&
         VELOUR_HAS("bmi2") && VELOUR_HAS("fma") && has_f16c();
}
bool has_avx3() {
  return has_avx2() && VELOUR_HAS("avx512f") && VELOUR_HAS("avx512vl") && VELOUR_HAS("avx512dq") &&
         VELOUR_HAS("avx512bw") && VELOUR_HAS("avx512cd");
}

/// Supported targets among those that the kernels are compiled for (HWY_TARGETS); newer sets count as the best of
/// these.
int64_t detect() {
  int64_t found = HWY_STATIC_TARGET;
  if (has_ssse3()) found |= HWY_SSSE3;
  if (has_sse4()) found |= HWY_SSE4;
  if (has_avx2()) found |= HWY_AVX2;
  if (has_avx3()) found |= HWY_AVX3;
  return found;
}
#else
int64_t detect() { return HWY_STATIC_TARGET; }
#endif

}  // namespace

int64_t SupportedTargets() {
  static const int64_t found = detect();
  return found;
}

ChosenTarget& GetChosenTarget() { return velour::detail::chosen_simd_target(); }

}  // namespace hwy
