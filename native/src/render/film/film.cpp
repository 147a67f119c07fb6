#include "render/film/film.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>
#include "base/error.h"

namespace velour {

namespace {

void write_combined(const PixelSum& p, float* out) {
  const float scale = p.weight();
  out[0] = p.radiance.r * scale;
  out[1] = p.radiance.g * scale;
  out[2] = p.radiance.b * scale;
  out[3] = p.alpha * scale;
}

void write_depth(const PixelSum& p, float* out) { out[0] = p.depth; }

void write_normal(const PixelSum& p, float* out) {
  const float scale = p.weight();
  for (int c = 0; c < 3; ++c) out[c] = p.normal[c] * scale;
}

void write_count(const PixelSum& p, float* out) { out[0] = static_cast<float>(p.directions); }

struct Pass {
  std::string_view name;
  int channels;
  void (*write)(const PixelSum&, float*);
};

constexpr Pass kPasses[] = {{"Combined", 4, write_combined},
                            {"Depth", 1, write_depth},
                            {"Normal", 3, write_normal},
                            {"Sample Count", 1, write_count}};

constexpr std::string_view kDenoised = "Denoised";

/// Null unless `name` is a pass that every film has.
const Pass* find_pass(std::string_view name) {
  const auto* found = std::ranges::find(kPasses, name, &Pass::name);
  return found != std::end(kPasses) ? found : nullptr;
}

void check_size(std::string_view name, size_t expected, size_t given) {
  if (given == expected) return;
  throw Error(Status::invalid_argument, "Pass \"" + std::string(name) + "\" has " + std::to_string(expected) +
                                            " values, not " + std::to_string(given) + ".");
}

}  // namespace

Film::Film(const PixelRect& window, PassOptions options)
    : window_(window), options_(std::move(options)), layout_(options_) {
  if (window.width() <= 0 || window.height() <= 0) {
    throw Error(Status::invalid_argument, "An image of " + std::to_string(window.width()) + " x " +
                                              std::to_string(window.height()) +
                                              " pixels cannot be rendered; it must have at least one pixel.");
  }
  pixels_.resize(static_cast<size_t>(window.width()) * static_cast<size_t>(window.height()));
  values_.resize(pixels_.size() * layout_.size());
}

void Film::clear() {
  const std::lock_guard lock(mutex_);
  std::ranges::fill(pixels_, PixelSum{});
  std::ranges::fill(values_, 0.0f);
  denoised_.clear();
}

namespace {

/// Calls copy(offset of the row in the film, offset in the tile) for every row of `rect`.
template <typename Copy>
void for_rows(const PixelRect& rect, const PixelRect& window, Copy&& copy) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    copy(static_cast<std::ptrdiff_t>(y - window.y0) * window.width() + rect.x0 - window.x0,
         static_cast<std::ptrdiff_t>(y - rect.y0) * rect.width());
  }
}

}  // namespace

void Film::load(const PixelRect& rect, std::span<PixelSum> pixels, std::span<float> values) const {
  const std::lock_guard lock(mutex_);
  const auto size = values.empty() ? 0 : static_cast<std::ptrdiff_t>(layout_.size());
  for_rows(rect, window_, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    std::copy_n(pixels_.begin() + from, rect.width(), pixels.begin() + to);
    std::copy_n(values_.begin() + size * from, size * rect.width(), values.begin() + size * to);
  });
}

void Film::store(const PixelRect& rect, std::span<const PixelSum> pixels, std::span<const float> values) {
  const std::lock_guard lock(mutex_);
  const auto size = values.empty() ? 0 : static_cast<std::ptrdiff_t>(layout_.size());
  for_rows(rect, window_, [&](std::ptrdiff_t to, std::ptrdiff_t from) {
    std::copy_n(pixels.begin() + from, rect.width(), pixels_.begin() + to);
    std::copy_n(values.begin() + size * from, size * rect.width(), values_.begin() + size * to);
  });
  denoised_.clear();
}

void Film::keep_denoised(std::vector<float> colors, std::optional<DenoisedError> error) {
  const std::lock_guard lock(mutex_);
  check_size(kDenoised, 3 * pixels_.size(), colors.size());
  denoised_ = std::move(colors);
  denoised_error_ = error;
}

bool Film::is_denoised() const {
  const std::lock_guard lock(mutex_);
  return !denoised_.empty();
}

std::optional<DenoisedError> Film::denoised_error() const {
  const std::lock_guard lock(mutex_);
  return denoised_.empty() ? std::nullopt : denoised_error_;
}

int Film::channels(std::string_view name) {
  if (const Pass* pass = find_pass(name)) return pass->channels;
  if (name == kDenoised) return 4;
  if (const int count = PassLayout::channels(name)) return count;
  throw Error(Status::invalid_argument,
              "Unknown pass \"" + std::string(name) +
                  "\"; use Combined, Depth, Normal, Sample Count, Denoised, Position, UV, IndexOB, IndexMA, Mist, "
                  "Albedo, Error, Denoising Albedo, Halves, CryptoObject00, CryptoMaterial00 or CryptoAsset00.");
}

void Film::read_pass(std::string_view name, std::span<float> pixels) const {
  const std::lock_guard lock(mutex_);
  check_size(name, pixels_.size() * static_cast<size_t>(channels(name)), pixels.size());
  if (name == kDenoised) return read_denoised(pixels);
  const Pass* pass = find_pass(name);
  if (pass == nullptr) return read_layout(name, pixels);
  float* out = pixels.data();
  for (const PixelSum& pixel : pixels_) {
    pass->write(pixel, out);
    out += pass->channels;
  }
}

void Film::read_layout(std::string_view name, std::span<float> pixels) const {
  if (!layout_.has(name)) {
    throw Error(Status::invalid_argument, "The pass \"" + std::string(name) +
                                              "\" was not requested when the render was created (vlr_pass_options).");
  }
  layout_.write(name, pixels_, values_, pixels.data());
}

void Film::read_denoised(std::span<float> pixels) const {
  if (denoised_.empty())
    throw Error(Status::invalid_state, "The image has not been denoised since its last change. Denoise it first.");
  for (size_t i = 0; i < pixels_.size(); ++i) {
    std::copy_n(&denoised_[3 * i], 3, &pixels[4 * i]);
    pixels[4 * i + 3] = pixels_[i].alpha * pixels_[i].weight();
  }
}

void Film::read_over(const Film* coarser, std::span<float> pixels) const {
  if (coarser == nullptr) return read_pass("Combined", pixels);
  check_size("Combined", 4 * pixels_.size(), pixels.size());
  const std::lock_guard lock(mutex_), other(coarser->mutex_);
  float* out = pixels.data();
  for (int y = 0; y < height(); ++y) {
    const int row = y * coarser->height() / height() * coarser->width();
    for (int x = 0; x < width(); ++x, out += 4) {
      const PixelSum& own = pixels_[static_cast<size_t>(y * width() + x)];
      const PixelSum& under = coarser->pixels_[static_cast<size_t>(row + x * coarser->width() / width())];
      write_combined(own.camera_rays > 0 ? own : under, out);
    }
  }
}

uint64_t Film::directions() const {
  const std::lock_guard lock(mutex_);
  uint64_t sum = 0;
  for (const PixelSum& p : pixels_) sum += p.directions;
  return sum;
}

double Film::noise() const {
  const std::lock_guard lock(mutex_);
  double variance = 0.0, mean = 0.0;
  for (const PixelSum& p : pixels_) {
    if (p.camera_rays < 2) return 0.0;
    mean += p.mean_luminance();
    variance += p.variance();
  }
  const double count = static_cast<double>(pixels_.size());
  return mean > 0.0 ? std::sqrt(variance / count) / (mean / count) : 0.0;
}

namespace {

constexpr size_t kOfPixel = 12;
constexpr uint32_t kMaxCount = 1u << 24;  // above, floats skip integers

float float_of(uint32_t count) {
  if (count <= kMaxCount) return static_cast<float>(count);
  throw Error(Status::unsupported, "A pixel of this part has " + std::to_string(count) +
                                       " samples, but the sums of a part hold at most 16777216 per pixel. Render "
                                       "several parts with fewer samples.");
}

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
                                  float_of(p.camera_rays),
                                  float_of(p.directions)};
  std::ranges::copy(values, out);
}

uint32_t count(float value) {
  if (value >= 0.0f && value <= static_cast<float>(kMaxCount) && value == std::floor(value))
    return static_cast<uint32_t>(value);
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

namespace {

/// Maximum number of pixels of the first level, and of the coarsest one.
constexpr int kFirstPixels = 16000;
constexpr int kCoarsestPixels = 1000;
/// Maximum time of the first level. A change is visible in the current redraw if it is ready within the add-on's
/// patience (40 ms), in which the hierarchy and the lights are rebuilt as well.
constexpr double kLateSeconds = 0.015;
/// The next finer level takes four times as long; the remaining factor of two keeps images from alternating.
constexpr double kEarlySeconds = kLateSeconds / 8;

int halvings(int width, int height, int most_pixels) {
  int n = 0;
  while (divided(width, 1 << n) * divided(height, 1 << n) > most_pixels) ++n;
  return n;
}

}  // namespace

FirstLevel::FirstLevel(int width, int height)
    : last_(halvings(width, height, kCoarsestPixels)),
      finest_(last_ - halvings(width, height, kFirstPixels)),
      first_(finest_) {}

void FirstLevel::took(double seconds, bool is_whole) {
  if (seconds > kLateSeconds && first_ > 0) {
    --first_;
  } else if (is_whole && seconds < kEarlySeconds && first_ < finest_) {
    ++first_;
  }
}

}  // namespace velour
