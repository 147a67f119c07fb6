#include "image/exr_colors.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>

#include "job/error.h"

namespace velour {
namespace {

enum Role { kRed, kGreen, kBlue, kAlpha, kX, kY, kZ, kRy, kBy, kRoles };
constexpr int kNoRole = -1;

constexpr std::pair<std::string_view, Role> kRoleNames[] = {
    {"r", kRed},       {"red", kRed}, {"g", kGreen}, {"green", kGreen}, {"b", kBlue}, {"blue", kBlue}, {"a", kAlpha},
    {"alpha", kAlpha}, {"x", kX},     {"y", kY},     {"z", kZ},         {"ry", kRy},  {"by", kBy}};
/// Names that programs give to the layer with the complete picture.
constexpr std::string_view kWholePicture[] = {"combined", "rgb", "rgba", "beauty"};

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

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

std::string listed(std::span<const std::string> names) {
  constexpr size_t kShown = 12;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kShown ? text + " and " + std::to_string(names.size() - kShown) + " more" : text;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(Status::unsupported, path + ": " + what);
}

constexpr const char* kHowToChoose = "choose one by its name (--layer, or Layer and Pass of the Image Texture node).";

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
  return {Kind::grey, {c[kY], "", ""}, c[kAlpha], name, {}};
}

ExrColors single(const std::string& channel) {
  return {ExrColors::Kind::grey, {channel, "", ""}, "", layer_of(channel), {}};
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
