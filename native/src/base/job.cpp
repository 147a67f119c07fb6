#include "base/job.h"

#include <atomic>
#include <utility>

namespace velour {

namespace {

std::atomic<int> running_jobs{0};

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

int Job::running_count() { return running_jobs.load(); }

Job::~Job() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void Job::start(const std::function<void()>& before) {
  std::unique_lock lock(mutex_);
  if (state_ == State::running) throw Error(Status::invalid_state, "The job is already running.");
  if (before) before();
  auto progress = std::make_shared<Progress>();
  std::thread finished;
  running_jobs.fetch_add(1);
  try {
    finished = std::exchange(thread_, std::thread(&Job::run, this, progress));
  } catch (const std::exception&) {
    running_jobs.fetch_sub(1);
    throw Error(Status::out_of_memory,
                "The system could not start a thread for the job. Close other programs and try again.");
  }
  // The new run cannot finish before this lock is released.
  progress_ = std::move(progress);
  state_ = State::running;
  error_ = nullptr;
  start_ = Clock::now();
  lock.unlock();
  if (finished.joinable()) finished.join();  // thread of the previous run, which has already finished
}

void Job::run(const std::shared_ptr<Progress>& progress) {
  try {
    task_(*progress);
    finish(State::done, nullptr);
  } catch (const Error& error) {
    finish(error.status() == Status::cancelled ? State::cancelled : State::failed, std::current_exception());
  } catch (...) {
    finish(State::failed, std::current_exception());
  }
}

void Job::finish(State state, std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  state_ = state;
  error_ = std::move(error);
  end_ = Clock::now();
  running_jobs.fetch_sub(1);
  ended_.notify_all();
}

void Job::cancel() {
  const std::lock_guard lock(mutex_);
  progress_->cancel();
}

Job::Snapshot Job::poll() const {
  const std::lock_guard lock(mutex_);
  Snapshot s{state_, progress_->fraction(), 0.0, -1.0, progress_->stage_name()};
  if (state_ == State::ready) return s;
  s.seconds = seconds_between(start_, state_ == State::running ? Clock::now() : end_);
  if (state_ == State::done) s.fraction = 1.0;
  if (state_ != State::running) return s;
  s.fraction = std::min(s.fraction, 0.999);
  constexpr double kEnoughToGuess = 0.02, kSecondsToGuess = 3.0;
  const bool known = s.fraction > kEnoughToGuess || (s.fraction > 0.0 && s.seconds > kSecondsToGuess);
  if (known) s.seconds_left = s.seconds * (1.0 - s.fraction) / s.fraction;
  return s;
}

bool Job::wait_for(double seconds) const {
  constexpr double kForEver = 1e9;  // the clock counts nanoseconds in 64 bits
  std::unique_lock lock(mutex_);
  const auto ended = [this] { return state_ != State::running; };
  if (seconds < 0.0 || seconds > kForEver) {
    ended_.wait(lock, ended);
    return true;
  }
  return ended_.wait_for(lock, std::chrono::duration<double>(seconds), ended);
}

void Job::rethrow() const {
  const std::lock_guard lock(mutex_);
  if (state_ == State::ready) throw Error(Status::invalid_state, "The job was never started.");
  if (state_ == State::running) throw Error(Status::invalid_state, "The job is still running.");
  if (error_) std::rethrow_exception(error_);
}

}  // namespace velour
