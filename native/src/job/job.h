// A task on a thread of its own, with a state that any thread may ask for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "job/progress.h"

namespace velour {

class Job {
 public:
  enum class State { ready = 0, running = 1, done = 2, failed = 3, cancelled = 4 };

  struct Snapshot {
    State state;
    double fraction;      // never falls within a run; 1 only when done
    double seconds;       // since the start; stops with the task
    double seconds_left;  // negative while unknown
    const char* stage;    // a literal
  };

  /// `task` runs on the job's thread; it throws Error(cancelled) through Progress::check().
  explicit Job(std::function<void(Progress&)> task) : task_(std::move(task)) {}
  /// Cancels and waits.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Throws Error(invalid_state) while running. A finished job runs anew from nothing. `before` is called once it is
  /// certain that no run is under way, ahead of the new one, which what it throws prevents; it calls nothing of the
  /// job.
  void start(const std::function<void()>& before = {});
  void cancel();
  Snapshot poll() const;

  /// True when the task has ended within `seconds` (negative, or more than 1e9: waits for ever).
  bool wait_for(double seconds) const;
  /// Rethrows what a failed or cancelled task ended with; Error(invalid_state) when it never ran or still runs.
  void rethrow() const;

  /// Jobs of the whole process whose task runs now.
  static int running_count();

 private:
  using Clock = std::chrono::steady_clock;
  void run(const std::shared_ptr<Progress>& progress);
  void finish(State state, std::exception_ptr error);

  const std::function<void(Progress&)> task_;
  mutable std::mutex mutex_;
  mutable std::condition_variable ended_;
  std::thread thread_;
  std::shared_ptr<Progress> progress_ = std::make_shared<Progress>();
  State state_ = State::ready;
  std::exception_ptr error_;
  Clock::time_point start_{}, end_{};
};

}  // namespace velour
