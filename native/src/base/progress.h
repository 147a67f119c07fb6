// Progress and cancellation of a long task. One writer (the task, from any of its threads), one reader (a poller).
#pragma once

#include <atomic>
#include <cstdint>

#include "base/error.h"

namespace velour {

class Progress {
 public:
  /// During its lifetime, stages are relative to [begin, end] of the enclosing span or of the whole task, so that code
  /// written as a whole task can run as a part of another.
  class Span {
   public:
    Span(Progress& progress, double begin, double end)
        : progress_(progress), first_(progress.first_), extent_(progress.extent_) {
      progress.first_ = first_ + extent_ * begin;
      progress.extent_ = extent_ * (end - begin);
    }
    ~Span() {
      progress_.first_ = first_;
      progress_.extent_ = extent_;
    }
    Span(const Span&) = delete;
    Span& operator=(const Span&) = delete;

   private:
    Progress& progress_;
    const double first_, extent_;
  };

  /// Starts a stage that covers [begin, end] of the innermost Span, or of the whole task; 0 <= begin <= end <= 1.
  /// `name` must be a string literal: the poller reads the pointer from another thread.
  void stage(const char* name, double begin, double end) {
    stage_.store(name, std::memory_order_relaxed);
    begin_.store(first_ + extent_ * begin, std::memory_order_relaxed);
    end_.store(first_ + extent_ * end, std::memory_order_relaxed);
    advance_to(first_ + extent_ * begin);
  }

  /// Sets the completed fraction of the current stage, in [0, 1]; the overall fraction never decreases. Thread-safe.
  void update(double fraction) {
    const double begin = begin_.load(std::memory_order_relaxed);
    advance_to(begin + fraction * (end_.load(std::memory_order_relaxed) - begin));
  }

  /// Throws Error(cancelled) if cancellation was requested. Call it at least every 50 ms of work.
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

  double first_ = 0, extent_ = 1;  // innermost span; only the task's own thread uses them
  std::atomic<bool> cancelled_{false};
  std::atomic<double> fraction_{0.0}, begin_{0.0}, end_{1.0};
  std::atomic<const char*> stage_{"starting"};
};

}  // namespace velour
