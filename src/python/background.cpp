#include "background.hpp"

#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace coast::python {

namespace py = pybind11;

namespace {

/// Unwinds a job that nobody waits for any more.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("the job was cancelled") {}
};

struct Line {
  bool warning;
  std::string text;
};

}  // namespace

struct Relay::State {
  std::atomic<bool> cancelled = false;
  std::mutex mutex;
  std::string stage;
  double fraction = 0.0;
  bool changed = false;
  std::vector<Line> lines;
};

Relay::Relay() : state_(std::make_shared<State>()) {}
Relay::~Relay() = default;

void Relay::cancel() {
  state_->cancelled = true;
}

jobs::Progress Relay::progress() {
  const auto add = [state = state_](bool warning) {
    return [state, warning](const std::string& text) {
      const std::scoped_lock lock(state->mutex);
      state->lines.push_back({warning, text});
    };
  };
  jobs::Progress progress;
  progress.stage = [state = state_](const char* what, double fraction) {
    if (state->cancelled) throw Cancelled();
    const std::scoped_lock lock(state->mutex);
    state->stage = what;
    state->fraction = fraction;
    state->changed = true;
  };
  progress.say = add(false);
  progress.warn = add(true);
  return progress;
}

void Relay::pass_on(const py::object& listener) {
  std::vector<Line> lines;
  std::pair<std::string, double> stage;
  bool changed = false;
  {
    const std::scoped_lock lock(state_->mutex);
    lines.swap(state_->lines);
    stage = {state_->stage, state_->fraction};
    changed = std::exchange(state_->changed, false);
  }
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  for (const Line& line : lines) listener.attr(line.warning ? "warn" : "say")(line.text);
  if (changed) listener.attr("stage")(stage.first, stage.second);
}

void attend(Relay& relay, const py::object& listener, const std::function<bool(std::chrono::milliseconds)>& done) {
  constexpr std::chrono::milliseconds kLook{100};
  const py::gil_scoped_release released;
  while (!done(kLook)) {
    const py::gil_scoped_acquire acquired;
    try {
      relay.pass_on(listener);
    } catch (...) {
      relay.cancel();  // the job ends at its next stage; its future waits for it
      throw;
    }
  }
  const py::gil_scoped_acquire acquired;
  relay.pass_on(listener);
}

}  // namespace coast::python
