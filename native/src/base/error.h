// The only exception type that crosses folders. The C API turns it into a status and a message.
#pragma once

#include <stdexcept>
#include <string>

namespace velour {

/// Same values as vlr_status in velour.h; append only.
enum class Status : int {
  ok = 0,
  unknown = 1,
  invalid_argument = 2,
  invalid_state = 3,
  out_of_memory = 4,
  unsupported = 5,
  io = 6,
  bad_data = 7,
  cancelled = 8,
  version_mismatch = 9,
};

/// `what()` is one sentence for the user: the file, the field, the value found, and the remedy.
class Error : public std::runtime_error {
 public:
  Error(Status status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}
  Status status() const { return status_; }

 private:
  Status status_;
};

[[noreturn]] inline void refuse(const std::string& sentence) { throw Error(Status::invalid_argument, sentence); }

}  // namespace velour
