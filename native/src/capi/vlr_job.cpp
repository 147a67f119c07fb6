#include "base/job.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/process.h"
#include "capi/guard.h"
#include "capi/handles.h"

using namespace velour;
using namespace velour::capi;

namespace {

using Clock = std::chrono::steady_clock;

/// Waits in short turns and calls the callback after each; returns false on a timeout.
bool wait_with_callback(vlr_job& handle, double timeout, vlr_progress_fn progress, void* user) {
  constexpr double kTurn = 0.1;  // seconds: ten calls a second
  const auto start = Clock::now();
  for (;;) {
    const double used = std::chrono::duration<double>(Clock::now() - start).count();
    if (timeout >= 0.0 && used >= timeout) return handle.job.wait_for(0.0);
    const double turn = timeout < 0.0 ? kTurn : std::min(kTurn, timeout - used);
    const bool ended = handle.job.wait_for(turn);
    const Job::Snapshot s = handle.job.poll();
    if (progress(user, s.fraction, s.stage) == 0) handle.job.cancel();
    if (ended) return true;
  }
}

}  // namespace

vlr_status vlr_job_start(vlr_job* job) {
  return guard([&] {
    require(job, "job");
    job->job.start([job] { job->output->prepare(); });
  });
}

vlr_status vlr_job_poll(const vlr_job* job, vlr_job_state* state) {
  return guard([&] {
    require(job, "job");
    require(state, "state");
    if (state->struct_size != sizeof(vlr_job_state)) {
      throw Error(Status::version_mismatch, "vlr_job_state.struct_size is " + std::to_string(state->struct_size) +
                                                ", but this library expects " + std::to_string(sizeof(vlr_job_state)) +
                                                ".");
    }
    const Job::Snapshot s = job->job.poll();
    state->state = static_cast<int32_t>(s.state);
    state->fraction = s.fraction;
    state->seconds = s.seconds;
    state->seconds_left = s.seconds_left;
    state->bytes_in_use = resident_bytes();
    state->stage = s.stage;
  });
}

vlr_status vlr_job_cancel(vlr_job* job) {
  return guard([&] {
    require(job, "job");
    job->job.cancel();
  });
}

vlr_status vlr_job_wait(vlr_job* job, double timeout_seconds, vlr_progress_fn progress, void* user, int32_t* finished) {
  return guard([&] {
    require(job, "job");
    if (std::isnan(timeout_seconds)) throw Error(Status::invalid_argument, "timeout_seconds is NaN.");
    const bool ended =
        progress ? wait_with_callback(*job, timeout_seconds, progress, user) : job->job.wait_for(timeout_seconds);
    if (finished) *finished = ended ? 1 : 0;
    if (ended) job->job.rethrow();
  });
}

vlr_status vlr_job_report_json(vlr_job* job, const char** json) {
  return guard([&] {
    require(job, "job");
    require(json, "json");
    job->job.rethrow();
    const std::lock_guard lock(job->output->mutex);
    job->report = job->output->report;
    *json = job->report.c_str();
  });
}

vlr_status vlr_job_result_model(const vlr_job* job, vlr_model** out) {
  return guard([&] {
    require(job, "job");
    require(out, "out");
    job->job.rethrow();
    const std::lock_guard lock(job->output->mutex);
    if (!job->output->model) throw Error(Status::invalid_state, "This job does not produce a model.");
    *out = new vlr_model{job->output->model, {}, {}, {}};
  });
}

void vlr_job_free(vlr_job* job) { delete job; }
