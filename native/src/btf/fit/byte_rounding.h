// Rounding of coefficients to bytes with little error in the sums of lobes.
#pragma once

#include <array>
#include <Eigen/Core>

#include "btf/model/srbf_btf.h"

namespace velour {

/// Products of any two lobes of an axis, averaged over places and pairs.
using LobeProductMeans = std::array<Eigen::MatrixXf, 3>;

/// Adjustments of the later coefficients that compensate for the rounding of one, for functions with these products
/// ([FAHA23]). Upper triangular: row k, times the rounding error of k, is subtracted from the coefficients from k on.
Eigen::MatrixXf rounding_moves(const Eigen::MatrixXf& products);

/// Sets scales and bytes of `side`, whose lobes and levels are set. Coefficients of overlapping lobes may be large and
/// cancel, which makes their steps large as well: the effect of rounding one of them on the sum is compensated by those
/// not yet rounded ([FAHA23], which is Babai's nearest plane). `values`: per level, finest first, [texel][coefficient].
void set_rounded(const LobeProductMeans& products, std::vector<std::vector<float>> values, SrbfSide& side);

}  // namespace velour
