#include "base/call_filter.h"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory>

namespace servodx {
namespace {

#if defined(__x86_64__) || defined(__aarch64__)
#define SERVODX_ANSWERS_OPEN 1
#endif

#ifdef SERVODX_ANSWERS_OPEN

// One a child; a handler of signals sees nothing else.
struct OneFile {
  std::string name;
  int descriptor = -1;
} the_file;

struct OpenCall {
  const char* name = nullptr;
  long long* result = nullptr;
};

OpenCall open_call(int call, ucontext_t& state) {
#ifdef __x86_64__
  auto& registers = state.uc_mcontext.gregs;
  const bool at = call == SYS_openat;
  return {reinterpret_cast<const char*>(registers[at ? REG_RSI : REG_RDI]), &registers[REG_RAX]};
#else
  (void)call;
  auto& registers = state.uc_mcontext.regs;
  return {reinterpret_cast<const char*>(registers[1]), reinterpret_cast<long long*>(&registers[0])};
#endif
}

// Stands in for the calls that open a file.
void answer_open(int, siginfo_t* info, void* state) {
  const OpenCall call = open_call(info->si_syscall, *static_cast<ucontext_t*>(state));
  if (the_file.descriptor < 0 || the_file.name != call.name) {
    *call.result = -EACCES;
    return;
  }
  // Descriptors of one opening share their place in the file: each opening begins at its head.
  ::lseek(the_file.descriptor, 0, SEEK_SET);
  const int copy = ::fcntl(the_file.descriptor, F_DUPFD_CLOEXEC, 0);
  *call.result = copy < 0 ? -EMFILE : copy;
}

bool answer_opens(const std::string& file) {
  the_file.name = file;
  if (!file.empty()) the_file.descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct sigaction answer {};
  answer.sa_sigaction = answer_open;
  answer.sa_flags = SA_SIGINFO;
  return ::sigaction(SIGSYS, &answer, nullptr) == 0;
}

#endif

using Context = std::unique_ptr<void, decltype(&seccomp_release)>;

class Rules {
 public:
  // A forbidden call's SIGSYS is the system's own, which no handler takes.
  Rules() : filter_(seccomp_init(SCMP_ACT_KILL_PROCESS), &seccomp_release), good_(filter_ != nullptr) {}

  template <class... Conditions>
  void rule(std::uint32_t action, int call, Conditions... conditions) {
    // A call that this processor's system does not have needs no rule.
    if (call >= 0)
      good_ = good_ && seccomp_rule_add(filter_.get(), action, call, sizeof...(conditions), conditions...) == 0;
  }
  bool load() { return good_ && seccomp_load(filter_.get()) == 0; }

 private:
  Context filter_;
  bool good_;
};

// The argument at `place` (from 0) of a call. The library's own macros leave a field out.
scmp_arg_cmp is(unsigned place, std::uint64_t value) { return {place, SCMP_CMP_EQ, value, 0}; }
scmp_arg_cmp is_not(unsigned place, std::uint64_t value) { return {place, SCMP_CMP_NE, value, 0}; }
scmp_arg_cmp lacks(unsigned place, std::uint64_t bits) { return {place, SCMP_CMP_MASKED_EQ, bits, 0}; }

void allow_memory(Rules& rules) {
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)}) rules.rule(SCMP_ACT_ALLOW, call, lacks(2, PROT_EXEC));
  for (const int call : {SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise)})
    rules.rule(SCMP_ACT_ALLOW, call);
}

void allow_files(Rules& rules, int give) {
  for (const int call : {SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(preadv), SCMP_SYS(lseek),
                         SCMP_SYS(_llseek), SCMP_SYS(close), SCMP_SYS(fstat), SCMP_SYS(newfstatat), SCMP_SYS(stat),
                         SCMP_SYS(lstat), SCMP_SYS(statx), SCMP_SYS(flock), SCMP_SYS(getcwd)})
    rules.rule(SCMP_ACT_ALLOW, call);
  // The two streams lead nowhere.
  for (const int to : {give, STDOUT_FILENO, STDERR_FILENO})
    rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(write), is(0, static_cast<unsigned>(to)));
  for (const int what : {F_GETFL, F_GETFD, F_SETFD, F_DUPFD_CLOEXEC})
    rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(fcntl), is(1, static_cast<unsigned>(what)));
#ifdef SERVODX_ANSWERS_OPEN
  for (const int call : {SCMP_SYS(open), SCMP_SYS(openat)}) rules.rule(SCMP_ACT_TRAP, call);
#else
  rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(open), lacks(1, O_ACCMODE | O_CREAT | O_TRUNC));
  rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(openat), lacks(2, O_ACCMODE | O_CREAT | O_TRUNC));
#endif
  // Asked by the way; a no is as good an answer.
  for (const int call : {SCMP_SYS(access), SCMP_SYS(faccessat), SCMP_SYS(faccessat2), SCMP_SYS(readlink),
                         SCMP_SYS(readlinkat), SCMP_SYS(ioctl), SCMP_SYS(statfs), SCMP_SYS(fstatfs)})
    rules.rule(SCMP_ACT_ERRNO(EACCES), call);
}

void allow_rest(Rules& rules) {
  for (const int call : {SCMP_SYS(exit),
                         SCMP_SYS(exit_group),
                         SCMP_SYS(futex),
                         SCMP_SYS(rt_sigprocmask),
                         SCMP_SYS(rt_sigreturn),
                         SCMP_SYS(sigaltstack),
                         SCMP_SYS(clock_gettime),
                         SCMP_SYS(clock_gettime64),
                         SCMP_SYS(gettimeofday),
                         SCMP_SYS(time),
                         SCMP_SYS(getrandom),
                         SCMP_SYS(sysinfo),
                         SCMP_SYS(uname),
                         SCMP_SYS(getpid),
                         SCMP_SYS(gettid),
                         SCMP_SYS(getuid),
                         SCMP_SYS(geteuid),
                         SCMP_SYS(sched_yield),
                         SCMP_SYS(sched_getaffinity),
                         SCMP_SYS(rseq)})
    rules.rule(SCMP_ACT_ALLOW, call);
  // abort(): a crash is to be told as one.
  rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(tgkill), is(0, static_cast<unsigned>(::getpid())));
  rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(rt_sigaction), is_not(0, SIGSYS));
  rules.rule(SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), is(2, 0));
}

}  // namespace

bool filter_calls(int give, const std::string& file) {
#ifdef SERVODX_ANSWERS_OPEN
  if (!answer_opens(file)) return false;
#else
  (void)file;
#endif
  Rules rules;
  allow_memory(rules);
  allow_files(rules, give);
  allow_rest(rules);
  return rules.load();
}

}  // namespace servodx
