// Reads JPEG files in a library without OpenImageIO.
#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include <jerror.h>

#include <csetjmp>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "image/portable/portable_picture.h"

namespace velour {
namespace {

/// State of libjpeg. Errors are long jumps, so functions that call setjmp must not hold objects with destructors.
struct Decoder {
  explicit Decoder(std::span<const uint8_t> data) : bytes(data) {
    info.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr common) {
      auto& self = *static_cast<Decoder*>(common->client_data);
      common->err->format_message(common, self.message.data());
      std::longjmp(self.failed, 1);
    };
    // libjpeg reports damage as a warning, fills in what is missing and continues.
    errors.emit_message = [](j_common_ptr common, int level) {
      auto& self = *static_cast<Decoder*>(common->client_data);
      if (level >= 0 || self.is_damaged || !means_lost_data(common->err->msg_code)) return;
      self.is_damaged = true;
      common->err->format_message(common, self.message.data());
    };
    info.client_data = this;
  }
  ~Decoder() { jpeg_destroy_decompress(&info); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  bool read_header() {
    if (setjmp(failed) != 0) return false;
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, bytes.data(), bytes.size());
    jpeg_read_header(&info, TRUE);
    if (is_cmyk()) info.out_color_space = JCS_CMYK;
    jpeg_calc_output_dimensions(&info);
    return true;
  }

  /// `rows`: height x row_values() bytes.
  bool read(uint8_t* rows) {
    if (setjmp(failed) != 0) return false;
    jpeg_start_decompress(&info);
    while (info.output_scanline < info.output_height) {
      JSAMPROW row = rows + info.output_scanline * row_values();
      jpeg_read_scanlines(&info, &row, 1);
    }
    jpeg_finish_decompress(&info);
    return !is_damaged;
  }

  bool is_cmyk() const { return info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK; }
  size_t row_values() const { return size_t{info.output_width} * static_cast<size_t>(info.out_color_components); }

  /// Other warnings are about what decoders do not need, such as parameters that only progressive files have.
  static bool means_lost_data(int warning) {
    constexpr int kLost[] = {JWRN_HIT_MARKER,    JWRN_JPEG_EOF,    JWRN_BOGUS_PROGRESSION,
                             JWRN_HUFF_BAD_CODE, JWRN_MUST_RESYNC, JWRN_ARITH_BAD_CODE};
    return std::ranges::find(kLost, warning) != std::end(kLost);
  }

  std::span<const uint8_t> bytes;
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  std::jmp_buf failed{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  bool is_damaged = false;
};

/// The stored CMYK values are the fractions of the paper that each ink leaves white.
void to_rgb(std::span<const uint8_t> cmyk, std::span<float> rgb) {
  for (size_t i = 0; i < rgb.size() / 3; ++i) {
    const float paper = static_cast<float>(cmyk[4 * i + 3]) / 255.0f;
    for (size_t c = 0; c < 3; ++c) {
      const float share = static_cast<float>(cmyk[4 * i + c]) / 255.0f * paper;
      rgb[3 * i + c] = std::floor(share * 255.0f + 0.5f) / 255.0f;
    }
  }
}

class ByLibjpeg : public OpenPicture {
 public:
  explicit ByLibjpeg(const std::string& path) : path_(path), bytes_(read_file(path)) {
    Decoder decoder(bytes_);
    if (!decoder.read_header()) throw Error(Status::bad_data, input_error(path, decoder.message.data()));
    header_.width = static_cast<int>(decoder.info.output_width);
    header_.height = static_cast<int>(decoder.info.output_height);
    header_.channels = decoder.is_cmyk() ? 3 : decoder.info.out_color_components;
    header_.integers = true;
  }

  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string&) const override { return std::nullopt; }

  void read(std::span<float> values) override {
    Decoder decoder(bytes_);
    if (!decoder.read_header()) throw Error(Status::bad_data, input_error(path_, decoder.message.data()));
    std::vector<uint8_t> rows(decoder.row_values() * size_t{decoder.info.output_height});
    if (!decoder.read(rows.data())) throw Error(Status::bad_data, input_error(path_, decoder.message.data()));
    if (decoder.is_cmyk()) return to_rgb(rows, values);
    std::ranges::transform(rows, values.begin(), [](uint8_t v) { return static_cast<float>(v) / 255.0f; });
  }

 private:
  std::string path_;
  std::vector<uint8_t> bytes_;
  PictureHeader header_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_jpeg(const std::string& path) { return std::make_unique<ByLibjpeg>(path); }

}  // namespace velour
