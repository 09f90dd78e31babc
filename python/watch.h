// A call of the library seen from Python: the interpreter is free while it runs, Ctrl-C ends it, progress is a
// callable or the package's own bar.
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "servodx/watch.h"

namespace servodx::python {

inline std::atomic<bool>& in_forked_child() {
  static std::atomic<bool> forked = false;
  return forked;
}

// Threads do not survive a fork: a team of several would wait for ever.
inline int threads_here(int asked) {
  if (in_forked_child() && asked > 1)
    throw std::runtime_error(
        "this process was forked from one that had used servodx and has one thread: start it by "
        "multiprocessing.get_context('spawn'), or give threads=1");
  return asked;
}

class Call {
 public:
  // `progress`: True for the bar where a person looks, None or False for none, or called as progress(work, part,
  // simulations). What it raises ends the call.
  explicit Call(pybind11::object progress) : progress_(std::move(progress)) {
    if (progress_.is(pybind11::bool_(true)))
      progress_ = pybind11::module_::import("servodx.progress").attr("default_bar")();
    if (progress_.is(pybind11::bool_(false))) progress_ = pybind11::none();
  }

  Watch watch() {
    Watch out;
    out.stop = [this] { return stopped_ || interrupted(); };
    if (!progress_.is_none()) out.progress = [this](const WorkDone& done) { tell(done); };
    return out;
  }

  // Runs `work` without the interpreter's lock; raises afterwards what Ctrl-C or the callable has raised.
  template <class Work>
  auto run(const Work& work) {
    auto result = freely(work);
    if (raised_) throw pybind11::error_already_set(std::move(*raised_));
    return result;
  }

  // The same of work that ends with its best so far: that goes with the exception, as its attribute `best`.
  template <class Work>
  auto run_for_best(const Work& work) {
    auto result = freely(work);
    if (!raised_) return result;
    raised_->value().attr("best") = std::move(result);
    throw pybind11::error_already_set(std::move(*raised_));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds pause{50};  // quick to a hand, and no cost to a fit

  template <class Work>
  auto freely(const Work& work) {
    auto result = [&] {
      pybind11::gil_scoped_release free;
      return work(watch());
    }();
    if (!raised_ && pybind11::hasattr(progress_, "close")) progress_.attr("close")();
    return result;
  }

  // Signals come to the interpreter's main thread alone; other threads find nothing.
  bool interrupted() {
    if (std::this_thread::get_id() != caller_ || Clock::now() < look_at_) return false;
    look_at_ = Clock::now() + pause;
    const pybind11::gil_scoped_acquire held;
    if (PyErr_CheckSignals() == 0) return false;
    keep(pybind11::error_already_set());
    return true;
  }

  void tell(const WorkDone& done) {
    const std::unique_lock lock(telling_, std::try_to_lock);
    if (!lock || stopped_ || Clock::now() < tell_at_) return;
    tell_at_ = Clock::now() + pause;
    const pybind11::gil_scoped_acquire held;
    try {
      progress_(std::string(done.work), done.part, done.simulations);
    } catch (pybind11::error_already_set& raised) {
      keep(std::move(raised));
    }
  }

  void keep(pybind11::error_already_set raised) {
    if (!stopped_) raised_.emplace(std::move(raised));
    stopped_ = true;
  }

  pybind11::object progress_;
  std::atomic<bool> stopped_ = false;
  std::optional<pybind11::error_already_set> raised_;
  std::mutex telling_;
  const std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point look_at_ = Clock::now(), tell_at_ = Clock::now();
};

}  // namespace servodx::python
