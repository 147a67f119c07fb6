#include "btf/formats/image_set.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include "base/error.h"
#include "base/file.h"
#include "base/text_number.h"
#include "image/picture.h"
#include "math/sphere/directions.h"

namespace velour {

namespace fs = std::filesystem;
namespace {

/// Header attributes that describe Velour's own exports.
constexpr const char* kValuesText = "velour.values";
constexpr const char* kTileText = "velour.tile_metres";

/// A set of directions and the index of each.
class DirectionSet {
 public:
  void add(const PolarAngles& d, uint64_t number) {
    const auto [at, is_new] = number_.emplace(std::pair(d.theta, d.phi), number);
    if (!is_new) at->second = std::min(at->second, number);
  }
  /// Directions in the order of their smallest numbers.
  std::vector<PolarAngles> ordered() {
    std::vector<std::pair<uint64_t, PolarAngles>> order;
    for (const auto& [angles, number] : number_) order.push_back({number, {angles.first, angles.second}});
    std::ranges::stable_sort(order, {}, [](const auto& entry) { return entry.first; });
    std::vector<PolarAngles> directions;
    for (const auto& [number, d] : order) {
      number_[{d.theta, d.phi}] = directions.size();
      directions.push_back(d);
    }
    return directions;
  }
  /// Requires ordered().
  uint32_t place(const PolarAngles& d) const { return static_cast<uint32_t>(number_.at({d.theta, d.phi})); }

 private:
  std::map<std::pair<double, double>, uint64_t> number_;
};

struct OrderedPictures {
  std::optional<PairLayout> layout;
  std::vector<std::string> paths;  // [pair]
};

/// Throws Error(bad_data) with the source's name if the directions are invalid.
OrderedPictures ordered(const ImageSetSource& source) {
  DirectionSet views, lights;
  for (const PairPicture& p : source.pictures) {
    views.add(p.view, p.view_number);
    lights.add(p.light, p.light_number);
  }
  const std::vector<PolarAngles> view_list = views.ordered(), light_list = lights.ordered();
  if (view_list.size() > kMaxDirections || light_list.size() > kMaxDirections) {
    throw Error(Status::bad_data, source.path + ": has " + std::to_string(view_list.size()) + " views and " +
                                      std::to_string(light_list.size()) +
                                      " lights; at most 4096 of each are supported. Remove the images of the others.");
  }
  std::vector<std::map<uint32_t, std::string>> by_view(view_list.size());
  for (const PairPicture& p : source.pictures) by_view[views.place(p.view)][lights.place(p.light)] = p.path;
  OrderedPictures result;
  std::vector<std::vector<uint32_t>> lights_of_view;
  for (const auto& pictures : by_view) {
    lights_of_view.emplace_back();
    for (const auto& [light, path] : pictures) {
      lights_of_view.back().push_back(light);
      result.paths.push_back(path);
    }
  }
  try {
    result.layout.emplace(view_list, light_list, lights_of_view);
  } catch (const Error& error) {
    throw Error(Status::bad_data, source.path + ": " + error.what());
  }
  return result;
}

BtfValues values_of(const BtfLoadOptions& options, const std::string& picture) {
  if (options.values != BtfValues::automatic) return options.values;
  return read_picture_text(picture, kValuesText) == "brdf" ? BtfValues::brdf : BtfValues::radiance;
}

std::optional<Vec2> tile_of(const BtfLoadOptions& options, const std::string& picture) {
  if (options.tile_metres) return options.tile_metres;
  const std::string text = read_picture_text(picture, kTileText).value_or("");
  const size_t blank = std::min(text.find(' '), text.size());
  const auto x = number_from(text.substr(0, blank)), y = number_from(text.substr(std::min(blank + 1, text.size())));
  if (!x || !y) return std::nullopt;
  const Vec2 tile(*x, *y);
  return is_tile_size(tile) ? std::optional(tile) : std::nullopt;
}

std::string curve_text(const TransferCurve& curve) {
  return curve.gamma ? "stored^" + std::to_string(*curve.gamma) : std::string("sRGB");
}

bool is_outside(const std::string& picture, const fs::path& folder) {
  const fs::path from_folder = fs::absolute(picture).lexically_normal().lexically_relative(folder);
  return from_folder.empty() || *from_folder.begin() == "..";
}

/// Warns of images outside the index's folder: an index may name any file here, whose pixels would go into the model.
std::vector<Warning> pictures_elsewhere(const ImageSetSource& source) {
  const fs::path given = fs::absolute(source.path).lexically_normal();
  const fs::path folder = fs::is_directory(given) ? given : given.parent_path();
  const auto outside = [&](const PairPicture& p) { return is_outside(p.path, folder); };
  const auto first = std::ranges::find_if(source.pictures, outside);
  if (first == source.pictures.end()) return {};
  return {warning<WarningCode::images_outside_folder>(
      {{"index", source.path},
       {"outside", static_cast<uint64_t>(std::ranges::count_if(source.pictures, outside))},
       {"images", source.pictures.size()},
       {"first", first->path}})};
}

/// The code of a warning about images of a set, in place of that about one image; empty if there is none.
std::optional<WarningCode> code_for_sets(WarningCode code) {
  switch (code) {
    case WarningCode::channels_ignored:
      return WarningCode::images_channels_ignored;
    case WarningCode::parts_ignored:
      return WarningCode::images_parts_ignored;
    case WarningCode::channel_missing:
      return WarningCode::images_channel_missing;
    case WarningCode::color_space_ignored:
      return WarningCode::images_color_space_ignored;
    default:
      return std::nullopt;
  }
}

/// One warning of each kind, about its first image and with the number of images, from those of all images.
std::vector<Warning> summarized(std::span<const std::vector<Warning>> by_image) {
  std::map<WarningCode, std::pair<const Warning*, uint64_t>> kinds;  // the first, and the number
  for (const std::vector<Warning>& warnings : by_image) {
    for (const Warning& warning : warnings) ++kinds.try_emplace(warning.code, &warning, 0).first->second.second;
  }
  std::vector<Warning> summary;
  for (const auto& [code, kind] : kinds) {
    Warning warning = *kind.first;
    if (const auto of_set = code_for_sets(code)) {
      warning.code = *of_set;
      for (auto& [name, value] : warning.values)
        if (name == "file") name = "first";
      warning.values.insert(warning.values.begin(), {{"images", kind.second}, {"all", uint64_t{by_image.size()}}});
    }
    summary.push_back(std::move(warning));
  }
  return summary;
}

class ImageSet : public BtfMeasurement {
 public:
  ImageSet(const ImageSetSource& source, const BtfLoadOptions& options)
      : options_(options), warnings_(pictures_elsewhere(source)) {
    OrderedPictures pictures = ordered(source);
    layout_ = std::move(pictures.layout);
    paths_ = std::move(pictures.paths);
    scale_ = scale_of(values_of(options, paths_[0]));
    read_headers();
    grid_.tile_metres = tile_of(options, paths_[0]);
    name_source(source);
  }

  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    check_range(first, count);
    const uint64_t image = grid_.texels() * 3;
    tbb::parallel_for(uint64_t{0}, count,
                      [&](uint64_t i) { read_picture_of(first + i, values.subspan(i * image, image)); });
  }

  std::optional<std::vector<float>> read_coverage(uint32_t view) const override {
    const uint64_t first = layout().first(view);
    if (!has_alpha_ || first == layout().first(view + 1)) return std::nullopt;
    const Picture picture = read_picture(paths_[first], picture_options());
    check_size(picture, first);
    if (!has_alpha(picture)) {
      throw Error(Status::bad_data, paths_[first] + ": has no alpha channel, but " + paths_[0] +
                                        " has one. Save all images of the set in the same way.");
    }
    const auto channels = static_cast<size_t>(picture.channels);
    std::vector<float> coverage;
    for (size_t i = channels; i <= picture.pixels.size(); i += channels) {
      coverage.push_back(std::clamp(picture.pixels[i - 1], 0.0f, 1.0f));
    }
    return coverage;
  }
  bool has_coverage() const override { return has_alpha_; }

  std::vector<std::pair<std::string, std::string>> details() const override {
    return {{"values", scale_.text()},
            {"curve", curve_text(options_.curve) + " for integer images, none for float images"},
            {"colors", colors_text()},
            {"first_picture", paths_[0]}};
  }

  std::vector<Warning> warnings() const override { return warnings_; }

 private:
  PictureOptions picture_options() const {
    PictureOptions options{.curve = options_.curve, .layer = options_.layer, .keeps_not_finite = true};
    if (options_.colors == BtfColors::xyz) options.primaries = kCieXyz;
    return options;
  }

  std::string colors_text() const {
    return options_.colors == BtfColors::xyz ? "CIE XYZ, converted to linear Rec. 709" : "linear Rec. 709";
  }

  static bool has_alpha(const Picture& picture) { return picture.channels == 2 || picture.channels == 4; }

  /// Checks the sizes of all images and collects their warnings.
  void read_headers() {
    const Picture first = read_picture_header(paths_[0], picture_options());
    if (first.width > static_cast<int>(kMaxTexelsAlong) || first.height > static_cast<int>(kMaxTexelsAlong)) {
      throw Error(Status::bad_data,
                  paths_[0] + ": has more than 16384 pixels along a side. Crop or scale the images of the set.");
    }
    grid_ = {static_cast<uint32_t>(first.width), static_cast<uint32_t>(first.height)};
    has_alpha_ = has_alpha(first);
    std::vector<std::vector<Warning>> warnings(paths_.size());
    warnings[0] = first.warnings;
    tbb::parallel_for(size_t{1}, paths_.size(), [&](size_t i) {
      Picture picture = read_picture_header(paths_[i], picture_options());
      check_size(picture, i);
      warnings[i] = std::move(picture.warnings);
    });
    std::ranges::move(summarized(warnings), std::back_inserter(warnings_));
  }

  void check_size(const Picture& picture, uint64_t pair) const {
    if (static_cast<uint32_t>(picture.width) == grid_.width && static_cast<uint32_t>(picture.height) == grid_.height)
      return;
    throw Error(Status::bad_data, paths_[pair] + ": has " + std::to_string(picture.width) + " x " +
                                      std::to_string(picture.height) + " pixels, but " + paths_[0] + " has " +
                                      std::to_string(grid_.width) + " x " + std::to_string(grid_.height) +
                                      ". All images of the set must have the same size.");
  }

  /// The hash covers all names, sizes and angles; hashing the images themselves would take too long.
  void name_source(const ImageSetSource& source) {
    std::string text = scale_.text() + " " + curve_text(options_.curve) + " " + colors_text() + "\n";
    uint64_t bytes = 0;
    for (uint64_t p = 0; p < paths_.size(); ++p) {
      const uint64_t size = fs::file_size(paths_[p]);
      const PolarAngles &l = layout().lights()[layout().light_of(p)], &v = layout().views()[layout().view_of(p)];
      text += fs::path(paths_[p]).filename().string() + " " + std::to_string(size) + " " + std::to_string(l.theta) +
              " " + std::to_string(l.phi) + " " + std::to_string(v.theta) + " " + std::to_string(v.phi) + "\n";
      bytes += size;
    }
    const auto folder = fs::weakly_canonical(source.path);
    provenance_ = {source.path,
                   folder.stem().string(),
                   source.format,
                   std::to_string(paths_.size()) + " images",
                   sha256_hex({reinterpret_cast<const uint8_t*>(text.data()), text.size()}),
                   bytes};
  }

  void read_picture_of(uint64_t pair, std::span<HalfBits> values) const {
    const Picture picture = read_picture(paths_[pair], picture_options());
    check_size(picture, pair);  // the file may have been replaced
    const float scale = scale_.of(layout().lights()[layout().light_of(pair)]);
    std::vector<float> floats(values.size());
    const auto channels = static_cast<size_t>(picture.channels);
    for (uint64_t t = 0; t < grid_.texels(); ++t) {
      const float* pixel = picture.pixels.data() + t * channels;
      const Rgb c = channels >= 3 ? Rgb(pixel[0], pixel[1], pixel[2]) : Rgb(pixel[0]);
      for (int k = 0; k < 3; ++k) floats[3 * t + static_cast<size_t>(k)] = c[k] * scale;
    }
    floats_to_halves(floats, values);
  }

  BtfLoadOptions options_;
  std::vector<Warning> warnings_;
  ValueScale scale_;
  std::vector<std::string> paths_;
  bool has_alpha_ = false;  // whether the first image has alpha
};

}  // namespace

std::shared_ptr<const BtfMeasurement> load_image_set(ImageSetSource source, const BtfLoadOptions& options) {
  return std::make_shared<ImageSet>(source, options);
}

float ValueScale::of(const PolarAngles& light) const {
  // No light is close enough to the plane for this to be 0 (btf/measure/pair_layout.h).
  const double cosine_of_light = cosine ? std::abs(static_cast<double>(unit_direction(light).z)) : 1.0;
  return static_cast<float>(factor / cosine_of_light);
}

std::string ValueScale::text() const {
  if (factor == 1) return cosine ? "f = number / cos(theta_l)" : "f = number";
  return cosine ? "f = number / (pi cos(theta_l))" : "f = number / pi";
}

ValueScale scale_of(BtfValues values) {
  switch (values) {
    case BtfValues::reflectance:
      return {1 / kPiD, false};
    case BtfValues::radiance:
      return {1 / kPiD, true};
    default:
      return {1, false};
  }
}

}  // namespace velour
