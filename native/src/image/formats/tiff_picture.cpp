// Reads TIFF files with libtiff.
#include <Imath/half.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/file.h"
#include "image/open_picture.h"

namespace velour {
namespace {

constexpr uint64_t kMaxLibraryBytes = uint64_t{1} << 30;  // maximum size of an allocation by libtiff
constexpr int kMaxPages = 4096;

/// Memory stream for libtiff.
struct Source {
  std::span<const uint8_t> bytes;
  uint64_t position = 0;

  static Source& of(thandle_t handle) { return *static_cast<Source*>(handle); }
  static tmsize_t read(thandle_t handle, void* to, tmsize_t size) {
    Source& self = of(handle);
    const uint64_t rest = self.bytes.size() - std::min<uint64_t>(self.position, self.bytes.size());
    const uint64_t count = std::min(rest, static_cast<uint64_t>(std::max<tmsize_t>(size, 0)));
    if (count > 0) std::memcpy(to, self.bytes.data() + self.position, count);
    self.position += count;
    return static_cast<tmsize_t>(count);
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
  static toff_t seek(thandle_t handle, toff_t to, int from) {
    Source& self = of(handle);
    const uint64_t base = from == SEEK_SET ? 0 : from == SEEK_CUR ? self.position : self.bytes.size();
    return self.position = base + to;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t handle) { return of(handle).bytes.size(); }
};

/// Keeps libtiff's first error message about a file.
struct Complaint {
  std::string text;
  static int keep(TIFF*, void* user, const char* /*module*/, const char* format, va_list arguments) {
    auto& self = *static_cast<Complaint*>(user);
    char sentence[256];
    std::vsnprintf(sentence, sizeof sentence, format, arguments);
    if (self.text.empty()) self.text = sentence;
    return 1;
  }
  static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }
};

struct Closer {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

/// Tags that say how pixels are stored.
struct Storage {
  uint32_t width = 0, height = 0;
  uint16_t samples = 1, bits = 1, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK;
  uint16_t compression = COMPRESSION_NONE;
  bool is_planar = false;  // one plane per sample
  bool is_cmyk = false, is_palette = false;
  bool is_luv = false;   // libtiff decodes it to floats: CIE X, Y, Z or Y
  bool by_rgba = false;  // libtiff converts it to 8-bit RGB
  uint16_t colors = 1;   // samples of a pixel before further ones such as alpha
  size_t planes() const { return is_planar ? samples : 1; }
  /// Samples per pixel of a plane.
  size_t samples_together() const { return is_planar ? 1 : samples; }
};

template <typename T>
T tag(TIFF* tiff, uint32_t name, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, name, &value) == 1 ? value : otherwise;
}

Storage storage_of(TIFF* tiff) {
  Storage s;
  s.width = tag<uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  s.height = tag<uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  s.samples = tag<uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  s.bits = tag<uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  s.format = tag<uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  s.compression = tag<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  s.photometric = tag<uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, s.samples == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
  s.is_palette = s.photometric == PHOTOMETRIC_PALETTE;
  s.is_planar = tag<uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE &&
                s.samples > 1 && !s.is_palette;
  s.is_cmyk = s.photometric == PHOTOMETRIC_SEPARATED && s.samples >= 4 &&
              tag<uint16_t>(tiff, TIFFTAG_INKSET, INKSET_CMYK) == INKSET_CMYK;
  const uint16_t rare[] = {PHOTOMETRIC_YCBCR, PHOTOMETRIC_CIELAB, PHOTOMETRIC_ICCLAB, PHOTOMETRIC_ITULAB};
  s.by_rgba = std::ranges::count(rare, s.photometric) > 0 || s.compression == COMPRESSION_OJPEG;
  s.is_luv = s.photometric == PHOTOMETRIC_LOGL || s.photometric == PHOTOMETRIC_LOGLUV;
  if (s.is_luv && TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT) == 1) {
    s.bits = 32;
    s.format = SAMPLEFORMAT_IEEEFP;
  }
  s.colors = s.is_cmyk ? 4 : s.photometric == PHOTOMETRIC_RGB || s.photometric == PHOTOMETRIC_LOGLUV ? 3 : 1;
  return s;
}

/// Maximum number of bytes of pixels per byte of the file. Zstandard and LZMA could have more, with which a few bytes
/// would be gigabytes.
uint64_t expansion_of(const Storage& s) {
  const bool is_fax = s.compression == COMPRESSION_CCITTFAX3 || s.compression == COMPRESSION_CCITTFAX4;
  if (is_fax && s.samples == 1 && s.bits == 1) return 1 << 16;  // a bit repeats a row: eight of at most 65536 pixels
  if (s.compression == COMPRESSION_LZW) return 2560;            // a code of 12 bits: a string as long as the table
  return s.compression == COMPRESSION_NONE ? 1 : kMaxExpansion;
}

/// Sample with the alpha of a pixel; -1: none. Unless the file says otherwise, the first after the colors.
int alpha_of(TIFF* tiff, const Storage& s) {
  if (s.is_palette || s.samples <= s.colors) return -1;
  uint16_t count = 0;
  const uint16_t* extra = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &extra) != 1 || extra == nullptr || count == 0) {
    return s.is_cmyk ? -1 : s.colors;
  }
  for (int i = 0; i < count && s.colors + i < s.samples; ++i) {
    if (extra[i] == EXTRASAMPLE_ASSOCALPHA || extra[i] == EXTRASAMPLE_UNASSALPHA) return s.colors + i;
  }
  return -1;
}

/// Decodes the samples of a row of one plane. Integers become fractions of the largest; those of unusual bit depths are
/// first scaled to 8, 16 or 32 bits.
class Samples {
 public:
  explicit Samples(const Storage& storage) : bits_(storage.bits), format_(storage.format) {}

  bool is_float() const { return format_ == SAMPLEFORMAT_IEEEFP; }
  bool are_known() const {
    if (is_float()) return bits_ == 16 || bits_ == 32 || bits_ == 64;
    if (format_ == SAMPLEFORMAT_INT) return bits_ == 8 || bits_ == 16 || bits_ == 32;
    return (format_ == SAMPLEFORMAT_UINT || format_ == SAMPLEFORMAT_VOID) && bits_ >= 1 && bits_ <= 32;
  }

  float value(const uint8_t* row, size_t i) const {
    if (is_float()) return floating(row, i);
    if (format_ == SAMPLEFORMAT_INT) return signed_share(row, i);
    const uint64_t highest = largest();
    const auto code = static_cast<double>(stored(row, i) * highest / ((uint64_t{1} << bits_) - 1));
    return static_cast<float>(code / static_cast<double>(highest));
  }

  /// An unsigned integer as stored.
  uint64_t stored(const uint8_t* row, size_t i) const {
    if (bits_ == 8) return row[i];
    if (bits_ == 16) return number<uint16_t>(row, i);
    if (bits_ == 32) return number<uint32_t>(row, i);
    if (bits_ == 24) {  // libtiff swaps files of the other byte order, as it does for 16 and 32 bits
      const uint8_t* byte = row + 3 * i;
      return byte[0] | uint64_t{byte[1]} << 8 | uint64_t{byte[2]} << 16;
    }
    uint64_t code = 0;
    for (size_t bit = i * bits_, end = bit + bits_; bit < end; ++bit) {
      code = code << 1 | (row[bit / 8] >> (7 - bit % 8) & 1u);
    }
    return code;
  }

  /// Largest integer after scaling to 8, 16 or 32 bits.
  uint64_t largest() const { return bits_ <= 8 ? 0xff : bits_ <= 16 ? 0xffff : 0xffffffff; }

 private:
  template <typename T>
  static T number(const uint8_t* row, size_t i) {
    T value;
    std::memcpy(&value, row + i * sizeof(T), sizeof(T));
    return value;
  }
  float floating(const uint8_t* row, size_t i) const {
    if (bits_ == 16) {
      half narrow;
      narrow.setBits(number<uint16_t>(row, i));
      return narrow;
    }
    return bits_ == 32 ? number<float>(row, i) : static_cast<float>(number<double>(row, i));
  }
  float signed_share(const uint8_t* row, size_t i) const {
    if (bits_ == 8) return static_cast<float>(number<int8_t>(row, i)) / 127.0f;
    if (bits_ == 16) return static_cast<float>(number<int16_t>(row, i)) / 32767.0f;
    return static_cast<float>(number<int32_t>(row, i) / 2147483647.0);
  }

  size_t bits_;
  uint16_t format_;
};

class ByLibtiff : public OpenPicture {
 public:
  explicit ByLibtiff(const std::string& path) : path_(path), bytes_(read_file(path)), source_{bytes_} {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(kMaxLibraryBytes));
    TIFFOpenOptionsSetErrorHandlerExtR(options, &Complaint::keep, &complaint_);
    TIFFOpenOptionsSetWarningHandlerExtR(options, &Complaint::ignore, nullptr);
    tiff_.reset(TIFFClientOpenExt(path.c_str(), "rm", &source_, &Source::read, &Source::write, &Source::seek,
                                  &Source::close, &Source::size, nullptr, nullptr, options));
    TIFFOpenOptionsFree(options);
    if (!tiff_) refuse();
    choose_page();
    storage_ = storage_of(tiff_.get());
    if (!storage_.by_rgba) check_storage();
    if (!storage_.by_rgba && storage_.is_palette) read_palette();
    set_header();
  }

  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string&) const override { return std::nullopt; }
  uint64_t expansion() const override { return std::max(kMaxExpansion, expansion_of(storage_)); }

  void read(std::span<float> values) override {
    complaint_.text.clear();
    if (storage_.by_rgba) {
      read_rgba(values);
    } else {
      TIFFIsTiled(tiff_.get()) != 0 ? read_tiles(values) : read_strips(values);
    }
    if (!complaint_.text.empty()) refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    throw Error(Status::bad_data,
                input_error(path_, complaint_.text.empty() ? "the file is damaged." : complaint_.text));
  }

  /// The first page that is no reduced copy of another.
  void choose_page() {
    const auto is_reduced = [&] {
      return (tag<uint32_t>(tiff_.get(), TIFFTAG_SUBFILETYPE, 0) & FILETYPE_REDUCEDIMAGE) != 0;
    };
    uint64_t chosen = 0, pages = is_reduced() ? 0 : 1;
    for (int page = 1; page < kMaxPages && TIFFReadDirectory(tiff_.get()) == 1; ++page) {
      if (is_reduced()) continue;
      if (pages++ == 0) chosen = static_cast<uint64_t>(page);
    }
    if (TIFFSetDirectory(tiff_.get(), static_cast<tdir_t>(chosen)) != 1) refuse();
    complaint_.text.clear();
    if (pages > 1) {
      header_.warnings.push_back(
          warning<WarningCode::parts_ignored>({{"file", path_}, {"part", "page 1"}, {"parts", pages}}));
    }
  }

  void check_storage() const {
    const bool is_odd_palette =
        storage_.is_palette && (storage_.samples != 1 || storage_.bits > 16 || storage_.format != SAMPLEFORMAT_UINT);
    const uint16_t known[] = {PHOTOMETRIC_MINISWHITE, PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_RGB,   PHOTOMETRIC_PALETTE,
                              PHOTOMETRIC_MASK,       PHOTOMETRIC_LOGL,       PHOTOMETRIC_LOGLUV};
    if (std::ranges::count(known, storage_.photometric) == 0 && !storage_.is_cmyk) {
      throw Error(Status::unsupported, path_ + ": TIFF files with photometric interpretation " +
                                           std::to_string(storage_.photometric) +
                                           " (raw, depth or inks other than CMYK) are not supported. Convert the "
                                           "image to EXR or PNG.");
    }
    const bool are_odd_inks = storage_.is_cmyk && storage_.is_planar, is_short = storage_.samples < storage_.colors;
    if (Samples(storage_).are_known() && !is_odd_palette && !are_odd_inks && !is_short) return;
    throw Error(Status::unsupported, path_ + ": TIFF files with " + std::to_string(storage_.samples) + " samples of " +
                                         std::to_string(storage_.bits) + " bits in sample format " +
                                         std::to_string(storage_.format) +
                                         " are not supported. Convert the image to EXR or PNG.");
  }

  void set_header() {
    constexpr uint32_t kMost = std::numeric_limits<int>::max();
    header_.width = static_cast<int>(std::min(storage_.width, kMost));
    header_.height = static_cast<int>(std::min(storage_.height, kMost));
    if (storage_.by_rgba) {
      header_.channels = std::min<int>(storage_.samples, 4);
      if (header_.channels % 2 == 0) header_.alpha_channel = header_.channels - 1;
    } else {
      header_.channels = storage_.is_palette ? 3 : std::min<int>(storage_.colors, 3);
      alpha_ = alpha_of(tiff_.get(), storage_);
      if (alpha_ >= 0) header_.alpha_channel = header_.channels++;
      note_extra_samples();
    }
    header_.integers = storage_.by_rgba || !Samples(storage_).is_float();
    const auto orientation = tag<uint16_t>(tiff_.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (orientation >= 1 && orientation <= 8) header_.orientation = static_cast<Orientation>(orientation);
    uint32_t bytes = 0;
    uint8_t* profile = nullptr;
    if (header_.integers && TIFFGetField(tiff_.get(), TIFFTAG_ICCPROFILE, &bytes, &profile) == 1) {
      header_.note_color_space(path_, other_color_space({profile, bytes}));
    }
  }

  void note_extra_samples() {
    std::vector<std::string> ignored;
    for (int i = storage_.colors; i < storage_.samples; ++i) {
      if (i != alpha_) ignored.push_back("sample " + std::to_string(i + 1));
    }
    if (ignored.empty()) return;
    header_.warnings.push_back(
        warning<WarningCode::channels_ignored>({{"file", path_}, {"layer", ""}, {"channels", ignored}}));
  }

  /// For a strip or a tile. Refuses large ones that the file's bytes cannot fill: pixels may have many more samples
  /// than are read.
  std::vector<uint8_t> buffer(uint64_t bytes) const {
    constexpr uint64_t kSmall = uint64_t{64} << 20;
    if (bytes > std::max(expansion_of(storage_) * bytes_.size(), kSmall)) {
      throw Error(Status::bad_data,
                  input_error(path_, "a strip or tile has " + std::to_string(bytes) +
                                         " bytes, more than the file can contain. Save it with DEFLATE or in smaller "
                                         "strips; otherwise the file is damaged."));
    }
    return std::vector<uint8_t>(bytes);
  }

  void read_rgba(std::span<float> values) {
    std::vector<uint32_t> pixels(size_t{storage_.width} * storage_.height);
    // If the file's own orientation is requested, libtiff leaves the rows in stored order.
    const int as_stored = static_cast<int>(header_.orientation);
    if (TIFFReadRGBAImageOriented(tiff_.get(), storage_.width, storage_.height, pixels.data(), as_stored, 1) == 0) {
      refuse();
    }
    const auto channels = static_cast<size_t>(header_.channels);
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(pixels[i / channels] >> (8 * (i % channels)) & 0xffu) / 255.0f;
    }
  }

  void read_strips(std::span<float> values) {
    const uint32_t rows = std::min(tag<uint32_t>(tiff_.get(), TIFFTAG_ROWSPERSTRIP, storage_.height), storage_.height);
    const auto row_bytes = static_cast<size_t>(TIFFScanlineSize64(tiff_.get()));
    if (rows == 0 || row_bytes == 0) refuse();
    std::vector<uint8_t> strip = buffer(uint64_t{row_bytes} * rows);
    for (size_t plane = 0; plane < storage_.planes(); ++plane) {
      for (uint32_t y = 0; y < storage_.height; y += rows) {
        const uint32_t count = std::min(rows, storage_.height - y);
        const uint32_t number = TIFFComputeStrip(tiff_.get(), y, static_cast<uint16_t>(plane));
        const auto bytes = static_cast<tmsize_t>(row_bytes * count);
        if (TIFFReadEncodedStrip(tiff_.get(), number, strip.data(), bytes) != bytes) refuse();
        for (uint32_t row = 0; row < count; ++row) {
          keep_row(strip.data() + row * row_bytes, storage_.width, plane, size_t{y + row} * storage_.width, values);
        }
      }
    }
  }

  void read_tiles(std::span<float> values) {
    const auto width = tag<uint32_t>(tiff_.get(), TIFFTAG_TILEWIDTH, 0);
    const auto height = tag<uint32_t>(tiff_.get(), TIFFTAG_TILELENGTH, 0);
    const auto row_bytes = static_cast<size_t>(TIFFTileRowSize64(tiff_.get()));
    const uint64_t tile_bytes = TIFFTileSize64(tiff_.get());
    if (width == 0 || height == 0 || tile_bytes == 0) refuse();
    std::vector<uint8_t> tile = buffer(tile_bytes);
    for (size_t plane = 0; plane < storage_.planes(); ++plane) {
      for (uint32_t y = 0; y < storage_.height; y += height) {
        for (uint32_t x = 0; x < storage_.width; x += width) {
          const auto bytes = static_cast<tmsize_t>(tile_bytes);
          if (TIFFReadTile(tiff_.get(), tile.data(), x, y, 0, static_cast<uint16_t>(plane)) != bytes) refuse();
          for (uint32_t row = 0; row < std::min(height, storage_.height - y); ++row) {
            keep_row(tile.data() + row * row_bytes, std::min(width, storage_.width - x), plane,
                     size_t{y + row} * storage_.width + x, values);
          }
        }
      }
    }
  }

  /// Decodes `count` pixels of a plane into the picture, from pixel `first` on.
  void keep_row(const uint8_t* row, uint32_t count, size_t plane, size_t first, std::span<float> values) const {
    const Samples samples(storage_);
    const auto channels = static_cast<size_t>(header_.channels);
    const size_t together = storage_.samples_together();
    for (size_t i = 0; i < count; ++i) {
      float* to = values.data() + (first + i) * channels;
      if (storage_.is_palette) {
        for (size_t c = 0; c < 3; ++c) to[c] = palette(c, samples.stored(row, i));
        continue;
      }
      for (size_t s = plane; s < plane + together; ++s) {
        const bool is_alpha = static_cast<int>(s) == alpha_;
        if (!is_alpha && (storage_.is_cmyk || s >= storage_.colors)) continue;
        const float value = samples.value(row, i * together + s - plane);
        const bool is_dark = storage_.photometric == PHOTOMETRIC_MINISWHITE && header_.integers && !is_alpha;
        to[is_alpha ? static_cast<size_t>(header_.alpha_channel) : s] = is_dark ? 1.0f - value : value;
      }
      if (storage_.is_cmyk) add_ink(samples, row, i * together, to);
      if (storage_.photometric == PHOTOMETRIC_LOGLUV) to_rgb(to);
    }
  }

  /// CIE X, Y, Z to Rec. 709, both with a white of equal energies, as libtiff converts them.
  static void to_rgb(float* color) {
    const float x = color[0], y = color[1], z = color[2];
    color[0] = 2.690f * x - 1.276f * y - 0.414f * z;
    color[1] = -1.022f * x + 1.978f * y + 0.044f * z;
    color[2] = 0.061f * x - 0.224f * y + 1.163f * z;
  }

  void read_palette() {
    uint16_t* maps[3] = {};
    if (TIFFGetField(tiff_.get(), TIFFTAG_COLORMAP, &maps[0], &maps[1], &maps[2]) != 1) refuse();
    uint16_t largest = 0;
    for (size_t c = 0; c < 3; ++c) {
      palette_[c].assign(maps[c], maps[c] + (size_t{1} << storage_.bits));
      largest = std::max(largest, std::ranges::max(palette_[c]));
    }
    if (largest > 255) return;
    for (std::vector<uint16_t>& colors : palette_) {  // some programs write bytes
      for (uint16_t& color : colors) color = static_cast<uint16_t>(257 * color);
    }
  }

  float palette(size_t channel, uint64_t code) const {
    return static_cast<float>(palette_[channel][code] / 257) / 255.0f;
  }

  /// Converts CMYK to RGB: each ink absorbs in proportion to its coverage. `first`: sample of the pixel's cyan.
  static void add_ink(const Samples& samples, const uint8_t* row, size_t first, float* to) {
    const float paper = 1.0f - samples.value(row, first + 3);
    const auto highest = static_cast<float>(samples.largest());
    for (size_t c = 0; c < 3; ++c) {
      const float share = (1.0f - samples.value(row, first + c)) * paper;
      to[c] = samples.is_float() ? share : std::floor(share * highest + 0.5f) / highest;
    }
  }

  std::string path_;
  std::vector<uint8_t> bytes_;
  Source source_;
  Complaint complaint_;
  std::unique_ptr<TIFF, Closer> tiff_;
  Storage storage_;
  int alpha_ = -1;  // sample with the alpha; -1: none
  std::array<std::vector<uint16_t>, 3> palette_;
  PictureHeader header_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_tiff(const std::string& path) { return std::make_unique<ByLibtiff>(path); }

}  // namespace velour
