#include "material/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "base/error.h"
#include "image/picture.h"
#include "image/texels.h"
#include "material/program/program.h"
#include "material/surface_site.h"

namespace velour {

namespace {

/// Floor of a small number; std::floor is a library call on the baseline instruction set.
int floor_of(float v) {
  const int whole = static_cast<int>(v);
  return whole - (v < static_cast<float>(whole) ? 1 : 0);
}

float usable(float v, const ValueFaults& faults) { return faults.finite(v); }
/// A color with a NaN channel becomes black.
Rgb usable(const Rgb& c, const ValueFaults& faults) {
  if (std::isnan(c.r + c.g + c.b)) return Rgb(0.0f);
  return {faults.finite(c.r), faults.finite(c.g), faults.finite(c.b)};
}

void check_size(int width, int height, size_t texels) {
  if (width <= 0 || height <= 0 || texels != static_cast<size_t>(width) * static_cast<size_t>(height)) {
    throw Error(Status::invalid_argument, "A texture of " + std::to_string(width) + " x " + std::to_string(height) +
                                              " texels cannot have " + std::to_string(texels) + " values.");
  }
}

/// linear_from_srgb() from a table, whose error is at most 4e-7.
float decoded_srgb(float v) {
  constexpr int kSteps = 1024;
  static const auto table = [] {
    std::array<float, kSteps + 1> values;
    for (int i = 0; i <= kSteps; ++i) values[static_cast<size_t>(i)] = linear_from_srgb(static_cast<float>(i) / kSteps);
    return values;
  }();
  const float place = v * kSteps;
  if (!(place >= 0.0f && place < static_cast<float>(kSteps))) return linear_from_srgb(v);
  const auto i = static_cast<size_t>(place);
  return table[i] + (place - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

/// Texels times 255, if that makes all of them whole numbers up to 255; else none.
std::vector<glm::u8vec4> as_bytes(const std::vector<glm::vec4>& texels) {
  std::vector<glm::u8vec4> bytes;
  bytes.reserve(texels.size());
  for (const glm::vec4& texel : texels) {
    const glm::vec4 scaled = 255.0f * texel, whole = glm::round(scaled);
    const glm::vec4 error = glm::abs(scaled - whole);
    const float worst = std::max({error.x, error.y, error.z, error.w});
    if (!(worst < 1e-3f) || glm::clamp(whole, 0.0f, 255.0f) != whole) return {};
    bytes.emplace_back(whole);
  }
  return bytes;
}

}  // namespace

template <class T>
Texture<T>::Texture(int width, int height, std::vector<T> texels, const TextureOptions& options) : options_(options) {
  check_size(width, height, texels.size());
  const std::span<float> values(reinterpret_cast<float*>(texels.data()), texels.size() * sizeof(T) / sizeof(float));
  const ValueFaults faults = find_value_faults(values);
  for (T& t : texels) t = usable(t, faults);
  levels_.push_back({width, height, std::move(texels), {}});
  add_levels();
}

template <class T>
Texture<T>::Texture(int width, int height, StoredTexels texels, const TextureOptions& options)
    : options_(options), stored_(std::move(texels)) {
  check_size(width, height, stored_.texels.size());
  const std::span<float> values(&stored_.texels.data()->x, stored_.texels.size() * 4);
  const ValueFaults faults = find_value_faults(values);
  for (float& v : values) v = faults.finite(v);
  levels_.push_back({width, height, {}, {}});
  Level& finest = levels_[0];
  for (const glm::vec4& texel : stored_.texels) {
    const Weighted value = weighted(texel);
    finest.texels.push_back(value.value);
    if (stored_.premultiplied) finest.weights.push_back(value.weight);
  }
  add_levels();
  levels_[0].texels = {};
  levels_[0].weights = {};
  of_bytes_ = as_bytes(stored_.texels);
  if (!of_bytes_.empty()) stored_.texels = {};
}

template <class T>
void Texture<T>::add_levels() {
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(half(levels_.back()));
}

/// half_image() of texels of one or three channels.
template <class T>
std::vector<T> half_texels(const std::vector<T>& texels, uint32_t width, uint32_t height) {
  constexpr uint32_t kChannels = sizeof(T) / sizeof(float);
  const auto* floats = reinterpret_cast<const float*>(texels.data());
  const std::vector<float> smaller = half_image({floats, texels.size() * kChannels}, width, height, kChannels);
  std::vector<T> halved(smaller.size() / kChannels);
  std::memcpy(halved.data(), smaller.data(), smaller.size() * sizeof(float));
  return halved;
}

template <class T>
typename Texture<T>::Level Texture<T>::half(const Level& level) {
  const auto width = static_cast<uint32_t>(level.width), height = static_cast<uint32_t>(level.height);
  Level next{static_cast<int>(half_of(width)),
             static_cast<int>(half_of(height)),
             half_texels(level.texels, width, height),
             {}};
  if (!level.weights.empty()) next.weights = half_texels(level.weights, width, height);
  return next;
}

/// Texel index for `i` in [-1, size], from a position after reduced(); -1: outside the image.
template <class T>
int Texture<T>::wrapped(int i, int size) const {
  switch (options_.wrap) {
    case TextureWrap::repeat:
      return i < 0 ? i + size : (i >= size ? i - size : i);
    case TextureWrap::clip:
      return i < 0 || i >= size ? -1 : i;
    case TextureWrap::mirror:  // the border texel repeats, as with extend
    case TextureWrap::extend:
      break;
  }
  return std::clamp(i, 0, size - 1);
}

template <class T>
template <class V>
V Texture<T>::at(const std::vector<V>& texels, const Level& level, int x, int y) const {
  const int column = wrapped(x, level.width), row = wrapped(y, level.height);
  if (column < 0 || row < 0) return V(0);
  return texels[static_cast<size_t>(row) * static_cast<size_t>(level.width) + static_cast<size_t>(column)];
}

template <class T>
glm::vec4 Texture<T>::stored(int x, int y) const {
  if (of_bytes_.empty()) return at(stored_.texels, levels_[0], x, y);
  return glm::vec4(at(of_bytes_, levels_[0], x, y)) * (1.0f / 255.0f);
}

template <class T>
T Texture<T>::decoded(const glm::vec4& stored) const {
  Rgb color(stored);
  if (stored_.premultiplied && stored.a != 0.0f) color /= stored.a;
  if (stored_.srgb) color = {decoded_srgb(color.r), decoded_srgb(color.g), decoded_srgb(color.b)};
  return first_of<T>(stored_.colors * color);
}

template <class T>
typename Texture<T>::Weighted Texture<T>::weighted(const glm::vec4& stored) const {
  constexpr float kLeast = 1e-6f;  // lets colors without any alpha have a mean
  const float weight = stored_.premultiplied ? stored.a + kLeast : 1.0f;
  return {weight * decoded(stored), weight};
}

template <class T>
Vec2 Texture<T>::reduced(const Vec2& uv) const {
  const Vec2 given(std::isfinite(uv.x) ? uv.x : 0.0f, std::isfinite(uv.y) ? uv.y : 0.0f);
  if (options_.wrap == TextureWrap::repeat) return given - glm::floor(given);
  if (options_.wrap == TextureWrap::mirror) return 1.0f - glm::abs(given - 2.0f * glm::floor(0.5f * given) - 1.0f);
  if (options_.wrap == TextureWrap::extend) return glm::clamp(given, Vec2(0.0f), Vec2(1.0f));
  return glm::clamp(given, Vec2(-2.0f), Vec2(3.0f));  // limits texel indices; what is outside stays outside
}

template <class T>
T Texture<T>::closest(const Vec2& uv) const {
  const Level& level = levels_[0];
  const Vec2 place = uv * Vec2(level.width, level.height);
  const int x = floor_of(place.x), y = floor_of(place.y);
  return level.texels.empty() ? decoded(stored(x, y)) : at(level.texels, level, x, y);
}

template <class T>
typename Texture<T>::Weighted Texture<T>::bilinear(const Level& level, const Vec2& uv) const {
  const Vec2 place = uv * Vec2(level.width, level.height) - 0.5f;
  const int x = floor_of(place.x), y = floor_of(place.y);
  const Vec2 part = place - Vec2(x, y);
  const int column[2] = {wrapped(x, level.width), wrapped(x + 1, level.width)};
  const int row[2] = {wrapped(y, level.height), wrapped(y + 1, level.height)};
  const auto between = [&](const auto& texels, auto kind) {
    using V = decltype(kind);
    const auto texel = [&](int c, int r) {
      if (column[c] < 0 || row[r] < 0) return V(0);
      return V(texels[static_cast<size_t>(row[r]) * static_cast<size_t>(level.width) + static_cast<size_t>(column[c])]);
    };
    const V bottom = (1 - part.x) * texel(0, 0) + part.x * texel(1, 0);
    const V top = (1 - part.x) * texel(0, 1) + part.x * texel(1, 1);
    return (1 - part.y) * bottom + part.y * top;
  };
  if (!level.texels.empty()) {
    const T value = between(level.texels, T());
    return {value, level.weights.empty() ? 1.0f : between(level.weights, float())};
  }
  return weighted(of_bytes_.empty() ? between(stored_.texels, glm::vec4())
                                    : between(of_bytes_, glm::vec4()) * (1.0f / 255.0f));
}

template <class T>
typename Texture<T>::Weighted Texture<T>::trilinear(const Vec2& uv, float level) const {
  const auto last = static_cast<float>(levels_.size() - 1);
  const float place = std::clamp(level, 0.0f, last);
  const auto i = static_cast<size_t>(place);
  const float part = place - static_cast<float>(i);
  const Weighted fine = bilinear(levels_[i], uv);
  if (!(part > 0.0f)) return fine;
  const Weighted coarse = bilinear(levels_[i + 1], uv);
  return {(1 - part) * fine.value + part * coarse.value, (1 - part) * fine.weight + part * coarse.weight};
}

template <class T>
T Texture<T>::look_up(const Vec2& uv, const Mat2& footprint) const {
  const FootprintTaps taps = footprint_taps(footprint, Vec2(width(), height()));
  if (taps.level <= 0.0f && taps.count == 1) {
    return options_.filter == TextureFilter::closest && taps.magnified ? closest(reduced(uv))
                                                                       : bilinear(levels_[0], reduced(uv)).mean();
  }
  Weighted sum{T(0.0f), 0.0f};
  for (int i = 0; i < taps.count; ++i) {
    const Weighted tap = trilinear(reduced(taps.place(uv, i)), taps.level);
    sum.value += tap.value;
    sum.weight += tap.weight;
  }
  return sum.mean();
}

template <class T>
uint64_t Texture<T>::bytes() const {
  uint64_t sum = stored_.texels.size() * sizeof(glm::vec4) + of_bytes_.size() * sizeof(glm::u8vec4);
  for (const Level& level : levels_) sum += level.texels.size() * sizeof(T) + level.weights.size() * sizeof(float);
  return sum;
}

template class Texture<float>;
template class Texture<Rgb>;

void MeshSets::use(const std::shared_ptr<const Program>& computing, uint32_t used) {
  if (program && program != computing) {
    refuse("A material cannot take values from two programs; use outputs of one program for all its parameters.");
  }
  program = computing;
  outputs |= used;
  uvs = std::max(uvs, static_cast<uint8_t>(computing->uv_sets()));
  colors = std::max(colors, static_cast<uint8_t>(computing->corner_sets()));
}

}  // namespace velour
