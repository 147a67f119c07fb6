#include "btf/formats/image_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"

namespace velour {
namespace fs = std::filesystem;
namespace {

/// Maximum depth of subfolders, in case a whole disk is given by mistake.
constexpr int kMaxDepth = 3;
constexpr size_t kMaxPictures = kMaxDirections * kMaxDirections;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

struct KeyedAngle {
  size_t at;  // position of the key
  double degrees;
};

/// Degrees after `key`, which must occur exactly once as a separate word. `name` must be lower case.
std::optional<KeyedAngle> find_angle(std::string_view name, std::string_view key) {
  std::optional<KeyedAngle> found;
  for (size_t at = name.find(key); at != std::string_view::npos; at = name.find(key, at + 1)) {
    size_t number = at + key.size();
    if (number < name.size() && (name[number] == '_' || name[number] == ' ' || name[number] == '=')) ++number;
    const bool word = (at == 0 || !is_letter(name[at - 1])) && number < name.size() && is_digit(name[number]);
    if (!word) continue;
    if (found) return std::nullopt;
    found = {at, 0};
    std::from_chars(name.data() + number, name.data() + name.size(), found->degrees, std::chars_format::fixed);
  }
  return found;
}

/// The number at the end of `text`, ignoring separators after it.
std::optional<uint64_t> trailing_number(std::string_view text) {
  while (!text.empty() && !is_digit(text.back()) && !is_letter(text.back())) text.remove_suffix(1);
  size_t begin = text.size();
  while (begin > 0 && is_digit(text[begin - 1])) --begin;
  if (begin == text.size() || (begin > 0 && is_letter(text[begin - 1]))) return std::nullopt;
  uint64_t number = 0;
  const auto result = std::from_chars(text.data() + begin, text.data() + text.size(), number);
  return result.ec == std::errc() ? std::optional(number) : std::nullopt;
}

std::string padded(uint64_t number, size_t digits) {
  std::string text = std::to_string(number);
  return text.insert(0, text.size() < digits ? digits - text.size() : 0, '0');
}

std::string angle_text(double degrees) {
  const auto whole = static_cast<uint64_t>(degrees);
  const double rest = degrees - static_cast<double>(whole);
  return padded(whole, 3) + (rest > 0 ? std::to_string(rest).substr(1) : "");  // .500000 from 0.500000
}

bool is_picture_name(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  constexpr std::array kExtensions = {".jpg", ".jpeg", ".png", ".exr", ".hdr", ".tif", ".tiff", ".bmp"};
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

struct NamedPicture {
  std::string path;
  NamedAngles angles;
};

std::vector<NamedPicture> list_pictures(const std::string& folder) {
  std::vector<NamedPicture> pictures;
  std::error_code failure;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    if (at.depth() == kMaxDepth) at.disable_recursion_pending();
    const fs::path& path = at->path();
    if (path.filename().string().starts_with('.') || !is_picture_name(path) || !at->is_regular_file()) continue;
    const auto angles = angles_of_name(path.stem().string());
    if (!angles) {
      throw Error(Status::bad_data, path.string() +
                                        ": the file name does not contain the angles, as in '00081 tl015 pl000 tv000 "
                                        "pv000.jpg'. Rename the file, or remove it from the folder.");
    }
    if (pictures.size() == kMaxPictures)
      throw Error(Status::bad_data, folder + ": the folder contains more than 4096 x 4096 images.");
    pictures.push_back({path.string(), *angles});
  }
  if (failure) throw Error(Status::io, folder + ": cannot be read: " + failure.message() + ".");
  if (pictures.empty()) {
    throw Error(Status::bad_data, folder +
                                      ": the folder contains neither images named by their angles, as in '00081 tl015 "
                                      "pl000 tv000 pv000.jpg', nor an index of images, btf.csv.");
  }
  return pictures;
}

auto key_of(const PolarAngles& d) { return std::tuple(d.theta, d.phi); }
auto key_of(const NamedAngles& a) { return std::tuple(a.view.theta, a.view.phi, a.light.theta, a.light.phi); }

void refuse_twins(const std::vector<NamedPicture>& sorted) {
  const auto same = [](const NamedPicture& a, const NamedPicture& b) { return key_of(a.angles) == key_of(b.angles); };
  const auto twin = std::ranges::adjacent_find(sorted, same);
  if (twin == sorted.end()) return;
  throw Error(Status::bad_data, twin->path + ": has the same angles as " + std::next(twin)->path +
                                    "; remove one of the two from the folder.");
}

void refuse_gaps(const std::string& folder, const std::vector<NamedPicture>& sorted) {
  std::set<std::tuple<double, double>> views, lights;
  std::set<std::tuple<double, double, double, double>> pairs;
  for (const NamedPicture& p : sorted) {
    views.insert(key_of(p.angles.view));
    lights.insert(key_of(p.angles.light));
    pairs.insert(key_of(p.angles));
  }
  const size_t missing = views.size() * lights.size() - pairs.size();
  if (missing == 0) return;
  for (const auto& view : views) {
    for (const auto& light : lights) {
      if (pairs.contains(std::tuple_cat(view, light))) continue;
      const NamedAngles gap{{std::get<0>(light), std::get<1>(light)}, {std::get<0>(view), std::get<1>(view)}, {}};
      throw Error(Status::bad_data, folder + ": " + std::to_string(missing) + " of " +
                                        std::to_string(views.size() * lights.size()) +
                                        " images are missing, the first is '" + name_of_angles(gap) +
                                        "'. Copy the set again, or list the existing images in a CSV index, btf.csv.");
    }
  }
}

bool all_have_indices(const std::vector<NamedPicture>& pictures) {
  std::set<uint64_t> seen;
  return std::ranges::all_of(
      pictures, [&](const NamedPicture& p) { return p.angles.index && seen.insert(*p.angles.index).second; });
}

}  // namespace

std::optional<NamedAngles> angles_of_name(std::string_view stem) {
  const std::string name = lower_case(stem);
  const auto tl = find_angle(name, "tl"), pl = find_angle(name, "pl"), tv = find_angle(name, "tv"),
             pv = find_angle(name, "pv");
  if (!tl || !pl || !tv || !pv) return std::nullopt;
  const size_t first = std::min({tl->at, pl->at, tv->at, pv->at});
  return NamedAngles{
      {tl->degrees, pl->degrees}, {tv->degrees, pv->degrees}, trailing_number(std::string_view(name).substr(0, first))};
}

std::string name_of_angles(const NamedAngles& a) {
  const std::string index = a.index ? padded(*a.index, 5) + " " : "";
  return index + "tl" + angle_text(a.light.theta) + " pl" + angle_text(a.light.phi) + " tv" + angle_text(a.view.theta) +
         " pv" + angle_text(a.view.phi);
}

std::vector<PairPicture> find_named_pictures(const std::string& folder) {
  std::vector<NamedPicture> named = list_pictures(folder);
  std::ranges::sort(named, {}, [](const NamedPicture& p) { return std::tuple(key_of(p.angles), p.path); });
  refuse_twins(named);
  refuse_gaps(folder, named);
  if (all_have_indices(named)) std::ranges::sort(named, {}, [](const NamedPicture& p) { return p.angles.index; });
  std::vector<PairPicture> pictures;
  for (const NamedPicture& p : named) {
    const uint64_t number = pictures.size();
    pictures.push_back({p.path, p.angles.view, p.angles.light, number, number});
  }
  return pictures;
}

}  // namespace velour
