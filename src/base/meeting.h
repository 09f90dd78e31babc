// Runs that go side by side and need the same service: each works by itself until it asks, then waits; once all that
// live wait, the calling thread serves all their requests together. So single requests fill what serves many at once.
#pragma once
#include <algorithm>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace servodx {

// task(run, ask) for run = 0 .. runs - 1, each in a thread of its own, at most `at_a_time` of them out of waiting;
// ask(request) returns once it is served. serve(requests), in the order of the runs and never beside a task, is called
// on the calling thread. Deterministic where tasks share nothing. An exception of `serve` ends all tasks; of those of
// tasks the first, in the order of runs, is thrown when all have ended.
template <class Request>
class Meeting {
 public:
  using Ask = std::function<void(Request&)>;

  static void hold(int runs, int at_a_time, const std::function<void(int, const Ask&)>& task,
                   const std::function<void(const std::vector<Request*>&)>& serve) {
    Meeting meeting(runs, at_a_time);
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(runs));
    std::exception_ptr served;
    {
      std::vector<std::jthread> threads;
      for (int run = 0; run < runs; ++run)
        threads.emplace_back([&, run] {
          try {
            meeting.enter();
            task(run, [&meeting, run](Request& request) { meeting.ask(run, request); });
          } catch (const Broken&) {
          } catch (...) {
            errors[static_cast<std::size_t>(run)] = std::current_exception();
          }
          meeting.leave();
        });
      try {
        meeting.serve(serve);
      } catch (...) {
        served = std::current_exception();
        meeting.call_off();
      }
    }
    if (served) std::rethrow_exception(served);
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
  }

 private:
  struct Broken {};

  Meeting(int runs, int at_a_time)
      : live_(runs), places_(std::max(1, at_a_time)), requests_(static_cast<std::size_t>(runs)) {}

  void enter() {
    std::unique_lock lock(mutex_);
    take_place(lock);
  }

  void take_place(std::unique_lock<std::mutex>& lock) {
    place_.wait(lock, [&] { return places_ > 0 || broken_; });
    if (broken_) throw Broken{};
    --places_;
  }

  void ask(int run, Request& request) {
    std::unique_lock lock(mutex_);
    Request*& mine = requests_[static_cast<std::size_t>(run)];
    mine = &request;
    ++waiting_;
    give_place();
    served_.wait(lock, [&] { return !mine || broken_; });
    take_place(lock);
  }

  void leave() {
    const std::lock_guard lock(mutex_);
    --live_;
    give_place();
  }

  // To one who waits for it; who serves is woken by the last alone, not by each of a hundred.
  void give_place() {
    ++places_;
    place_.notify_one();
    if (waiting_ == live_) all_wait_.notify_one();
  }

  void serve(const std::function<void(const std::vector<Request*>&)>& serve) {
    std::unique_lock lock(mutex_);
    for (;;) {
      all_wait_.wait(lock, [&] { return waiting_ == live_; });
      if (live_ == 0) return;
      std::vector<Request*> now;
      for (Request* request : requests_)
        if (request) now.push_back(request);
      serve(now);
      std::fill(requests_.begin(), requests_.end(), nullptr);
      waiting_ = 0;
      served_.notify_all();
    }
  }

  void call_off() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
    served_.notify_all();
    place_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable place_, served_, all_wait_;
  int live_, waiting_ = 0, places_;
  bool broken_ = false;
  std::vector<Request*> requests_;  // of each run: what it waits for, or null
};

}  // namespace servodx
