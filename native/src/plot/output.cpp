#include "plot/output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "plot/font.h"

namespace velour {

namespace {

/// Pixels [x0, x1) x [y0, y1), y down.
struct Box {
  int x0, y0, x1, y1;
};

class Raster {
 public:
  explicit Raster(const Drawing& drawing)
      : side_(drawing.side), pixels_(static_cast<size_t>(side_) * static_cast<size_t>(side_), drawing.background) {}

  void add(const Stroke& stroke) {
    if (stroke.points.empty()) return;
    // Coverage is collected first, so that pixels where segments of a stroke meet are not blended twice.
    const float reach = 0.5f * stroke.width + 0.5f;
    const Box box = box_of(stroke.points, reach);
    if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
    const auto width = static_cast<size_t>(box.x1 - box.x0);
    std::vector<float> cover(width * static_cast<size_t>(box.y1 - box.y0));
    for (size_t i = 0; i < stroke.points.size(); ++i) {
      const Vec2 a = stroke.points[i], b = stroke.points[std::min(i + 1, stroke.points.size() - 1)];
      cover_segment(a, b, reach, box, cover);
    }
    // A stroke thinner than a pixel covers no more of it than its width.
    const float most = std::min(stroke.width, 1.0f);
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const float c = cover[static_cast<size_t>(y - box.y0) * width + static_cast<size_t>(x - box.x0)];
        if (c > 0) blend(x, y, std::min(c, 1.0f) * most, stroke.color);
      }
    }
  }

  void add(const Dot& dot) { add(Stroke{{dot.center}, 2 * dot.radius, dot.color}); }

  void add(const Label& label) {
    const float start = label.baseline.x - label.align * text_width(label.text, label.size);
    const float whole = std::floor(start);
    const TextPixels text = text_pixels(label.text, label.size, start - whole);
    // A baseline on a whole row keeps stems sharp.
    const int left = static_cast<int>(whole) + text.left;
    const int top = static_cast<int>(std::lround(label.baseline.y)) + text.top;
    for (int y = 0; y < text.height; ++y) {
      for (int x = 0; x < text.width; ++x) {
        const uint8_t c = text.coverage[static_cast<size_t>(y * text.width + x)];
        const bool inside = left + x >= 0 && left + x < side_ && top + y >= 0 && top + y < side_;
        if (c > 0 && inside) blend(left + x, top + y, static_cast<float>(c) / 255, label.color);
      }
    }
  }

  std::vector<float> rgba() const {
    std::vector<float> out;
    out.reserve(4 * pixels_.size());
    for (int y = side_ - 1; y >= 0; --y) {
      for (int x = 0; x < side_; ++x) {
        const Rgb& c = pixels_[index(x, y)];
        out.insert(out.end(), {c.r, c.g, c.b, 1.0f});
      }
    }
    return out;
  }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(side_) + static_cast<size_t>(x);
  }

  void blend(int x, int y, float cover, const Rgb& color) {
    Rgb& pixel = pixels_[index(x, y)];
    pixel = glm::mix(pixel, color, cover);
  }

  Box box_of(const std::vector<Vec2>& points, float reach) const {
    Vec2 low = points.front(), high = low;
    for (const Vec2& p : points) low = glm::min(low, p), high = glm::max(high, p);
    return {first(low.x, reach), first(low.y, reach), end(high.x, reach), end(high.y, reach)};
  }
  int first(float at, float reach) const { return std::clamp(static_cast<int>(std::floor(at - reach)), 0, side_); }
  int end(float at, float reach) const { return std::clamp(static_cast<int>(std::ceil(at + reach)) + 1, 0, side_); }

  void cover_segment(const Vec2& a, const Vec2& b, float reach, const Box& all, std::vector<float>& cover) const {
    const Box box = box_of({a, b}, reach);
    const Vec2 d = b - a;
    const float length_sq = std::max(glm::dot(d, d), 1e-12f);
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const Vec2 p = Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - a;
        const float along = std::clamp(glm::dot(p, d) / length_sq, 0.0f, 1.0f);
        float& c = cover[static_cast<size_t>(y - all.y0) * static_cast<size_t>(all.x1 - all.x0) +
                         static_cast<size_t>(x - all.x0)];
        c = std::max(c, reach - glm::length(p - along * d));
      }
    }
  }

  int side_;
  std::vector<Rgb> pixels_;  // row 0 at the top
};

}  // namespace

std::vector<float> rasterized(const Drawing& drawing) {
  Raster raster(drawing);
  for (const auto& mark : drawing.marks) std::visit([&](const auto& m) { raster.add(m); }, mark);
  return raster.rgba();
}

namespace {

/// Rounds to hundredths of a pixel.
std::string number(float value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2f", static_cast<double>(value));
  std::string out = text.data();
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  if (out == "-0") out.erase(0, 1);
  return out;
}

std::string color(const Rgb& c) {
  const auto byte = [](float v) { return static_cast<unsigned>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(c.r) & 255u, byte(c.g) & 255u, byte(c.b) & 255u);
  return text.data();
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

/// An element's attributes, each with a space before it.
class Attributes {
 public:
  Attributes& add(const char* name, const std::string& value) {
    text_.append(" ").append(name).append("=\"").append(value).append("\"");
    return *this;
  }
  Attributes& add(const char* name, float value) { return add(name, number(value)); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string element(const Stroke& stroke) {
  std::string points;
  for (const Vec2& p : stroke.points) {
    if (!points.empty()) points += ' ';
    points.append(number(p.x)).append(",").append(number(p.y));
  }
  Attributes a;
  a.add("points", points).add("stroke", color(stroke.color)).add("stroke-width", stroke.width);
  return std::string("<polyline").append(a.text()).append("/>\n");
}

std::string element(const Dot& dot) {
  Attributes a;
  a.add("cx", dot.center.x).add("cy", dot.center.y).add("r", dot.radius).add("fill", color(dot.color));
  return std::string("<circle").append(a.text()).append("/>\n");
}

std::string element(const Label& label) {
  const char* anchor = label.align < 0.25f ? "start" : label.align > 0.75f ? "end" : "middle";
  Attributes a;
  a.add("x", label.baseline.x).add("y", label.baseline.y).add("font-size", label.size).add("text-anchor", anchor);
  a.add("fill", color(label.color));
  return std::string("<text").append(a.text()).append(">").append(escaped(label.text)).append("</text>\n");
}

}  // namespace

std::string svg_text(const Drawing& drawing) {
  const std::string side = std::to_string(drawing.side);
  Attributes all, background;
  all.add("xmlns", "http://www.w3.org/2000/svg").add("width", side).add("height", side);
  all.add("viewBox", std::string("0 0 ").append(side).append(" ").append(side));
  all.add("fill", "none").add("stroke-linecap", "round").add("stroke-linejoin", "round");
  all.add("font-family", "DejaVu Sans, Verdana, sans-serif");
  background.add("width", side).add("height", side).add("fill", color(drawing.background));
  std::string out = std::string("<svg").append(all.text()).append(">\n");
  out.append("<rect").append(background.text()).append("/>\n");
  for (const auto& mark : drawing.marks) out += std::visit([](const auto& m) { return element(m); }, mark);
  return out + "</svg>\n";
}

}  // namespace velour
