#include "support/picture_means.h"

#include "image/picture.h"
#include "math/sphere/vec.h"
#include "support/artifacts.h"

namespace velour::test {

PictureMeans::PictureMeans(int width, int height, int block)
    : width_(width),
      height_(height),
      block_(block),
      pixels_(static_cast<size_t>(width) * static_cast<size_t>(height)),
      blocks_(blocks_across() * static_cast<size_t>((height + block - 1) / block)) {}

size_t PictureMeans::blocks_across() const { return static_cast<size_t>((width_ + block_ - 1) / block_); }

void PictureMeans::add(std::span<const float> rgba) {
  std::vector<RunningMean> blocks(blocks_.size());
  RunningMean whole;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const double value = luminance({rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]});
    const size_t x = i % static_cast<size_t>(width_), y = i / static_cast<size_t>(width_);
    const auto side = static_cast<size_t>(block_);
    pixels_[i].add(value);
    blocks[y / side * blocks_across() + x / side].add(value);
    whole.add(value);
  }
  for (size_t b = 0; b < blocks.size(); ++b) blocks_[b].add(blocks[b].mean());
  whole_.add(whole.mean());
}

std::string PictureMeans::write_evidence(const std::string& name, const PictureMeans& expected) const {
  Picture pictures[3];
  for (Picture& p : pictures) p = {width_, height_, 3, {}};
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Estimate a = pixels_[i].estimate(), b = expected.pixels_[i].estimate();
    const double values[3] = {a.mean, b.mean, difference(a, b).z};
    for (size_t k = 0; k < 3; ++k)
      pictures[k].pixels.insert(pictures[k].pixels.end(), 3, static_cast<float>(values[k]));
  }
  std::string text = "pictures:";
  const char* kinds[3] = {"found", "expected", "z"};
  for (size_t k = 0; k < 3; ++k) {
    const auto path = artifact_path(name + '.' + kinds[k] + ".exr");
    write_picture(path.string(), pictures[k]);
    text += ' ' + path.string();
  }
  return text;
}

void compare(const std::string& name, const PictureMeans& found, const PictureMeans& expected, ZTests& tests) {
  const auto evidence = [=] { return found.write_evidence(name, expected); };
  tests.add(name + " whole", found.whole(), expected.whole(), evidence);
  for (size_t b = 0; b < found.blocks_.size(); ++b) {
    const std::string place =
        std::to_string(b % found.blocks_across()) + ' ' + std::to_string(b / found.blocks_across());
    tests.add(name + " block " + place, found.blocks_[b].estimate(), expected.blocks_[b].estimate(), evidence);
  }
}

}  // namespace velour::test
