// What this machine's arithmetic could do at best, measured, for comparison with the mixture kernel.
#pragma once

namespace velour {

/// Seconds a lobe and direction of a Gaussian mixture would take if nothing but its arithmetic counted: the operations
/// of eval_mixture's inner loop (11 fused multiply-adds, 3 products, 6 sums, a maximum and a shift) in as many lanes,
/// in chains that do not wait for each other, on registers alone. The best of many short runs; measured at the first
/// call.
double arithmetic_peak_seconds();

}  // namespace velour
