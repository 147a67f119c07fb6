#include "btf/formats/ubo_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "btf/measure/btf_measurement.h"
#include "math/sphere/vec.h"

namespace velour {
namespace {

constexpr std::string_view kSignature = "!DFMF08FCR";
constexpr uint64_t kMaxText = uint64_t{1} << 28;
constexpr uint64_t kMaxComponents = 4096;

/// A read position that cannot leave the file.
class Cursor {
 public:
  explicit Cursor(const RandomAccessFile& file) : file_(file) {}

  uint64_t position() const { return position_; }

  void skip(uint64_t bytes, const std::string& field) {
    if (bytes > file_.size() - position_) {
      fail(field + " needs " + std::to_string(bytes) + " bytes at byte " + std::to_string(position_) +
           ", but the file holds " + std::to_string(file_.size()) + "; it is truncated or damaged. Download it again");
    }
    position_ += bytes;
  }

  template <typename T>
  std::vector<T> numbers(uint64_t count, const std::string& field) {
    const uint64_t begin = position_;
    skip(count > kMaxText ? ~uint64_t{0} : count * sizeof(T), field);  // checked before allocating
    std::vector<T> values(count);
    if (count > 0) file_.read(begin, {reinterpret_cast<uint8_t*>(values.data()), count * sizeof(T)});
    return values;
  }

  template <typename T>
  T number(const std::string& field) {
    return numbers<T>(1, field)[0];
  }

  std::string text(uint64_t length, const std::string& field) {
    const std::vector<char> bytes = numbers<char>(length, field);
    return {bytes.begin(), std::ranges::find(bytes, '\0')};
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Status::bad_data, file_.path() + ": " + what + ".");
  }

 private:
  const RandomAccessFile& file_;
  uint64_t position_ = 0;
};

void check_signature(Cursor& in, const std::string& path) {
  const std::string signature = in.text(kSignature.size(), "the signature");
  if (signature == kSignature) return;
  throw Error(Status::unsupported, path + ": is a BTF file of the University of Bonn with signature '" + signature +
                                       "'; only '" + std::string(kSignature) + "' (UBO2014) is supported.");
}

void read_meta(Cursor& in, UboHeader& header) {
  const uint64_t begin = in.position();
  const auto size = in.number<uint32_t>("the size of the description");
  header.version = in.number<uint32_t>("the version");
  header.setup = in.text(80, "the measurement setup");
  header.sensor = in.text(80, "the image sensor");
  header.light_source = in.text(80, "the light source");
  header.pixels_per_mm = in.number<float>("the number of pixels per millimeter");
  in.skip(12, "the color scale");
  if (header.version > 1) header.cosine = in.number<uint32_t>("the cosine flag") != 0;
  if (header.version > 2) in.skip(in.number<uint32_t>("the size of the XML"), "the XML");
  const auto channels = header.version > 3 ? in.number<uint32_t>("the number of channels") : 3;
  if (channels != 3) in.fail("has " + std::to_string(channels) + " channels; only red, green and blue are supported");
  for (uint32_t c = 0; header.version > 3 && c < channels; ++c) {
    in.skip(in.number<uint32_t>("the length of a channel name"), "a channel name");
  }
  if (in.position() != begin + size) {
    in.fail("the description has " + std::to_string(in.position() - begin) + " bytes instead of " +
            std::to_string(size) + "; the file is damaged or has another version");
  }
}

PolarAngles degrees_of(float theta, float phi) {
  return {static_cast<double>(theta) * (180 / kPiD), static_cast<double>(phi) * (180 / kPiD)};
}

/// Views with the lights of each, in the order of the file.
struct Sampling {
  std::vector<PolarAngles> views;
  std::vector<std::vector<PolarAngles>> lights;
};

Sampling read_sampling(Cursor& in) {
  Sampling sampling;
  const auto views = in.number<uint32_t>("the number of views");
  if (views == 0 || views > kMaxDirections) in.fail("has " + std::to_string(views) + " views; it must have 1 to 4096");
  for (uint32_t v = 0; v < views; ++v) {
    const std::vector<float> view = in.numbers<float>(2, "a view");
    const auto count = in.number<uint32_t>("the number of lights");
    if (count > kMaxDirections)
      in.fail("has " + std::to_string(count) + " lights for a view; at most 4096 are supported");
    const std::vector<float> lights = in.numbers<float>(2 * uint64_t{count}, "lights");
    sampling.views.push_back(degrees_of(view[0], view[1]));
    sampling.lights.emplace_back();
    for (uint32_t l = 0; l < count; ++l) sampling.lights.back().push_back(degrees_of(lights[2 * l], lights[2 * l + 1]));
  }
  return sampling;
}

/// Merges the lights of all views into one list and finds the matrix row of each pair of the layout.
void lay_out(Cursor& in, const Sampling& sampling, UboHeader& header) {
  std::map<std::pair<double, double>, uint32_t> number;
  std::vector<PolarAngles> lights;
  std::vector<std::vector<uint32_t>> lights_of_view;
  uint64_t first_row = 0;
  for (const std::vector<PolarAngles>& of_view : sampling.lights) {
    std::map<uint32_t, uint64_t> row_of_light;
    for (uint64_t i = 0; i < of_view.size(); ++i) {
      const auto [at, is_new] = number.emplace(std::pair(of_view[i].theta, of_view[i].phi), lights.size());
      if (is_new) lights.push_back(of_view[i]);
      row_of_light.emplace(at->second, first_row + i);
    }
    if (row_of_light.size() != of_view.size()) in.fail("a view has the same light more than once; the file is damaged");
    lights_of_view.emplace_back();
    for (const auto& [light, row] : row_of_light) {
      lights_of_view.back().push_back(light);
      header.row_of_pair.push_back(row);
    }
    first_row += of_view.size();
  }
  if (lights.size() > kMaxDirections) {
    in.fail("has " + std::to_string(sampling.views.size()) + " views and, in all, " + std::to_string(lights.size()) +
            " different lights; at most 4096 of each are supported");
  }
  try {
    header.layout.emplace(sampling.views, lights, lights_of_view);
  } catch (const Error& error) {
    in.fail(error.what());
  }
}

void read_size(Cursor& in, UboHeader& header) {
  header.width = in.number<uint32_t>("the width");
  header.height = in.number<uint32_t>("the height");
  const auto is_size = [](uint32_t n) { return n > 0 && n <= kMaxTexelsAlong; };
  if (!is_size(header.width) || !is_size(header.height)) {
    in.fail("has " + std::to_string(header.width) + " x " + std::to_string(header.height) +
            " texels; it must have 1 to 16384 along each side");
  }
  const auto rotations = in.number<uint32_t>("the number of rotations");
  in.skip(uint64_t{rotations} * 9 * sizeof(float), "the rotations");
}

UboColors read_colors(Cursor& in, const std::string& path) {
  in.skip(4, "the number of components");  // the maximum over the channels
  const auto model = in.number<int32_t>("the color model");
  in.skip(12 * sizeof(float), "the mean and matrix of the color model");
  for (const UboColors known :
       {UboColors::rgb, UboColors::yuv, UboColors::log_y_uv, UboColors::log_y_ratios, UboColors::log_rgb}) {
    if (model == static_cast<int32_t>(known)) return known;
  }
  throw Error(Status::unsupported,
              path + ": has color model " + std::to_string(model) + "; only 0, 1, 9, 11 and 12 are supported.");
}

UboMatrix read_matrix(Cursor& in, uint64_t rows, const UboChannel& channel, const std::string& field) {
  const UboMatrix matrix{in.position(), rows};
  in.skip(rows * channel.components * channel.scalar_bytes, field);
  return matrix;
}

UboChannel read_channel(Cursor& in, uint64_t pairs, uint64_t texels) {
  UboChannel channel;
  channel.scalar_bytes = in.number<uint8_t>("the number of bytes per value");
  channel.components = in.number<uint32_t>("the number of components");
  const uint64_t left = in.number<uint32_t>("the number of rows");
  const uint64_t right = in.number<uint32_t>("the number of columns");
  if (channel.scalar_bytes != 2 && channel.scalar_bytes != 4 && channel.scalar_bytes != 8) {
    in.fail("has values of " + std::to_string(channel.scalar_bytes) + " bytes; it must be 2, 4 or 8");
  }
  if (channel.components == 0 || channel.components > kMaxComponents) {
    in.fail("has " + std::to_string(channel.components) + " components; it must have 1 to 4096");
  }
  const bool pairs_first = left == pairs && right == texels;
  if (!pairs_first && !(left == texels && right == pairs)) {
    in.fail("has factors of " + std::to_string(left) + " and " + std::to_string(right) + " rows, but there are " +
            std::to_string(pairs) + " view-light pairs and " + std::to_string(texels) + " texels");
  }
  in.skip(channel.components * channel.scalar_bytes, "the singular values");
  UboMatrix& first = pairs_first ? channel.pairs : channel.texels;
  UboMatrix& second = pairs_first ? channel.texels : channel.pairs;
  first = read_matrix(in, left, channel, "the left factor");
  second = read_matrix(in, right, channel, "the right factor");
  return channel;
}

}  // namespace

UboHeader read_ubo_header(const RandomAccessFile& file) {
  Cursor in(file);
  UboHeader header;
  check_signature(in, file.path());
  read_meta(in, header);
  lay_out(in, read_sampling(in), header);
  read_size(in, header);
  header.colors = read_colors(in, file.path());
  for (UboChannel& channel : header.channels) {
    channel = read_channel(in, header.layout->pairs(), uint64_t{header.width} * header.height);
  }
  return header;
}

}  // namespace velour
