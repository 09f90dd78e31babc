// Work on bytes that nobody vouches for, in a child process: a crash, a loop without end or an allocation without bound
// ends the child and not the program.
//
// The child is a fork: it sees all that the program has read. Memory and processor time are limited, not wall time, so
// that a busy machine changes nothing; it can write to no file but the pipe. System calls are not filtered.
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string_view>

namespace servodx {

struct BoxLimits {
  std::size_t memory = 0;     // [byte] beyond what the program has
  unsigned long seconds = 0;  // of processor
};

enum class BoxEnd { whole, crashed, out_of_memory, out_of_time };

class Box {
 public:
  // Hands bytes to the parent, in order.
  using Give = std::function<void(std::string_view)>;

  Box(const BoxLimits& limits, const std::function<void(const Give&)>& work);
  ~Box();  // ends the child
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  // The next bytes of the child, whole; false: it gave no more than a part of them.
  bool take(void* to, std::size_t size);
  BoxEnd end();  // after the last take(): how the child ended

 private:
  pid_t child_ = -1;
  int pipe_ = -1;
};

}  // namespace servodx
