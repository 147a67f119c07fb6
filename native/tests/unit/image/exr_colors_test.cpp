// The choice of an OpenEXR file's channels, by their names.
#include "image/formats/exr_picture.h"

#include <gtest/gtest.h>
#include <algorithm>

#include "base/error.h"
#include "support/inputs.h"

namespace velour::exr_colors_test {
namespace {

using Kind = ExrColors::Kind;
using Names = std::vector<std::string>;

struct Case {
  Names channels;
  std::string layer;
  Kind kind;
  Names chosen;  // red, green, blue, or gray alone; then alpha, where there is one
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  for (const std::string& name : c.channels) out << name << ' ';
  return out << '/' << c.layer;
}

class ChosenColors : public testing::TestWithParam<Case> {};

TEST_P(ChosenColors, GoByNames) {
  const Case& c = GetParam();
  const ExrColors found = choose_exr_colors(c.channels, c.layer, "a.exr");
  Names chosen(found.names.begin(), c.kind == Kind::gray ? found.names.begin() + 1 : found.names.end());
  if (!found.alpha.empty()) chosen.push_back(found.alpha);
  EXPECT_EQ(found.kind, c.kind);
  EXPECT_EQ(chosen, c.chosen);
  const size_t read =
      static_cast<size_t>(std::ranges::count_if(chosen, [](const auto& name) { return !name.empty(); }));
  EXPECT_EQ(found.left_out.size(), c.channels.size() - read);
}

const Names kBlender{"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G", "ViewLayer.Combined.R",
                     "ViewLayer.Depth.Z",    "ViewLayer.DiffCol.B",  "ViewLayer.DiffCol.G",  "ViewLayer.DiffCol.R",
                     "ViewLayer.Normal.X",   "ViewLayer.Normal.Y",   "ViewLayer.Normal.Z"};
const Names kSky{"sky.blue", "sky.green", "sky.red"};

INSTANTIATE_TEST_SUITE_P(
    Files, ChosenColors,
    testing::Values(
        Case{{"B", "G", "R"}, "", Kind::rgb, {"R", "G", "B"}}, Case{{"b", "g", "r"}, "", Kind::rgb, {"r", "g", "b"}},
        Case{{"A", "Blue", "Green", "Red"}, "", Kind::rgb, {"Red", "Green", "Blue", "A"}},
        Case{kSky, "", Kind::rgb, {"sky.red", "sky.green", "sky.blue"}},
        Case{kSky, "Sky", Kind::rgb, {"sky.red", "sky.green", "sky.blue"}},
        Case{{"A", "AO.B", "AO.G", "AO.R", "B", "G", "R", "depth.Z"}, "", Kind::rgb, {"R", "G", "B", "A"}},
        Case{{"A", "AO.B", "AO.G", "AO.R", "B", "G", "R", "depth.Z"}, "AO", Kind::rgb, {"AO.R", "AO.G", "AO.B"}},
        Case{{"AO.R", "B", "G", "R", "depth.Z"}, "depth", Kind::gray, {"depth.Z"}},
        Case{{"AO.R", "B", "G", "R", "depth.Z"}, "Depth.z", Kind::gray, {"depth.Z"}},
        Case{{"Y"}, "", Kind::gray, {"Y"}}, Case{{"A", "Y"}, "", Kind::gray, {"Y", "A"}},
        Case{{"BY", "RY", "Y"}, "", Kind::luminance_chroma, {"RY", "Y", "BY"}},
        Case{{"X", "Y", "Z"}, "", Kind::rgb, {"X", "Y", "Z"}}, Case{{"height"}, "", Kind::gray, {"height"}},
        Case{{"G", "R"}, "", Kind::rgb, {"R", "G", ""}},
        Case{kBlender,
             "",
             Kind::rgb,
             {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A"}},
        Case{kBlender, "DiffCol", Kind::rgb, {"ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B"}},
        Case{kBlender,
             "ViewLayer.Normal",
             Kind::rgb,
             {"ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"}}));

std::string refusal(const Names& channels, const std::string& layer) {
  try {
    choose_exr_colors(channels, layer, "a.exr");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ChosenColors, RefuseWhatIsNotClear) {
  test::record_input("OpenEXR", "several layers with colors, none of them Combined, RGB or Beauty",
                     "refused; --layer chooses");
  test::record_input("OpenEXR", "channels whose names mean no color", "refused; --layer chooses");
  const std::string several = refusal({"day.B", "day.G", "day.R", "night.B", "night.G", "night.R"}, "");
  EXPECT_NE(several.find("a.exr: has several layers with colors (day, night)"), std::string::npos) << several;
  EXPECT_NE(several.find("--layer"), std::string::npos) << several;
  const std::string unknown = refusal({"foo", "bar", "baz"}, "");
  EXPECT_NE(unknown.find("foo, bar, baz"), std::string::npos) << unknown;
  EXPECT_NE(refusal({"B", "G", "R"}, "sky").find("no layer 'sky'"), std::string::npos);
  EXPECT_NE(refusal({"a.x1", "a.x2"}, "a").find("a.x1, a.x2"), std::string::npos);
}

}  // namespace
}  // namespace velour::exr_colors_test
