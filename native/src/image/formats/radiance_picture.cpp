// Reads Radiance HDR files (G. Ward, "Radiance File Formats", picture files) in every build: OpenImageIO and stb_image
// support neither XYZE nor old run lengths, and ignore orientation, EXPOSURE, COLORCORR and PRIMARIES.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "image/open_picture.h"

namespace velour {
namespace {

constexpr int kMinRunWidth = 8, kMaxRunWidth = 0x7fff;  // of scan lines with components stored separately
using Rgbe = std::array<uint8_t, 4>;

class Radiance : public OpenPicture {
 public:
  explicit Radiance(const std::string& path) : path_(path), bytes_(read_file(path)) {
    while (true) {
      const std::string_view line = next_line();
      if (line.empty()) break;
      read_variable(line);
    }
    read_resolution(next_line());
    header_.channels = 3;
    if (is_xyz_) header_.primaries = kCieXyz;
  }

  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string&) const override { return std::nullopt; }

  void read(std::span<float> values) override {
    std::vector<Rgbe> line(static_cast<size_t>(header_.width));
    float* out = values.data();
    for (int y = 0; y < header_.height; ++y) {
      read_line(line);
      for (const Rgbe& pixel : line) {
        const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - (128 + 8));
        for (size_t c = 0; c < 3; ++c) *out++ = static_cast<float>(pixel[c]) * scale;
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Status::bad_data, path_ + ": cannot be read as a Radiance image: " + what);
  }

  std::string_view next_line() {
    const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const std::string_view rest(begin, bytes_.size() - at_);
    const size_t end = rest.find('\n');
    if (end == std::string_view::npos) fail("the file ends within its header.");
    at_ += end + 1;
    std::string_view line = rest.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void read_variable(std::string_view line) {
    if (line.starts_with("FORMAT=")) return read_format(line.substr(7));
    if (line.starts_with("EXPOSURE=")) return divide_by(numbers_of<1>("EXPOSURE", line.substr(9)));
    if (line.starts_with("COLORCORR=")) return divide_by(numbers_of<3>("COLORCORR", line.substr(10)));
    if (!line.starts_with("PRIMARIES=")) return;
    const auto p = numbers_of<8>("PRIMARIES", line.substr(10));
    const ColorPrimaries primaries{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {p[6], p[7]}};
    if (is_stated(primaries)) header_.primaries = primaries;
  }

  void read_format(std::string_view name) {
    name.remove_prefix(std::min(name.find_first_not_of(" \t"), name.size()));
    name = name.substr(0, name.find_last_not_of(" \t") + 1);
    is_xyz_ = name == "32-bit_rle_xyze";
    if (!is_xyz_ && name != "32-bit_rle_rgbe")
      fail("its FORMAT is '" + std::string(name) + "'; it must be 32-bit_rle_rgbe or 32-bit_rle_xyze.");
  }

  template <size_t kCount>
  std::array<double, kCount> numbers_of(const char* variable, std::string_view text) const {
    std::array<double, kCount> numbers;
    for (double& number : numbers) {
      text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
      if (text.starts_with('+')) text.remove_prefix(1);
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error != std::errc() || !std::isfinite(number))
        fail(std::string(variable) + " must be " + std::to_string(kCount) + " finite number(s).");
      text.remove_prefix(static_cast<size_t>(end - text.data()));
    }
    return numbers;
  }

  /// The stored values have been multiplied by these factors; repeated lines of a variable multiply.
  template <size_t kCount>
  void divide_by(const std::array<double, kCount>& factors) {
    for (size_t c = 0; c < 3; ++c) {
      const double factor = factors[kCount == 3 ? c : 0];
      if (!(factor > 0)) fail("EXPOSURE and COLORCORR must be positive.");
      header_.scale[c] = static_cast<float>(header_.scale[c] / factor);
      if (!std::isfinite(header_.scale[c]))
        fail("EXPOSURE and COLORCORR are too small: the image values would not be finite.");
    }
  }

  /// "-Y 512 +X 1024": rows from the top, pixels from the left. If X comes first, columns are stored as rows.
  void read_resolution(std::string_view line) {
    std::array<char, 2> sign{}, axis{};
    std::array<int, 2> count{};
    std::string_view rest = line;
    for (size_t i = 0; i < 2; ++i) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
      if (rest.size() < 3) fail_resolution(line);
      sign[i] = rest[0];
      axis[i] = rest[1];
      rest.remove_prefix(2);
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
      const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), count[i]);
      if (error != std::errc() || count[i] <= 0 || (sign[i] != '+' && sign[i] != '-')) fail_resolution(line);
      rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    }
    const bool columns = axis[0] == 'X' && axis[1] == 'Y';
    if (!columns && !(axis[0] == 'Y' && axis[1] == 'X')) fail_resolution(line);
    header_.height = count[0];
    header_.width = count[1];
    header_.orientation = orientation_of(columns, sign[columns ? 1 : 0] == '-', sign[columns ? 0 : 1] == '+');
  }

  [[noreturn]] void fail_resolution(std::string_view line) const {
    fail("its resolution line is '" + std::string(line.substr(0, 40)) + "'; it must be like '-Y 512 +X 1024'.");
  }

  static Orientation orientation_of(bool columns, bool from_top, bool from_left) {
    if (columns) {
      if (from_top) return from_left ? Orientation::transposed : Orientation::turned_cw;
      return from_left ? Orientation::turned_ccw : Orientation::transversed;
    }
    if (from_top) return from_left ? Orientation::normal : Orientation::mirrored;
    return from_left ? Orientation::flipped : Orientation::turned_180;
  }

  uint8_t next() {
    if (at_ >= bytes_.size()) fail("the file is truncated.");
    return bytes_[at_++];
  }
  Rgbe next_pixel() { return {next(), next(), next(), next()}; }

  void read_line(std::vector<Rgbe>& line) {
    const auto width = static_cast<int>(line.size());
    if (width < kMinRunWidth || width > kMaxRunWidth || repeats_ > 0) return read_old_line(line);
    const Rgbe first = next_pixel();
    if (first[0] != 2 || first[1] != 2 || (first[2] & 0x80) != 0) {
      at_ -= first.size();
      return read_old_line(line);
    }
    if (((first[2] << 8) | first[3]) != width) fail("the length of a scan line does not match the resolution.");
    for (size_t component = 0; component < 4; ++component) read_component(line, component);
  }

  void read_component(std::vector<Rgbe>& line, size_t component) {
    for (size_t x = 0; x < line.size();) {
      size_t count = next();
      const bool run = count > 128;
      if (run) count -= 128;
      if (count == 0 || count > line.size() - x) fail("a run in a scan line is too long.");
      const uint8_t repeated = run ? next() : uint8_t{0};
      for (const size_t end = x + count; x < end; ++x) line[x][component] = run ? repeated : next();
    }
  }

  /// Reads pixels and run lengths: (1, 1, 1, n) repeats the previous pixel n times, even beyond the end of the line.
  /// Consecutive run lengths are the bytes of one, the lowest first.
  void read_old_line(std::vector<Rgbe>& line) {
    for (Rgbe& to : line) {
      while (repeats_ == 0) {
        const Rgbe pixel = next_pixel();
        const bool is_count = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
        if (!is_count) {
          repeated_ = pixel;
          repeats_ = 1;
          digit_ = 0;
        } else {
          if (!repeated_ || digit_ > 2) fail("a run in a scan line has no pixel or is too long.");
          repeats_ = size_t{pixel[3]} << (8 * digit_++);
        }
      }
      to = *repeated_;
      --repeats_;
    }
  }

  std::string path_;
  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
  bool is_xyz_ = false;
  // State of old run lengths.
  std::optional<Rgbe> repeated_;
  size_t repeats_ = 0;  // remaining repetitions of it
  int digit_ = 0;       // byte index of the next run length
  PictureHeader header_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_radiance(const std::string& path) { return std::make_unique<Radiance>(path); }

}  // namespace velour
