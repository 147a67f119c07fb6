#include "btf/formats/csv_index.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <tuple>

#include "base/error.h"
#include "base/file.h"

namespace velour {
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

/// Iterates over lines, numbered from 1. Skips comments and empty lines; strips the BOM and carriage returns.
class Lines {
 public:
  explicit Lines(std::string text) : text_(std::move(text)) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
  }
  bool next(std::string& line) {
    while (at_ < text_.size()) {
      const size_t end = std::min(text_.find('\n', at_), text_.size());
      line = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++number_;
      if (line.ends_with('\r')) line.pop_back();
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
    for (const std::string& name : columns_) {
      if (std::ranges::count(columns_, name) > 1)
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
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = failure == std::errc() && end == text.data() + text.size();
    if (!whole || !(value >= -1e6 && value <= 1e6))
      fail(std::string("'") + name + "' is '" + text + "'; it must be a number");
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
  Lines lines(text_of(read_file_head(path, size_t{1} << 16)));
  std::string line;
  if (!lines.next(line)) return false;
  const Fields columns = split(line);
  return std::ranges::all_of(kNeeded, [&](const char* name) { return std::ranges::count(columns, name) > 0; });
}

}  // namespace velour
