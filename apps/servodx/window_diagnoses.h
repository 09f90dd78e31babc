// Windows of a watched log that are due for a diagnosis: made one at a time, beside the watch.
#pragma once
#include <deque>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "servodx/diagnose.h"
#include "servodx/log.h"

namespace servodx {

// What a watch that goes on from a saved state makes a window of again.
struct DueWindow {
  long of = 0;                // number of the window's event
  double begins = 0, at = 0;  // [s]
};

class WindowDiagnoses {
 public:
  // Called on another thread. Nothing: it was stopped, and the window is still due.
  using Judge = std::function<std::optional<Verdict>(const Log& window)>;
  explicit WindowDiagnoses(Judge judge) : judge_(std::move(judge)) {}
  struct Done {
    DueWindow due;
    std::optional<Verdict> verdict = {};
    std::string refused = {};  // why there is no verdict; empty without one: it was stopped
  };
  WindowDiagnoses(const WindowDiagnoses&) = delete;  // the running one holds it
  WindowDiagnoses& operator=(const WindowDiagnoses&) = delete;
  void add(const DueWindow& due, Log window);
  void drop_waiting() { waiting_.clear(); }
  std::vector<DueWindow> due() const;
  std::optional<Done> next_if_ready();
  std::optional<Done> wait_for_next();  // nothing: none is due

 private:
  struct Job {
    DueWindow due;
    Log window;
  };
  bool begin_one();
  Done judge_one(const Job& job) const;

  Judge judge_;
  std::deque<Job> waiting_;
  DueWindow running_due_;
  std::future<Done> running_;
};

}  // namespace servodx
