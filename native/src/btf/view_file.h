// The file of one view in Velour's own BTF format and its image stacks. Internal to btf/.
#pragma once

#include <string>
#include <vector>

#include "btf/btf_index.h"
#include "image/image_stack.h"

namespace velour {

/// Indices of the parts present in a view's file: values and errors first; coverage, mean and spread of heights last.
inline constexpr size_t kValuesPart = 0, kErrorsPart = 1, kStructureParts = 3;

/// `folder`/view_0007.exr.
std::string view_path(const std::string& folder, size_t view);

/// Empty for a view without lights and structure, which has no file.
std::vector<ImageStack> view_stacks(const BtfIndex& index, size_t view);

}  // namespace velour
