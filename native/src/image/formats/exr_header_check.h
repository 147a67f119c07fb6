// Checks the headers of an OpenEXR file by any program before OpenEXR sees them: OpenEXR allocates memory for all rows,
// chunks and attributes that they claim before their number can be queried. Internal to image/.
#pragma once

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include "base/error.h"

namespace velour {

/// Throws Error(bad_data) for claims that exceed the file, and for attributes whose sizes or contents do not match
/// their types. A header that ends early is left to OpenEXR, which reports it.
void check_exr_header(const std::string& path);

/// Size in bytes of an attribute of this type; empty if it varies.
std::optional<uint32_t> fixed_exr_bytes(std::string_view type);

// Translates OpenEXR's exceptions.

/// Calls `work()` and rethrows OpenEXR's exceptions as Error(status, sentence(what())).
template <class Work, class Sentence>
auto with_exr_errors(Status status, const Sentence& sentence, const Work& work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(status, sentence(error.what()));
  }
}

}  // namespace velour
