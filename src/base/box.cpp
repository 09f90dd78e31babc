#include "base/box.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <new>
#include <stdexcept>

#include "base/call_filter.h"

namespace servodx {
namespace {

enum ChildExit { gave_all = 0, no_memory = 3, threw = 4 };

void limit(int resource, rlim_t most) {
  struct rlimit now {};
  ::getrlimit(static_cast<__rlimit_resource_t>(resource), &now);
  if (now.rlim_max != RLIM_INFINITY && now.rlim_max <= most) return;
  now.rlim_cur = most;
  // A second of processor between the two: the soft limit's signal says what ended the child.
  now.rlim_max = resource == RLIMIT_CPU ? most + 1 : most;
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &now);
}

// What the process has mapped; a limit below it would refuse every allocation.
std::size_t mapped() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// `fd` is all that is left of the parent's open files.
void leave_the_parent(int fd) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Sanitizers take a signal for a report; here it is an end like any other.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE, SIGINT, SIGTERM})
    std::signal(signal, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  const auto own = static_cast<unsigned>(fd);
  if (own > STDERR_FILENO + 1) ::close_range(STDERR_FILENO + 1, own - 1, 0);
  ::close_range(own + 1, ~0U, 0);
}

// Whether calls of the system are filtered; the rest holds everywhere.
bool confine(const BoxLimits& limits, int fd) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  if (const std::size_t there = mapped()) limit(RLIMIT_AS, there + limits.memory);
  return filter_calls(fd, limits.file);
}

void write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) ::_exit(threw);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

// _exit: neither the parent's buffers nor its destructors are the child's to run.
[[noreturn]] void run_child(int fd, const BoxLimits& limits, const std::function<void(const Box::Give&)>& work,
                            const std::function<void()>& prepare) {
  leave_the_parent(fd);
  try {
    prepare();
    const char filters = confine(limits, fd) ? 1 : 0;
    write_all(fd, {&filters, 1});
    work([fd](std::string_view bytes) { write_all(fd, bytes); });
  } catch (const std::bad_alloc&) {
    ::_exit(no_memory);
  } catch (...) {
    ::_exit(threw);
  }
  ::_exit(gave_all);
}

}  // namespace

Box::Box(const BoxLimits& limits, const std::function<void(const Give&)>& work, const std::function<void()>& prepare) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe can be made");
  child_ = ::fork();
  if (child_ == 0) run_child(ends[1], limits, work, prepare);
  ::close(ends[1]);
  pipe_ = ends[0];
  if (child_ <= 0) {
    ::close(pipe_);
    throw std::runtime_error("no process can be started");
  }
  char filters = 0;
  filters_calls_ = take(&filters, 1) && filters != 0;
}

Box::~Box() {
  ::close(pipe_);
  if (child_ <= 0) return;
  ::kill(child_, SIGKILL);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool Box::take(void* to, std::size_t size) {
  char* at = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t got = ::read(pipe_, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

BoxEnd Box::end() {
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == gave_all) return BoxEnd::whole;
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_memory) return BoxEnd::out_of_memory;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return BoxEnd::out_of_time;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return BoxEnd::out_of_memory;  // the kernel was short of it
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS) return BoxEnd::forbidden_call;
  return BoxEnd::crashed;
}

}  // namespace servodx
