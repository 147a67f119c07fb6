#include "model/file/model_fields.h"

#include <charconv>

#include "base/error.h"

namespace velour {

void ModelFields::fail(const std::string& what) const { throw Error(Status::bad_data, name_ + ": " + what); }

void ModelFields::fail_at(const std::string& part, size_t i, float value, const std::string& wanted) const {
  fail(part + "[" + std::to_string(i) + "] is " + std::to_string(value) + "; it must be " + wanted +
       ". The model file is damaged.");
}

const std::string& ModelFields::attribute(const std::string& key) const {
  const auto found = file_.attributes.find(key);
  if (found == file_.attributes.end()) fail("the attribute " + key + " is missing; this is not a Velour model.");
  return found->second;
}

std::string ModelFields::attribute_or_empty(const std::string& key) const {
  const auto found = file_.attributes.find(key);
  return found == file_.attributes.end() ? std::string() : found->second;
}

bool ModelFields::boolean(const std::string& key) const {
  const std::string& text = attribute(key);
  if (text != boolean_text(true) && text != boolean_text(false)) {
    fail(key + " is '" + text + "'; it must be true or false.");
  }
  return text == boolean_text(true);
}

int ModelFields::integer(const std::string& key, int least, int most) const {
  const std::string& text = attribute(key);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) {
    fail(key + " is '" + text + "'; it must be " + std::to_string(least) + " to " + std::to_string(most) + ".");
  }
  return value;
}

const Tensor& ModelFields::tensor(const std::string& part) const {
  const auto found = file_.tensors.find(part);
  if (found == file_.tensors.end()) fail("the part " + part + " is missing; the model file is damaged.");
  return found->second;
}

const Tensor& ModelFields::rows(const std::string& part, uint64_t columns) const {
  const Tensor& found = tensor(part);
  const auto& shape = found.shape;
  const bool fits = columns == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == columns;
  if (!fits) {
    fail("the part " + part + " must have the shape [n" + (columns == 1 ? "" : ", " + std::to_string(columns)) + "].");
  }
  return found;
}

std::string boolean_text(bool value) { return value ? "true" : "false"; }

}  // namespace velour
