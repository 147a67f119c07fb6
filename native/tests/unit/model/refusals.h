// Model files that are changed, and what is said to them.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/error.h"
#include "image/tensors/exr_tensors.h"
#include "model/file/model_file.h"

namespace velour::test {

inline Model after_a_round_trip(const Model& model) { return decode_model(encode_model(model), "test.velour"); }

using FileChange = std::function<void(TensorFile&)>;

/// The sentence that refuses the file of `model`, named metal.velour, after `change`; "" where it is accepted.
inline std::string refusal_of(const Model& model, const FileChange& change) {
  TensorFile file = decode_tensors(encode_model(model), "example");
  change(file);
  try {
    decode_model(encode_tensors(file), "metal.velour");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// As floats, so that values reach the file that no half float holds.
inline FileChange set_value(const std::string& part, size_t i, float value) {
  return [=](TensorFile& file) {
    file.tensors.at(part).precision = Precision::floats;
    file.tensors.at(part).data.at(i) = value;
  };
}

/// That the sentence names the file and the field.
inline void expect_named(const std::string& refusal, const std::string& field) {
  EXPECT_EQ(refusal.find("metal.velour"), 0u) << refusal;
  EXPECT_NE(refusal.find(field), std::string::npos) << refusal << " should name " << field;
}

}  // namespace velour::test
