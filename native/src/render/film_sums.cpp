#include "render/film_sums.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "job/error.h"

namespace velour {
namespace {

constexpr size_t kOfPixel = 12;
constexpr float kMaxWholeFloat = 16777216.0f;  // above, floats skip integers

void write(const PixelSum& p, float* out) {
  const float values[kOfPixel] = {p.radiance.r,
                                  p.radiance.g,
                                  p.radiance.b,
                                  p.alpha,
                                  p.normal.x,
                                  p.normal.y,
                                  p.normal.z,
                                  p.depth,
                                  p.luminance[0],
                                  p.luminance[1],
                                  static_cast<float>(p.camera_rays),
                                  static_cast<float>(p.directions)};
  std::ranges::copy(values, out);
}

uint32_t count(float value) {
  if (value >= 0.0f && value <= kMaxWholeFloat && value == std::floor(value)) return static_cast<uint32_t>(value);
  throw Error(Status::bad_data,
              "The given numbers are not the sums of a render: a pixel has " + std::to_string(value) + " rays.");
}

PixelSum read(const float* v) {
  return {.radiance = {v[0], v[1], v[2]},
          .alpha = v[3],
          .normal = {v[4], v[5], v[6]},
          .depth = v[7],
          .luminance = {v[8], v[9]},
          .camera_rays = count(v[10]),
          .directions = count(v[11])};
}

/// Copy of the contents of a film.
struct Contents {
  explicit Contents(const Film& film)
      : pixels(static_cast<size_t>(film.width()) * static_cast<size_t>(film.height())),
        values(pixels.size() * film.layout().size()) {
    film.load(film.window(), pixels, values);
  }
  std::vector<PixelSum> pixels;
  std::vector<float> values;
};

void check_size(const Film& film, size_t given) {
  const size_t expected = static_cast<size_t>(film.width()) * static_cast<size_t>(film.height()) * sums_per_pixel(film);
  if (given == expected) return;
  throw Error(Status::invalid_argument, "The sums of this render are " + std::to_string(expected) + " numbers, not " +
                                            std::to_string(given) +
                                            ". Add only sums of renders with the same size and passes.");
}

}  // namespace

size_t sums_per_pixel(const Film& film) { return kOfPixel + film.layout().size(); }

void read_sums(const Film& film, std::span<float> sums) {
  check_size(film, sums.size());
  const Contents contents(film);
  const size_t of_layout = film.layout().size();
  float* out = sums.data();
  const float* values = contents.values.data();
  for (const PixelSum& pixel : contents.pixels) {
    write(pixel, out);
    std::copy_n(values, of_layout, out + kOfPixel);
    out += kOfPixel + of_layout;
    values += of_layout;
  }
}

void add_sums(std::span<const float> sums, Film& film) {
  check_size(film, sums.size());
  Contents contents(film);
  const size_t of_layout = film.layout().size(), step = kOfPixel + of_layout;
  for (size_t i = 0; i < contents.pixels.size(); ++i) {
    PixelSum& before = contents.pixels[i];
    const PixelSum later = read(&sums[i * step]);
    film.layout().join(before, {contents.values.data() + i * of_layout, of_layout}, later,
                       sums.subspan(i * step + kOfPixel, of_layout));
    before.join(later);
  }
  film.store(film.window(), contents.pixels, contents.values);
}

}  // namespace velour
