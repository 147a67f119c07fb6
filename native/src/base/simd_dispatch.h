// Calls the variant of a Highway kernel that select_simd_target has chosen. For sources that use HWY_EXPORT;
// include it after <hwy/foreach_target.h>, and <hwy/highway.h>.
#pragma once

#include <hwy/highway.h>

namespace velour::detail {

/// Velour's own target. Highway's is process-wide, and restricting it would affect its other users (such as image
/// codecs in Blender).
hwy::ChosenTarget& chosen_simd_target();

}  // namespace velour::detail

/// Replaces HWY_DYNAMIC_DISPATCH: selects from the table of HWY_EXPORT(function) the one for simd_target().
#define VELOUR_SIMD_DISPATCH(function) \
  (*(HWY_DISPATCH_TABLE(function)[::velour::detail::chosen_simd_target().GetIndex()]))
