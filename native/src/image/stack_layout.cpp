#include "image/stack_layout.h"

#include <cstring>

namespace velour {

std::vector<std::string> stored_channels(const ImageStack& stack) {
  return stack.channels == 3 ? std::vector<std::string>{"B", "G", "R"} : std::vector<std::string>{"Y"};
}

StackLayout::StackLayout(std::span<const ImageStack> stacks, uint64_t headers) : tables_(headers), bytes_(headers) {
  for (const ImageStack& stack : stacks) {
    row_bytes_.push_back(stack.row_bytes());
    bytes_ += 8 * stack.images * stack.height;
  }
  for (size_t i = 0; i < stacks.size(); ++i) {
    begin_.push_back(bytes_);
    bytes_ += stacks[i].images * stacks[i].height * step(i);
  }
}

std::array<uint8_t, 12> StackLayout::whole_head(size_t stack, uint64_t y) const {
  const std::array<int32_t, 3> numbers{static_cast<int32_t>(stack), static_cast<int32_t>(y),
                                       static_cast<int32_t>(row_bytes_[stack])};
  std::array<uint8_t, 12> bytes;
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

void StackLayout::write_head(size_t stack, uint64_t y, uint8_t* chunk) const {
  const auto head = whole_head(stack, y);
  std::memcpy(chunk, head.data() + head.size() - head_bytes(), head_bytes());
}

bool StackLayout::has_head(size_t stack, uint64_t y, const uint8_t* chunk) const {
  const auto head = whole_head(stack, y);
  return std::memcmp(chunk, head.data() + head.size() - head_bytes(), head_bytes()) == 0;
}

}  // namespace velour
