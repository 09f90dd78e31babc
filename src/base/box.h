// Work on bytes that nobody vouches for, in a child process: a crash, a loop without end or an allocation without bound
// ends the child and not the program, and so does a call of the system that reading has no need of.
//
// The child is a fork: it sees all that the program has read. Memory and processor time are limited, not wall time, so
// that a busy machine changes nothing; it reads one file and writes to the pipe. Its calls of the system are filtered
// (call_filter.h) where the system lets a program filter them; where it does not, the other limits hold alone.
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace servodx {

struct BoxLimits {
  std::size_t memory = 0;     // [byte] beyond what the program has
  unsigned long seconds = 0;  // of processor
  std::string file = {};      // the one that it may open; none if empty
};

enum class BoxEnd { whole, crashed, out_of_memory, out_of_time, forbidden_call };

class Box {
 public:
  // Hands bytes to the parent, in order.
  using Give = std::function<void(std::string_view)>;

  // `prepare` runs in the child before it is limited: what it loads must be as trusted as the program.
  Box(
      const BoxLimits& limits, const std::function<void(const Give&)>& work,
      const std::function<void()>& prepare = [] {});
  ~Box();  // ends the child
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  // The next bytes of the child, whole; false: it gave no more than a part of them.
  bool take(void* to, std::size_t size);
  BoxEnd end();  // after the last take(): how the child ended
  bool filters_calls() const { return filters_calls_; }

 private:
  pid_t child_ = -1;
  int pipe_ = -1;
  bool filters_calls_ = false;
};

}  // namespace servodx
