// Progress and cancel of a long task. One writer side (the task, any of its threads), one reader side (a poller).
#pragma once

#include <atomic>
#include <cstdint>

#include "job/error.h"

namespace velour {

class Progress {
 public:
  /// Starts a named part of the task that covers [begin, end] of the whole, 0 <= begin <= end <= 1. `stage` must be a
  /// string literal: the poller reads the pointer from another thread.
  void stage(const char* name, double begin, double end) {
    stage_.store(name, std::memory_order_relaxed);
    begin_.store(begin, std::memory_order_relaxed);
    end_.store(end, std::memory_order_relaxed);
    advance_to(begin);
  }

  /// Fraction done of the current stage, in [0, 1]; the overall fraction never falls. Thread-safe.
  void update(double fraction) {
    const double begin = begin_.load(std::memory_order_relaxed);
    advance_to(begin + fraction * (end_.load(std::memory_order_relaxed) - begin));
  }

  /// Throws Error(cancelled) when a cancel was asked for. Call it at least every 50 ms of work.
  void check() const {
    if (cancelled()) throw Error(Status::cancelled, "Cancelled.");
  }

  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }
  double fraction() const { return fraction_.load(std::memory_order_relaxed); }
  const char* stage_name() const { return stage_.load(std::memory_order_relaxed); }

 private:
  void advance_to(double f) {
    double seen = fraction_.load(std::memory_order_relaxed);
    while (f > seen && !fraction_.compare_exchange_weak(seen, f, std::memory_order_relaxed)) {
    }
  }

  std::atomic<bool> cancelled_{false};
  std::atomic<double> fraction_{0.0}, begin_{0.0}, end_{1.0};
  std::atomic<const char*> stage_{"starting"};
};

}  // namespace velour
