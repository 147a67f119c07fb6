#include "plot/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace velour {
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
