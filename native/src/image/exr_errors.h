// Translates OpenEXR's exceptions.
#pragma once

#include <exception>
#include <new>

#include "job/error.h"

namespace velour {

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
