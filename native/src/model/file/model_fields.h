// Checked access to the fields of a decoded model file; every message names the file and the field.
#pragma once

#include <map>
#include <string>

#include "image/tensors/exr_tensors.h"

namespace velour {

/// All members throw Error(bad_data) if a field is missing or not as expected.
class ModelFields {
 public:
  /// `name`: the file's name, for messages.
  ModelFields(TensorFile file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}

  const std::string& name() const { return name_; }
  [[noreturn]] void fail(const std::string& what) const;
  /// "part[i] is value; it must be `wanted`."
  [[noreturn]] void fail_at(const std::string& part, size_t i, float value, const std::string& wanted) const;

  const std::string& attribute(const std::string& key) const;
  std::string attribute_or_empty(const std::string& key) const;
  bool boolean(const std::string& key) const;
  int integer(const std::string& key, int least, int most) const;

  bool has(const std::string& part) const { return file_.tensors.contains(part); }
  /// A part of any shape.
  const Tensor& tensor(const std::string& part) const;
  /// A part of shape [n] for one column, [n, columns] for more.
  const Tensor& rows(const std::string& part, uint64_t columns) const;

 private:
  TensorFile file_;
  std::string name_;
};

/// "true" or "false", as ModelFields::boolean reads it.
std::string boolean_text(bool value);

}  // namespace velour
