#include "btf/formats/picture_index.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/text_head.h"
#include "base/text_number.h"

namespace velour {

namespace fs = std::filesystem;
namespace {

/// Maximum depth of subfolders, in case a whole disk is given by mistake.
constexpr int kMaxDepth = 3;
constexpr double kMaxAngle = 1e6;  // degrees or radians; far beyond any azimuth
constexpr size_t kMaxPictures = kMaxDirections * kMaxDirections;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Whether a comma before further digits follows a number: a decimal comma, or a separator before another number.
bool is_decimal_comma(std::string_view after_number) {
  return after_number.size() > 1 && after_number[0] == ',' && is_digit(after_number[1]);
}

struct KeyedAngle {
  size_t at;  // position of the key
  double degrees;
};

/// Degrees after `key`, which must occur exactly once as a separate word. `name` must be lower case. Empty also if the
/// number is ambiguous (is_decimal_comma).
std::optional<KeyedAngle> find_angle(std::string_view name, std::string_view key) {
  std::optional<KeyedAngle> found;
  for (size_t at = name.find(key); at != std::string_view::npos; at = name.find(key, at + 1)) {
    size_t number = at + key.size();
    if (number < name.size() && (name[number] == '_' || name[number] == ' ' || name[number] == '=')) ++number;
    const bool word = (at == 0 || !is_letter(name[at - 1])) && number < name.size() && is_digit(name[number]);
    if (!word) continue;
    if (found) return std::nullopt;
    found = {at, 0};
    const char* const name_end = name.data() + name.size();
    const auto [end, error] = std::from_chars(name.data() + number, name_end, found->degrees, std::chars_format::fixed);
    if (error != std::errc() || found->degrees > kMaxAngle || is_decimal_comma({end, name_end})) return std::nullopt;
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

[[noreturn]] void refuse_name(const fs::path& path) {
  std::string with_points = path.stem().string();
  std::ranges::replace(with_points, ',', '.');
  if (angles_of_name(with_points)) {
    throw Error(Status::bad_data, path.string() +
                                      ": the file name has a comma between digits, which may be a decimal comma or "
                                      "separate two numbers. Rename the file, as '" +
                                      with_points + path.extension().string() + "' if the angle has a fraction.");
  }
  throw Error(Status::bad_data, path.string() +
                                    ": the file name does not contain the angles, as in '00081 tl015 pl000 tv000 "
                                    "pv000.jpg'. Rename the file, or remove it from the folder.");
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
    if (!angles) refuse_name(path);
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

namespace {

constexpr uint64_t kMaxBytes = uint64_t{1} << 30;
constexpr size_t kMaxRows = kMaxDirections * kMaxDirections;
constexpr std::array kNeeded = {"file", "theta_l", "phi_l", "theta_v", "phi_v"};

using Fields = std::vector<std::string>;

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Splits at commas. Within double quotes, commas are text and two quotes stand for one.
Fields split(const std::string& line) {
  Fields fields(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) fields.back() += line[i++];
      if (!doubled) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

/// Iterates over lines, numbered from 1, that end with LF, CRLF or CR. Skips the BOM, comments and empty lines.
class Lines {
 public:
  explicit Lines(std::string text) : text_(std::move(text)) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
  }
  bool next(std::string& line) {
    while (at_ < text_.size()) {
      const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      line = text_.substr(at_, end - at_);
      at_ = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
      ++number_;
      const std::string content = trimmed(line);
      if (!content.empty() && content[0] != '#') return true;
    }
    return false;
  }
  size_t number() const { return number_; }

 private:
  std::string text_;
  size_t at_ = 0, number_ = 0;
};

class CsvIndex {
 public:
  CsvIndex(const std::string& path, std::string text) : path_(path), lines_(std::move(text)) {
    std::string line;
    if (lines_.next(line)) columns_ = split(line);
    for (const char* name : kNeeded) {
      if (column(name) == columns_.size()) {
        fail(std::string("the first line has no column '") + name +
             "'; it must contain file, theta_l, phi_l, theta_v and phi_v, separated by commas");
      }
    }
    std::set<std::string> names;
    for (const std::string& name : columns_) {
      if (!names.insert(name).second)
        fail("the first line names the column '" + name + "' more than once; remove all but one");
    }
    numbered_ = column("view") < columns_.size();
    if (numbered_ != (column("light") < columns_.size())) fail("the columns 'view' and 'light' must be given together");
  }

  std::vector<PairPicture> pictures() {
    std::vector<PairPicture> pictures;
    std::set<std::tuple<double, double, double, double>> pairs;
    for (std::string line; lines_.next(line);) {
      if (pictures.size() == kMaxRows) fail("there are more than 4096 x 4096 images");
      PairPicture p = picture(split(line), pictures.size());
      if (!pairs.emplace(p.view.theta, p.view.phi, p.light.theta, p.light.phi).second) {
        fail("an earlier line has the same angles; remove one of the two");
      }
      pictures.push_back(std::move(p));
    }
    if (pictures.empty()) fail("the file lists no images");
    return pictures;
  }

 private:
  size_t column(const std::string& name) const {
    return static_cast<size_t>(std::ranges::find(columns_, name) - columns_.begin());
  }

  PairPicture picture(const Fields& fields, size_t row) const {
    if (fields.size() != columns_.size()) {
      fail("the line has " + std::to_string(fields.size()) + " fields, but the first line names " +
           std::to_string(columns_.size()) + " columns");
    }
    const std::string& file = fields[column("file")];
    if (file.empty()) fail("'file' is empty");
    PairPicture p{std::filesystem::path(path_).parent_path() / file,
                  {number(fields, "theta_v"), number(fields, "phi_v")},
                  {number(fields, "theta_l"), number(fields, "phi_l")},
                  row,
                  row};
    if (numbered_) {
      p.view_number = integer(fields, "view");
      p.light_number = integer(fields, "light");
    }
    return p;
  }

  double number(const Fields& fields, const char* name) const {
    const std::string& text = fields[column(name)];
    const double value = number_from(text).value_or(NAN);
    if (!(std::abs(value) <= kMaxAngle))
      fail(std::string("'") + name + "' is '" + text + "'; it must be a number from -1000000 to 1000000, such as 15.5");
    const bool signs = std::string_view(name).starts_with("phi");
    if (value < 0 && !signs) fail(std::string("'") + name + "' is negative; it must be at least 0");
    return value;
  }

  uint64_t integer(const Fields& fields, const char* name) const {
    const double value = number(fields, name);
    if (value != std::floor(value))
      fail(std::string("'") + name + "' is '" + fields[column(name)] + "'; it must be an integer");
    return static_cast<uint64_t>(value);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Status::bad_data, path_ + ": line " + std::to_string(lines_.number()) + ": " + what + ".");
  }

  std::string path_;
  Lines lines_;
  Fields columns_;
  bool numbered_ = false;
};

/// Whether all angles are below a full turn in radians and not all are integers: nobody measures within six degrees.
bool look_like_radians(const std::vector<PairPicture>& pictures) {
  constexpr double kTurn = 6.3;
  bool any = false;
  for (const PairPicture& p : pictures) {
    for (const double angle : {p.view.theta, p.view.phi, p.light.theta, p.light.phi}) {
      if (!(std::abs(angle) < kTurn)) return false;
      any = any || angle != std::round(angle);
    }
  }
  return any;
}

std::string text_of(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

std::vector<PairPicture> read_csv_index(const std::string& path, BtfAngles angles) {
  std::vector<PairPicture> pictures = CsvIndex(path, text_of(read_file(path, kMaxBytes))).pictures();
  if (angles == BtfAngles::automatic && look_like_radians(pictures)) {
    throw Error(
        Status::bad_data,
        path + ": all angles are below 6.3, so they may be in radians. Give --angles degrees or --angles radians.");
  }
  if (angles == BtfAngles::radians) {
    for (PairPicture& p : pictures)
      for (double* angle : {&p.view.theta, &p.view.phi, &p.light.theta, &p.light.phi}) *angle *= 180 / kPiD;
  }
  return pictures;
}

bool is_csv_index(const std::string& path) {
  constexpr size_t kLongestLine = 1 << 16;
  const std::string head = read_text_head(path, kLongestLine, Comments::hash_lines);
  const Fields columns = split(head.substr(0, head.find('\n')));
  return std::ranges::all_of(kNeeded, [&](const char* name) { return std::ranges::count(columns, name) > 0; });
}

}  // namespace velour
