#include "capi/guard.h"

#include <new>

namespace velour::capi {

namespace {

thread_local std::string last_error;

vlr_status remember(Status status, const char* sentence) noexcept {
  try {
    last_error = sentence;
  } catch (...) {
    last_error.clear();  // no memory for the sentence: only the status is returned
  }
  return static_cast<vlr_status>(status);
}

}  // namespace

vlr_status status_of_current_exception() {
  try {
    throw;
  } catch (const Error& error) {
    return remember(error.status(), error.what());
  } catch (const std::bad_alloc&) {
    return remember(Status::out_of_memory, "Out of memory.");
  } catch (const std::exception& error) {
    return remember(Status::unknown, error.what());
  } catch (...) {
    return remember(Status::unknown, "Internal error: an exception of unknown type.");
  }
}

void require(const void* pointer, const char* argument) {
  if (!pointer) throw Error(Status::invalid_argument, std::string(argument) + " is NULL.");
}

void require_choice(int32_t value, int32_t last, const char* field) {
  if (value >= 0 && value <= last) return;
  throw Error(Status::invalid_argument,
              std::string(field) + " is " + std::to_string(value) + "; it must be 0 to " + std::to_string(last) + ".");
}

}  // namespace velour::capi

const char* vlr_last_error() { return velour::capi::last_error.c_str(); }
