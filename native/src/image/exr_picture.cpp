#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

#include "file/file.h"
#include "image/exr_errors.h"
#include "image/exr_output.h"
#include "image/open_picture.h"
#include "job/error.h"

namespace velour {
namespace {

/// OpenEXR makes tables for all rows that a header claims when it opens a file, before anyone can ask how many.
void check_rows(const std::string& path) {
  constexpr size_t kMostHeader = 65536, kBegin = 8;
  const auto head = read_file_head(path, kMostHeader);
  const std::string text(head.begin(), head.end());
  for (size_t at = kBegin; at < text.size() && text[at] != 0;) {  // name, type, size, value
    const std::string name = text.c_str() + at;
    at += name.size() + 1;
    at = text.find('\0', at);
    uint32_t size = 0;
    if (at == std::string::npos || text.size() - at < 1 + sizeof size) return;
    std::memcpy(&size, text.data() + at + 1, sizeof size);
    at += 1 + sizeof size;
    if (size > std::filesystem::file_size(path) - at) throw Error(Status::bad_data, path + ": its header is damaged.");
    if (size > text.size() - at) return;
    std::array<int32_t, 4> window{};  // least x, y, most x, y
    if (name == "dataWindow" && size == sizeof window) {
      std::memcpy(window.data(), text.data() + at, sizeof window);
      const int64_t rows = int64_t{window[3]} - window[1] + 1;
      if (rows > static_cast<int64_t>(kMaxValuesPerByte * std::filesystem::file_size(path))) {
        throw Error(Status::bad_data,
                    path + ": the header says " + std::to_string(rows) + " rows, more than the file can hold.");
      }
    }
    at += size;
  }
}

/// The layer, whether the channel is no colour, its place among colours, its name: what channels are sorted by.
auto order_of(const std::string& channel) {
  constexpr std::string_view kColours = "RYGBA";
  const size_t dot = channel.rfind('.');
  const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
  const std::string last = dot == std::string::npos ? channel : channel.substr(dot + 1);
  const size_t colour = last.size() == 1 ? kColours.find(last[0]) : std::string_view::npos;
  return std::tuple(layer, colour == std::string_view::npos, colour, channel);
}

auto input_error_of(const std::string& path) {
  return [&path](const char* why) { return input_error(path, why); };
}

class OpenExr : public OpenPicture {
 public:
  explicit OpenExr(const std::string& path) : path_(path), file_(path.c_str(), 0) {
    for (auto channel = channels().begin(); channel != channels().end(); ++channel) {
      names_.emplace_back(channel.name());
      if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
        throw Error(Status::unsupported, path + ": channel " + names_.back() +
                                             " has fewer pixels than the picture; write all channels at its size.");
      }
    }
    std::ranges::sort(names_, {}, order_of);
  }

  Format format() const override {
    const Imath::Box2i& window = file_.header().dataWindow();
    const auto alpha = std::ranges::find(names_, "A");
    return {.width = window.max.x - window.min.x + 1,
            .height = window.max.y - window.min.y + 1,
            .channels = static_cast<int>(names_.size()),
            .alpha_channel = alpha == names_.end() ? -1 : static_cast<int>(alpha - names_.begin())};
  }

  std::optional<std::string> text(const std::string& name) const override {
    const auto* found = file_.header().findTypedAttribute<Imf::StringAttribute>(name);
    return found != nullptr ? std::optional(found->value()) : std::nullopt;
  }

  ExrHeader header() const {
    const Imath::Box2i &data = file_.header().dataWindow(), &whole = file_.header().displayWindow();
    const auto side = [](int first, int last) { return static_cast<int>(int64_t{last} - first + 1); };
    ExrHeader header;
    header.width = side(data.min.x, data.max.x);
    header.height = side(data.min.y, data.max.y);
    header.channels = names_;
    header.multi_part = Imf::isMultiPart(file_.version());
    header.frame = {side(whole.min.x, whole.max.x), side(whole.min.y, whole.max.y),
                    static_cast<int>(int64_t{data.min.x} - whole.min.x),
                    static_cast<int>(int64_t{whole.max.y} - data.max.y)};
    for (auto attribute = file_.header().begin(); attribute != file_.header().end(); ++attribute) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
      if (text != nullptr) header.texts[attribute.name()] = text->value();
    }
    return header;
  }

  void read(std::span<float> values) override {
    const size_t pixel = names_.size() * sizeof(float);
    const Imath::Box2i& window = file_.header().dataWindow();
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < names_.size(); ++c) {
      buffer.insert(names_[c], Imf::Slice::Make(Imf::FLOAT, values.data() + c, window, pixel,
                                                pixel * static_cast<size_t>(format().width)));
    }
    with_exr_errors(Status::bad_data, input_error_of(path_), [&] {
      file_.setFrameBuffer(buffer);
      file_.readPixels(window.min.y, window.max.y);
    });
  }

 private:
  const Imf::ChannelList& channels() const { return file_.header().channels(); }

  std::string path_;
  Imf::InputFile file_;
  std::vector<std::string> names_;
};

/// Names whose order in the alphabet is that of the channels, for that is how they are read.
std::string channel_name(int channel, int channels) {
  constexpr std::array kColours{"R", "G", "B", "A"};
  if (channels == 1) return "Y";
  if (channel < 4) return kColours[static_cast<size_t>(channel)];
  const std::string digits = std::to_string(channel);
  return "channel" + std::string(3 - std::min<size_t>(digits.size(), 3), '0') + digits;
}

/// OpenEXR counts rows from the top.
Imath::Box2i data_window(const Picture& picture, const PictureFrame& frame) {
  const int top = frame.height - frame.y - picture.height;
  return {{frame.x, top}, {frame.x + picture.width - 1, top + picture.height - 1}};
}

void add_texts(Imf::Header& header, const PictureTexts& texts) {
  for (const auto& [name, text] : texts) {
    if (name.empty() || header.find(name) != header.end()) {
      throw Error(Status::invalid_argument, "A text of a picture cannot be named '" + name + "'.");
    }
    header.insert(name, Imf::StringAttribute(text));
  }
}

}  // namespace

std::unique_ptr<OpenPicture> open_exr(const std::string& path) {
  check_rows(path);
  return with_exr_errors(Status::bad_data, input_error_of(path), [&] { return std::make_unique<OpenExr>(path); });
}

ExrHeader read_exr_header(const std::string& path) {
  check_rows(path);
  return with_exr_errors(Status::bad_data, input_error_of(path), [&] { return OpenExr(path).header(); });
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
  const auto sentence = [&](const char* why) { return path + ": OpenEXR cannot write the picture: " + why; };
  with_exr_errors(Status::io, sentence, [&] {
    ExrOutput stream(file, path);
    Imf::OutputFile output(stream, header, 0);
    output.setFrameBuffer(buffer);
    output.writePixels(top_first.height);
  });
  file.commit();
}

}  // namespace velour
