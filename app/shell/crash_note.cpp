#include "shell/crash_note.hpp"

#include <csignal>
#include <cstddef>
#include <cstring>

#include <execinfo.h>
#include <unistd.h>

namespace trocar::app {
namespace {

constexpr int kMostCalls = 64;
constexpr std::size_t kStack = std::size_t(64) << 10;  // [bytes] of its own: the fault may be that the stack is full

// In the handler nothing may be allocated or formatted: the heap may be what is broken.
void say(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody listens
}

void on_crash(int number) {
  say("trocar " TROCAR_VERSION " died of a fault of its own (SIG");
  say(::sigabbrev_np(number));
  say("). An attempt is recorded up to its last second. Please report this with the lines that follow:\n");
  void* calls[kMostCalls];
  ::backtrace_symbols_fd(calls, ::backtrace(calls, kMostCalls), STDERR_FILENO);
  std::raise(number);  // the handler was for once: this time the program dies of it
}

}  // namespace

void leave_a_note_when_crashing() {
#ifdef __SANITIZE_ADDRESS__
  return;  // the sanitizer tells more
#endif
  void* first[1];
  ::backtrace(first, 1);  // the first call loads a library, which the handler must not
  static std::byte stack[kStack];
  stack_t own{};
  own.ss_sp = stack;
  own.ss_size = sizeof stack;
  ::sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = int(SA_ONSTACK | SA_RESETHAND | SA_NODEFER);
  constexpr int kFaults[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
  for (const int number : kFaults) ::sigaction(number, &action, nullptr);
}

}  // namespace trocar::app
