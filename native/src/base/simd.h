// Instruction set of the SIMD kernels.
#pragma once

#include <string>
#include <vector>

namespace velour {

/// The current instruction set, e.g. "AVX2".
const char* simd_target();
/// Instruction sets that both this processor and this build support, best first.
std::vector<std::string> simd_targets();
/// Restricts dispatch to `name` ("auto" lifts the restriction). Returns false, and changes nothing, if it is not one of
/// simd_targets(). Do not call while a job runs: its kernels may then use either set.
bool select_simd_target(const char* name);

}  // namespace velour
