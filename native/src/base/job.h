// A task that runs on its own thread and whose state any thread may query.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "base/progress.h"

namespace velour {

class Job {
 public:
  enum class State { ready = 0, running = 1, done = 2, failed = 3, cancelled = 4 };

  struct Snapshot {
    State state;
    double fraction;      // never decreases during a run; 1 only when done
    double seconds;       // since the start; stops when the task ends
    double seconds_left;  // estimated; negative while unknown
    const char* stage;    // a string literal
  };

  /// `task` runs on the job's thread; Progress::check() makes it throw Error(cancelled).
  explicit Job(std::function<void(Progress&)> task) : task_(std::move(task)) {}
  /// Cancels the task and waits for it to end.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Throws Error(invalid_state) while running. A finished job restarts from the beginning. `before` is called once no
  /// run is in progress, while the job is locked, so it must not call the job; if it throws, the new run does not
  /// start.
  void start(const std::function<void()>& before = {});
  void cancel();
  Snapshot poll() const;

  /// Waits at most `seconds` (negative, or more than 1e9: forever) for the task to end. Returns whether it has ended.
  bool wait_for(double seconds) const;
  /// Rethrows the exception that ended a failed or cancelled task. Throws Error(invalid_state) if the task never ran or
  /// is still running.
  void rethrow() const;

  /// Number of jobs in the process whose task is running.
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
