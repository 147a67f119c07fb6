#include "btf/view_file.h"

#include <filesystem>

namespace velour {

std::string view_path(const std::string& folder, size_t view) {
  std::string number = std::to_string(view);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return std::filesystem::path(folder) / ("view_" + number + ".exr");
}

std::vector<ImageStack> view_stacks(const BtfIndex& index, size_t view) {
  const uint64_t lights = index.layout.first(view + 1) - index.layout.first(view);
  const TexelGrid& grid = index.grid;
  std::vector<ImageStack> stacks;
  if (lights > 0) stacks.push_back({"values", StackValue::half, 3, grid.width, grid.height, lights});
  if (lights > 0 && index.errors) stacks.push_back({"errors", StackValue::half, 1, grid.width, grid.height, lights});
  if (!index.structure) return stacks;
  for (const char* name : {"coverage", "height_mean", "height_spread"}) {
    stacks.push_back({name, StackValue::float32, 1, grid.width, grid.height, 1});
  }
  return stacks;
}

}  // namespace velour
