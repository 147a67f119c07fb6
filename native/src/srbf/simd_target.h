// Which instruction set the library's SIMD kernels use.
#pragma once

#include <string>
#include <vector>

namespace velour {

/// The instruction set in use now, e.g. "AVX2".
const char* simd_target();
/// The choices that this processor and this build have, best first.
std::vector<std::string> simd_targets();
/// Restricts dispatch to `name` ("auto" lifts it). Returns false, and changes nothing, when it is none of
/// simd_targets(). Not while a job runs: a kernel called meanwhile may use either set.
bool select_simd_target(const char* name);

}  // namespace velour
