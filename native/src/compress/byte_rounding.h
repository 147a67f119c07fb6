// Coefficients as bytes, so that the sums of lobes lose little.
#pragma once

#include <array>
#include <Eigen/Core>

#include "btf/srbf_btf.h"

namespace velour {

/// Products of any two lobes of an axis, in the mean over places and pairs.
using LobeProductMeans = std::array<Eigen::MatrixXf, 3>;

/// How rounding a coefficient moves those after it, so that their sum stays where it was as far as it can ([FAHA23]).
/// Upper triangular, for functions with such products: row k, from k on, is subtracted times the error of k.
Eigen::MatrixXf rounding_moves(const Eigen::MatrixXf& products);

/// Sets scales and bytes of `side`, whose lobes and levels are set. Coefficients of lobes that overlap may be large and
/// cancel, and then a step is large as well: what rounding one of them does to the sum is made up for by those that are
/// not yet rounded ([FAHA23], which is Babai's nearest plane). `values`: of each level, the finest first,
/// [texel][coefficient].
void set_rounded(const LobeProductMeans& products, std::vector<std::vector<float>> values, SrbfSide& side);

}  // namespace velour
