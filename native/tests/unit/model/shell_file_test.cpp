#include <gtest/gtest.h>

#include "example_model.h"
#include "support/example_shell.h"
#include "unit/model/refusals.h"

namespace velour::shell_file_test {
namespace {

using test::expect_named;
using test::refusal_of;
using test::set_value;

Model model_with_shell() {
  Model model = test::example_parametric();
  auto volume = test::wires(8, 0.2f);
  volume->reference = 0.125f;
  volume->tile_width = 0.25f;
  model.shell = ModelShell{volume, "wires", VotfErrors{0.5, 0.0625}};
  return model;
}

test::FileChange shell_attribute(const std::string& from, const std::string& to) {
  return [=](TensorFile& file) {
    std::string& text = file.attributes.at("velour.shell");
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    text.replace(at, from.size(), to);
  };
}

TEST(ShellFile, ComesBackAsItWas) {
  const Model model = model_with_shell();
  const Model read = decode_model(encode_model(model), "model.velour");
  ASSERT_TRUE(read.shell);
  const VotfVolume &a = *model.shell->volume, &b = *read.shell->volume;
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.bottom, b.bottom);
  EXPECT_EQ(a.top, b.top);
  EXPECT_EQ(a.reference, b.reference);
  EXPECT_EQ(a.reach, b.reach);
  EXPECT_EQ(a.tile_width, b.tile_width);
  EXPECT_EQ(a.closed, b.closed);
  EXPECT_EQ(read.shell->source, "wires");
  ASSERT_TRUE(read.shell->errors);
  EXPECT_EQ(read.shell->errors->wrong, 0.0625);
  EXPECT_EQ(encode_model(read), encode_model(model));
}

TEST(ShellFile, ASourceThatIsNotUtf8IsReplaced) {
  Model model = model_with_shell();
  model.shell->source = "m\xfcll.obj";
  EXPECT_EQ(decode_model(encode_model(model), "model.velour").shell->source, "m\xef\xbf\xbdll.obj");
}

TEST(ShellFile, AModelWithoutItIsReadAsOneWithout) {
  Model model = model_with_shell();
  model.shell.reset();
  EXPECT_FALSE(decode_model(encode_model(model), "model.velour").shell);
}

TEST(ShellFile, WhatIsWrongIsNamed) {
  const Model model = model_with_shell();
  EXPECT_EQ(refusal_of(model, [](TensorFile&) {}), "");
  expect_named(refusal_of(model, set_value("shell.distance", 3, 256)), "shell.distance[3]");
  expect_named(refusal_of(model, set_value("shell.distance", 3, -1)), "shell.distance[3]");
  expect_named(refusal_of(model, set_value("shell.distance", 3, 0.5f)), "shell.distance[3]");
  expect_named(refusal_of(model, [](TensorFile& f) { f.tensors.erase("shell.distance"); }), "shell.distance");
  expect_named(refusal_of(model,
                          [](TensorFile& f) {
                            f.tensors.at("shell.distance") = {{4}, {1, 2, 3, 4}};
                          }),
               "shell.distance");
  expect_named(refusal_of(model,
                          [](TensorFile& f) {
                            f.tensors.at("shell.distance") = {{1, 2, 2}, {1, 2, 3, 4}};
                          }),
               "along z");
  expect_named(refusal_of(model, [](TensorFile& f) { f.attributes.at("velour.shell") = "[]"; }), "velour.shell");
  expect_named(refusal_of(model, [](TensorFile& f) { f.attributes.at("velour.shell") = "{"; }), "velour.shell");
  for (const char* key : {"bottom", "top", "reference", "aspect", "reach", "closed", "tile_width", "source"}) {
    const std::string quoted = std::string(1, '"') + key + '"';
    expect_named(refusal_of(model, shell_attribute(quoted, std::string(1, '"') + "x" + '"')), key);
  }
  const std::string top = std::string(1, '"') + "top" + '"' + ":";
  expect_named(refusal_of(model, shell_attribute(top, top + "-1e3," + std::string(1, '"') + "y" + '"' + ":")), "top");
}

}  // namespace
}  // namespace velour::shell_file_test
