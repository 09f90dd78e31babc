#include "window_diagnoses.h"

#include <chrono>
#include <cstddef>
#include <exception>
#include <utility>

#include "base/trouble.h"
#include "servodx/error.h"

namespace servodx {
namespace {

constexpr std::size_t most_pending = 4;  // windows that wait: the oldest gives way

}  // namespace

void WindowDiagnoses::add(const DueWindow& due, Log window) {
  if (waiting_.size() >= most_pending) waiting_.pop_front();
  waiting_.push_back({due, std::move(window)});
}

std::vector<DueWindow> WindowDiagnoses::due() const {
  std::vector<DueWindow> out;
  if (running_.valid()) out.push_back(running_due_);
  for (const Job& job : waiting_) out.push_back(job.due);
  return out;
}

std::optional<WindowDiagnoses::Done> WindowDiagnoses::next_if_ready() {
  if (!begin_one() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
  return running_.get();
}

std::optional<WindowDiagnoses::Done> WindowDiagnoses::wait_for_next() {
  if (!begin_one()) return {};
  return running_.get();
}

// False where none is due.
bool WindowDiagnoses::begin_one() {
  if (running_.valid()) return true;
  if (waiting_.empty()) return false;
  running_due_ = waiting_.front().due;
  running_ = std::async(std::launch::async, [this, job = std::move(waiting_.front())] { return judge_one(job); });
  waiting_.pop_front();
  return true;
}

WindowDiagnoses::Done WindowDiagnoses::judge_one(const Job& job) const {
  Done out{job.due};
  try {
    out.verdict = judge_(job.window);
  } catch (const InputError& error) {
    out.refused = told(error);
  } catch (const std::exception& error) {
    out.refused = error.what();
  }
  return out;
}

}  // namespace servodx
