// The one place where exceptions become a status and a sentence.
#pragma once

#include <cstring>
#include <string>

#include "base/error.h"
#include "velour/velour.h"

namespace velour::capi {

/// Stores the sentence for this thread and returns the status of the exception being handled.
vlr_status status_of_current_exception();

/// Runs `body` and turns every exception into a status.
template <typename Body>
vlr_status guard(const Body& body) {
  try {
    body();
    return VLR_OK;
  } catch (...) {
    return status_of_current_exception();
  }
}

/// Throws Error(invalid_argument) if `pointer` is null.
void require(const void* pointer, const char* argument);

/// Throws Error(invalid_argument) unless `value` is one of the choices 0 to `last`.
void require_choice(int32_t value, int32_t last, const char* field);

/// Reads an options struct of any earlier size: fields that the caller does not know keep their defaults. `initialize`
/// is the public vlr_*_init of the struct. NULL gives the defaults. Refuses larger structs, from newer headers.
template <typename Options>
Options read_options(const Options* given, void (*initialize)(Options*), const char* name) {
  Options options;
  initialize(&options);
  if (!given) return options;
  if (given->struct_size < sizeof(uint32_t) || given->struct_size > sizeof(Options)) {
    throw Error(Status::version_mismatch,
                std::string(name) + ".struct_size is " + std::to_string(given->struct_size) +
                    ", but this library expects at most " + std::to_string(sizeof(Options)) +
                    ". Initialize the struct with its _init function, or update the library.");
  }
  std::memcpy(&options, given, given->struct_size);
  options.struct_size = sizeof(Options);
  return options;
}

/// Fills the caller's struct, of any earlier size, whose struct_size is set; `name` as in read_options().
template <typename Struct>
void write_struct(const Struct& values, Struct* out, const char* name) {
  require(out, name);
  const uint32_t size = out->struct_size;
  if (size < sizeof(uint32_t) || size > sizeof(Struct)) {
    throw Error(Status::version_mismatch, std::string(name) + ".struct_size is " + std::to_string(size) +
                                              ", but this library expects at most " + std::to_string(sizeof(Struct)) +
                                              ". Set it to the size of the struct, or update the library.");
  }
  std::memcpy(out, &values, size);
  out->struct_size = size;
}

}  // namespace velour::capi
