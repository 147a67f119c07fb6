#include "image/formats/exr_picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfRgbaYca.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVersion.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include "base/error.h"
#include "base/file.h"
#include "image/formats/exr_header_check.h"
#include "image/open_picture.h"

namespace velour {

namespace {

/// Sort key of channels: layer, colors before others, order of the color, name.
auto order_of(const std::string& channel) {
  constexpr std::string_view kColors = "RYGBA";
  const size_t dot = channel.rfind('.');
  const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
  const std::string last = dot == std::string::npos ? channel : channel.substr(dot + 1);
  const size_t color = last.size() == 1 ? kColors.find(last[0]) : std::string_view::npos;
  return std::tuple(layer, color == std::string_view::npos, color, channel);
}

auto input_error_of(const std::string& path) {
  return [&path](const char* why) { return input_error(path, why); };
}

std::vector<std::string> channels_of(const Imf::Header& header) {
  std::vector<std::string> names;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
    names.emplace_back(channel.name());
  return names;
}

int side(int first, int last) { return static_cast<int>(int64_t{last} - first + 1); }

PictureFrame frame_of(const Imf::Header& header) {
  const Imath::Box2i &data = header.dataWindow(), &whole = header.displayWindow();
  return {side(whole.min.x, whole.max.x), side(whole.min.y, whole.max.y),
          static_cast<int>(int64_t{data.min.x} - whole.min.x), static_cast<int>(int64_t{whole.max.y} - data.max.y)};
}

ColorPrimaries primaries_of(const Imf::Chromaticities& c) {
  const auto xy = [](const Imath::V2f& v) { return std::array<double, 2>{v.x, v.y}; };
  return {xy(c.red), xy(c.green), xy(c.blue), xy(c.white)};
}

/// A part of a file that is checked before OpenEXR sees it.
class OpenExr : public OpenPicture {
 public:
  const PictureHeader& header() const override { return header_; }

  std::optional<std::string> text(const std::string& name) const override {
    const auto* found = exr_header().findTypedAttribute<Imf::StringAttribute>(name);
    return found != nullptr ? std::optional(found->value()) : std::nullopt;
  }

 protected:
  explicit OpenExr(const std::string& path) : path_(path) {
    check_exr_header(path);
    file_.emplace(path.c_str(), 0);
  }

  Imf::MultiPartInputFile& file() const { return *file_; }
  int part_count() const { return file_->parts(); }
  const Imf::Header& exr_header() const { return file_->header(part_); }

  int part() const { return part_; }
  void set_part(int part) {
    part_ = part;
    const Imath::Box2i& window = exr_header().dataWindow();
    header_.width = side(window.min.x, window.max.x);
    header_.height = side(window.min.y, window.max.y);
  }

  /// Reads the channels `names`, interleaved; an empty name gives 0.
  void read_channels(std::span<const std::string> names, std::span<float> values) {
    const size_t pixel = names.size() * sizeof(float);
    const Imath::Box2i& window = exr_header().dataWindow();
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < names.size(); ++c) {
      if (names[c].empty()) {
        for (size_t i = c; i < values.size(); i += names.size()) values[i] = 0;
        continue;
      }
      buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, values.data() + c, window, pixel,
                                               pixel * static_cast<size_t>(header_.width)));
    }
    with_exr_errors(Status::bad_data, input_error_of(path_), [&] {
      Imf::InputPart part(*file_, part_);
      part.setFrameBuffer(buffer);
      part.readPixels(window.min.y, window.max.y);
    });
  }

  void check_sampling(std::span<const std::string> names) const {
    for (const std::string& name : names) {
      const Imf::Channel* channel = exr_header().channels().findChannel(name.c_str());
      if (channel != nullptr && (channel->xSampling != 1 || channel->ySampling != 1)) {
        throw Error(Status::unsupported, path_ + ": channel " + name +
                                             " has a lower resolution than the image, which is not supported. Save all "
                                             "channels at full resolution.");
      }
    }
  }

  std::string path_;
  PictureHeader header_;

 private:
  mutable std::optional<Imf::MultiPartInputFile> file_;
  int part_ = 0;
};

/// All channels of the first part.
class AllChannels : public OpenExr {
 public:
  explicit AllChannels(const std::string& path) : OpenExr(path) {
    set_part(0);
    names_ = channels_of(exr_header());
    std::ranges::sort(names_, {}, order_of);
    header_.channels = static_cast<int>(names_.size());
  }

  void read(std::span<float> values) override {
    check_sampling(names_);
    read_channels(names_, values);
  }

  ExrHeader description() const {
    ExrHeader result{
        header_.width, header_.height, names_, frame_of(exr_header()), {}, Imf::isMultiPart(file().version())};
    for (auto attribute = exr_header().begin(); attribute != exr_header().end(); ++attribute) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
      const std::string_view name = attribute.name();
      const bool is_openexrs = name == "name" || name == "type" || name == "view";
      if (text != nullptr && !is_openexrs) result.texts[attribute.name()] = text->value();
    }
    return result;
  }

 private:
  std::vector<std::string> names_;
};

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string listed(std::span<const std::string> names) {
  constexpr size_t kShown = 12;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kShown ? text + " and " + std::to_string(names.size() - kShown) + " more" : text;
}

/// How surely channels are the colors of a picture: depths are single channels, sometimes called Y, and normals X, Y,
/// Z.
int rank_of(const ExrColors& colors) {
  const auto is_named = [&](const std::string& channel, std::string_view names) {
    return !channel.empty() && names.find(lower(channel).back()) != std::string_view::npos;
  };
  if (colors.kind == ExrColors::Kind::luminance_chroma) return 2;
  if (colors.kind == ExrColors::Kind::gray) return is_named(colors.names[0], "y") ? 1 : 0;
  return std::ranges::any_of(colors.names, [&](const std::string& name) { return is_named(name, "xyz"); }) ? 0 : 2;
}
constexpr int kNamedPart = 3;

/// The picture of a file: the colors of one layer of one part.
class ExrPicture : public OpenExr {
 public:
  ExrPicture(const std::string& path, const std::string& layer) : OpenExr(path) {
    choose(layer);
    check_not_a_cube();
    if (colors_.kind != ExrColors::Kind::luminance_chroma) {
      check_sampling(names_);
    } else if (part() != 0) {
      throw Error(Status::unsupported,
                  path_ + ": luminance and chroma are only supported in the first part. Save the image as RGB.");
    } else {
      check_luminance_names();
    }
    header_.channels = static_cast<int>(names_.size());
    if (!colors_.alpha.empty()) header_.alpha_channel = header_.channels - 1;
    header_.is_xyz = colors_.kind == ExrColors::Kind::rgb && rank_of(colors_) == 0;
    if (Imf::hasChromaticities(exr_header())) {
      const ColorPrimaries primaries = primaries_of(Imf::chromaticities(exr_header()));
      if (is_stated(primaries)) header_.primaries = primaries;
    }
    const PictureFrame frame = frame_of(exr_header());
    if (frame != PictureFrame{header_.width, header_.height, 0, 0}) header_.frame = frame;
    add_warnings();
  }

  void read(std::span<float> values) override {
    if (colors_.kind == ExrColors::Kind::luminance_chroma) return read_luminance_chroma(values);
    read_channels(names_, values);
  }

 private:
  /// Chooses the first of the parts with the best choice of channels; `layer` may also name a part.
  void choose(const std::string& layer) {
    std::string refusal;
    std::vector<std::string> parts;
    int best = -1;
    for (int part = 0; part < part_count(); ++part) {
      const Imf::Header& header = file().header(part);
      if (header.hasType() && Imf::isDeepData(header.type())) continue;
      const std::string name = header.hasName() ? header.name() : "";
      parts.push_back(name);
      const bool is_part = !layer.empty() && lower(name) == lower(layer);
      try {
        ExrColors colors = choose_exr_colors(channels_of(header), is_part ? "" : layer, path_);
        const int rank = is_part ? kNamedPart : rank_of(colors);
        if (rank <= best) continue;
        best = rank;
        colors_ = std::move(colors);
        set_part(part);
      } catch (const Error& error) {
        if (is_part) throw;
        if (refusal.empty()) refusal = error.what();
      }
    }
    if (best >= 0) return set_names();
    if (parts.empty()) {
      throw Error(
          Status::unsupported,
          path_ + ": is a deep image, which is not supported. Flatten it (oiiotool --flatten, or in your compositor).");
    }
    if (parts.size() > 1 && !layer.empty()) refusal += " Its parts are " + listed(parts) + ".";
    throw Error(Status::unsupported, refusal);
  }

  void set_names() {
    const bool gray = colors_.kind == ExrColors::Kind::gray;
    names_.assign(colors_.names.begin(), gray ? colors_.names.begin() + 1 : colors_.names.end());
    if (!colors_.alpha.empty()) names_.push_back(colors_.alpha);
  }

  /// OpenEXR's own reconstruction knows its channels by these names only; it makes others black.
  void check_luminance_names() const {
    const std::string prefix = colors_.layer.empty() ? "" : colors_.layer + ".";
    const std::pair<const std::string&, const char*> named[] = {
        {colors_.names[1], "Y"}, {colors_.names[0], "RY"}, {colors_.names[2], "BY"}, {colors_.alpha, "A"}};
    for (const auto& [name, expected] : named) {
      if (name.empty() || name == prefix + expected) continue;
      throw Error(Status::unsupported, path_ + ": channel " + name + " of a luminance and chroma image must be named " +
                                           prefix + expected + ". Rename it, or save the image as RGB.");
    }
  }

  void check_not_a_cube() const {
    if (Imf::hasEnvmap(exr_header()) && Imf::envmap(exr_header()) == Imf::ENVMAP_CUBE) {
      throw Error(
          Status::unsupported,
          path_ + ": is a cube map, which is not supported. Convert it to an equirectangular image (exrenvmap -l).");
    }
  }

  void add_warnings() {
    if (!colors_.left_out.empty()) {
      header_.warnings.push_back(warning<WarningCode::channels_ignored>(
          {{"file", path_}, {"layer", colors_.layer}, {"channels", colors_.left_out}}));
    }
    if (part_count() > 1) {
      header_.warnings.push_back(
          warning<WarningCode::parts_ignored>({{"file", path_},
                                               {"part", exr_header().hasName() ? exr_header().name() : ""},
                                               {"parts", static_cast<uint64_t>(part_count())}}));
    }
    if (colors_.kind == ExrColors::Kind::rgb && std::ranges::count(colors_.names, "") > 0) {
      header_.warnings.push_back(warning<WarningCode::channel_missing>({{"file", path_}}));
    }
  }

  /// Uses OpenEXR's own reconstruction, which works in half floats.
  void read_luminance_chroma(std::span<float> values) {
    with_exr_errors(Status::bad_data, input_error_of(path_), [&] {
      // Throws if no colors have these chromaticities, for which RgbaInputFile would leak memory.
      Imf::RgbaYca::computeYw(Imf::hasChromaticities(exr_header()) ? Imf::chromaticities(exr_header())
                                                                   : Imf::Chromaticities());
      Imf::RgbaInputFile input(path_.c_str(), colors_.layer, 0);
      const Imath::Box2i& window = input.dataWindow();
      const auto width = static_cast<size_t>(header_.width);
      std::vector<Imf::Rgba> pixels(width * static_cast<size_t>(header_.height));
      const auto origin = static_cast<std::ptrdiff_t>(window.min.y) * static_cast<std::ptrdiff_t>(width) + window.min.x;
      input.setFrameBuffer(pixels.data() - origin, 1, width);
      input.readPixels(window.min.y, window.max.y);
      float* out = values.data();
      for (const Imf::Rgba& pixel : pixels) {
        for (const float v : {float{pixel.r}, float{pixel.g}, float{pixel.b}}) *out++ = v;
        if (!colors_.alpha.empty()) *out++ = float{pixel.a};
      }
    });
  }

  ExrColors colors_;
  std::vector<std::string> names_;  // of the channels that are read, in interleaved order
};

/// Channel names that order_of() sorts in the order of the channels.
std::string channel_name(int channel, int channels) {
  constexpr std::array kColors{"R", "G", "B", "A"};
  if (channels <= 2) return channel == 0 ? "Y" : "A";
  if (channel < 4) return kColors[static_cast<size_t>(channel)];
  const std::string digits = std::to_string(channel);
  return "channel" + std::string(3 - std::min<size_t>(digits.size(), 3), '0') + digits;
}

/// The data window; OpenEXR counts rows from the top.
Imath::Box2i data_window(const Picture& picture, const PictureFrame& frame) {
  const int top = frame.height - frame.y - picture.height;
  return {{frame.x, top}, {frame.x + picture.width - 1, top + picture.height - 1}};
}

void add_texts(Imf::Header& header, const PictureTexts& texts) {
  for (const auto& [name, text] : texts) {
    if (name.empty() || header.find(name) != header.end()) {
      throw Error(Status::invalid_argument,
                  "Image metadata cannot be named '" + name + "'; the name is empty or reserved.");
    }
    header.insert(name, Imf::StringAttribute(text));
  }
}

}  // namespace

std::unique_ptr<OpenPicture> open_exr(const std::string& path, const std::string& layer) {
  return with_exr_errors(Status::bad_data, input_error_of(path),
                         [&] { return std::make_unique<ExrPicture>(path, layer); });
}

std::unique_ptr<OpenPicture> open_exr_channels(const std::string& path) {
  return with_exr_errors(Status::bad_data, input_error_of(path), [&] { return std::make_unique<AllChannels>(path); });
}

ExrHeader read_exr_header(const std::string& path) {
  return with_exr_errors(Status::bad_data, input_error_of(path), [&] { return AllChannels(path).description(); });
}

void write_exr(const std::string& path, const Picture& top_first, const PictureFrame& frame,
               const PictureTexts& texts) {
  const size_t pixel = static_cast<size_t>(top_first.channels) * sizeof(float);
  const Imath::Box2i window = data_window(top_first, frame);
  Imf::Header header(Imath::Box2i({0, 0}, {frame.width - 1, frame.height - 1}), window);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709
  add_texts(header, texts);
  Imf::FrameBuffer buffer;
  for (int c = 0; c < top_first.channels; ++c) {
    const std::string name = channel_name(c, top_first.channels);
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, top_first.pixels.data() + c, window, pixel,
                                         pixel * static_cast<size_t>(top_first.width)));
  }
  AtomicFile file(path);
  const auto sentence = [&](const char* why) { return path + ": OpenEXR cannot write the image: " + why; };
  with_exr_errors(Status::io, sentence, [&] {
    ExrOutput stream(file, path);
    Imf::OutputFile output(stream, header, 0);
    output.setFrameBuffer(buffer);
    output.writePixels(top_first.height);
  });
  file.commit();
}

namespace {

enum Role { kRed, kGreen, kBlue, kAlpha, kX, kY, kZ, kRy, kBy, kRoles };
constexpr int kNoRole = -1;

constexpr std::pair<std::string_view, Role> kRoleNames[] = {
    {"r", kRed},       {"red", kRed}, {"g", kGreen}, {"green", kGreen}, {"b", kBlue}, {"blue", kBlue}, {"a", kAlpha},
    {"alpha", kAlpha}, {"x", kX},     {"y", kY},     {"z", kZ},         {"ry", kRy},  {"by", kBy}};
/// Names that programs give to the layer with the complete picture.
constexpr std::string_view kWholePicture[] = {"combined", "rgb", "rgba", "beauty"};

std::string layer_of(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

std::string_view last_of(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

/// The channels of one layer by their role.
struct Layer {
  std::array<std::string, kRoles> channel;  // empty: none
  std::vector<std::string> all;

  bool has(Role role) const { return !channel[role].empty(); }
  bool has_rgb() const { return has(kRed) || has(kGreen) || has(kBlue); }
  bool has_xyz() const { return has(kX) && has(kY) && has(kZ); }
  bool has_colors() const { return has_rgb() || (has(kY) && !has(kX)); }
};

using Layers = std::map<std::string, Layer>;

Layers layers_of(std::span<const std::string> channels) {
  Layers layers;
  for (const std::string& channel : channels) {
    Layer& layer = layers[layer_of(channel)];
    layer.all.push_back(channel);
    const std::string last = lower(last_of(channel));
    for (const auto& [name, role] : kRoleNames) {
      if (last == name && !layer.has(role)) layer.channel[role] = channel;
    }
  }
  return layers;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(Status::unsupported, path + ": " + what);
}

constexpr const char* kHowToChoose = "choose one by its name with --layer; for Blender, save it as a file of its own.";

std::vector<std::string> keys_where(const Layers& layers, const auto& holds) {
  std::vector<std::string> names;
  for (const auto& [name, layer] : layers) {
    if (holds(name, layer)) names.push_back(name);
  }
  return names;
}

ExrColors colors_of(const std::string& name, const Layer& layer) {
  using Kind = ExrColors::Kind;
  const auto& c = layer.channel;
  if (layer.has_rgb()) return {Kind::rgb, {c[kRed], c[kGreen], c[kBlue]}, c[kAlpha], name, {}};
  if (layer.has_xyz()) return {Kind::rgb, {c[kX], c[kY], c[kZ]}, c[kAlpha], name, {}};
  if (layer.has(kRy) && layer.has(kBy)) return {Kind::luminance_chroma, {c[kRy], c[kY], c[kBy]}, c[kAlpha], name, {}};
  return {Kind::gray, {c[kY], "", ""}, c[kAlpha], name, {}};
}

ExrColors single(const std::string& channel) {
  return {ExrColors::Kind::gray, {channel, "", ""}, "", layer_of(channel), {}};
}

/// The layer that `wanted` names: exactly, case-insensitively, or by its last components.
std::optional<std::string> find_layer(const Layers& layers, const std::string& wanted, const std::string& path) {
  if (layers.contains(wanted)) return wanted;
  const std::string small = lower(wanted);
  const auto same = keys_where(layers, [&](const std::string& name, const Layer&) { return lower(name) == small; });
  if (same.size() == 1) return same[0];
  const auto ends =
      keys_where(layers, [&](const std::string& name, const Layer&) { return lower(name).ends_with("." + small); });
  if (ends.size() == 1) return ends[0];
  if (same.empty() && ends.empty()) return std::nullopt;
  refuse(path,
         "layer '" + wanted + "' is ambiguous: it may be " + listed(same.empty() ? ends : same) + "; " + kHowToChoose);
}

ExrColors choose_layer(const Layers& layers, const std::string& wanted, std::span<const std::string> channels,
                       const std::string& path) {
  if (const auto name = find_layer(layers, wanted, path)) {
    const Layer& layer = layers.at(*name);
    if (layer.has_colors() || layer.has_xyz()) return colors_of(*name, layer);
    if (layer.all.size() == 1) return single(layer.all[0]);
    refuse(path, "none of the channels of layer '" + *name + "' (" + listed(layer.all) +
                     ") is named like a color (R, G, B or Y); choose one of them by its name.");
  }
  const auto channel = std::ranges::find(channels, lower(wanted), [](const std::string& name) { return lower(name); });
  if (channel != channels.end()) return single(*channel);
  refuse(path, "has no layer '" + wanted + "'; its channels are " + listed(channels) + ". Choose one of them.");
}

ExrColors choose_default(const Layers& layers, std::span<const std::string> channels, const std::string& path) {
  if (const auto root = layers.find(""); root != layers.end() && (root->second.has_colors() || root->second.has_xyz()))
    return colors_of("", root->second);
  const auto with_colors =
      keys_where(layers, [](const std::string&, const Layer& layer) { return layer.has_colors(); });
  if (with_colors.size() == 1) return colors_of(with_colors[0], layers.at(with_colors[0]));
  if (with_colors.size() > 1) {
    std::vector<std::string> whole;
    std::ranges::copy_if(with_colors, std::back_inserter(whole), [](const std::string& name) {
      return std::ranges::find(kWholePicture, lower(last_of(name))) != std::end(kWholePicture);
    });
    if (whole.size() == 1) return colors_of(whole[0], layers.at(whole[0]));
    refuse(path, "has several layers with colors (" + listed(with_colors) + "); " + kHowToChoose);
  }
  if (channels.size() == 1) return single(channels[0]);
  refuse(path, "none of its channels (" + listed(channels) + ") is named like a color (R, G, B or Y); " + kHowToChoose);
}

}  // namespace

ExrColors choose_exr_colors(std::span<const std::string> channels, const std::string& layer, const std::string& path) {
  const Layers layers = layers_of(channels);
  ExrColors chosen =
      layer.empty() ? choose_default(layers, channels, path) : choose_layer(layers, layer, channels, path);
  for (const std::string& channel : channels) {
    if (channel != chosen.alpha && std::ranges::find(chosen.names, channel) == chosen.names.end())
      chosen.left_out.push_back(channel);
  }
  return chosen;
}

}  // namespace velour
