// Calls the variant of a Highway kernel that select_simd_target has chosen. For sources that use HWY_EXPORT;
// include it after <hwy/foreach_target.h>, and <hwy/highway.h>.
#pragma once

#include <hwy/highway.h>

namespace velour::detail {

/// Our own choice, not Highway's: that one belongs to the process, and its other users (image codecs in Blender, say)
/// must not feel our pin.
hwy::ChosenTarget& chosen_simd_target();

}  // namespace velour::detail

/// In place of HWY_DYNAMIC_DISPATCH: the function of the table made by HWY_EXPORT(function) for simd_target().
#define VELOUR_SIMD_DISPATCH(function) \
  (*(HWY_DISPATCH_TABLE(function)[::velour::detail::chosen_simd_target().GetIndex()]))
