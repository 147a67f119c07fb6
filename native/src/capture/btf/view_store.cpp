#include "capture/btf/view_store.h"

#include <chrono>
#include <thread>

namespace velour {

void ViewStore::read_by(const std::function<void()>& work) const {
  if (!pages_.in_file()) return work();
  std::jthread releases([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      release();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  work();
}

}  // namespace velour
