#pragma once
// Jobs run beside the interpreter: its lock is released, progress is shown, and Ctrl-C ends the job.

#include <pybind11/pybind11.h>
#include <tbb/global_control.h>

#include <functional>
#include <future>
#include <memory>

#include "coast/jobs/job.hpp"

namespace coast::python {

/// What a job reports, kept until the interpreter's thread takes it.
class Relay {
 public:
  Relay();
  ~Relay();
  /// For the job. Throws in the job's thread once the job was cancelled.
  [[nodiscard]] jobs::Progress progress();
  /// In the interpreter's thread, with its lock: passes on what came since the last time, and looks for Ctrl-C.
  /// @param listener  an object with stage(what, fraction), say(line), warn(line)
  /// @throws py::error_already_set  Ctrl-C, or an exception of the listener; the job is cancelled
  void pass_on(const pybind11::object& listener);
  void cancel();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Waits for `done` with the lock released, tells the listener ten times a second.
void attend(Relay& relay, const pybind11::object& listener, const std::function<bool(std::chrono::milliseconds)>& done);

/// @param job  of Progress; returns its result
/// @param threads  0: all
template <class Job>
auto in_background(const pybind11::object& listener, int threads, Job job) {
  Relay relay;
  auto result = std::async(std::launch::async, [&job, threads, progress = relay.progress()] {
    std::unique_ptr<tbb::global_control> limit;
    if (threads > 0)
      limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(threads));
    return job(progress);
  });
  attend(relay, listener,
         [&result](std::chrono::milliseconds time) { return result.wait_for(time) == std::future_status::ready; });
  return result.get();
}

}  // namespace coast::python
