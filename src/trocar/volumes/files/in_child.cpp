#include <trocar/volumes/files/in_child.hpp>

#if defined(__unix__) && !defined(__EMSCRIPTEN__)

#include <cerrno>
#include <csignal>
#include <ctime>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace trocar::volumes {
namespace {

bool write_all(int to, const char* from, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::write(to, from, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done;
    size -= std::size_t(done);
  }
  return true;
}

/// The child's life: quiet, without core files and the program's own handlers of crashes.
[[noreturn]] void live(const std::function<std::string()>& work, int to, int seconds) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, SIG_DFL);
  const rlimit none{0, 0}, time{rlim_t(seconds), rlim_t(seconds)};
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_CPU, &time);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  bool told = false;
  try {
    const std::string out = work();
    // The last byte says that all of it is there.
    told = write_all(to, out.data(), out.size()) && write_all(to, "!", 1);
  } catch (...) {
    told = false;
  }
  ::_exit(told ? 0 : 1);
}

double now_seconds() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Up to the end of what the child writes; false where it took too long or wrote too much.
bool read_all(int from, double until, std::size_t most, std::string& out) {
  char part[65536];
  while (true) {
    const double left = until - now_seconds();
    if (left <= 0 || out.size() > most) return false;
    pollfd wait{from, POLLIN, 0};
    const int ready = ::poll(&wait, 1, int(1000 * left) + 1);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    const ssize_t got = ::read(from, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) return true;
    out.append(part, std::size_t(got));
  }
}

}  // namespace

ChildResult in_child(const std::function<std::string()>& work, int seconds, std::size_t most) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
#ifdef F_SETPIPE_SZ
  ::fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);  // a slice at once, instead of taking turns for each 64 KiB
#endif
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    live(work, ends[1], seconds);
  }
  ::close(ends[1]);
  ChildResult out;
  if (child > 0) {
    const bool whole = read_all(ends[0], now_seconds() + seconds, most + 1, out.bytes);
    if (!whole) ::kill(child, SIGKILL);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    out.came_back =
        whole && !out.bytes.empty() && out.bytes.back() == '!' && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (out.came_back) out.bytes.pop_back();
  }
  ::close(ends[0]);
  return out;
}

}  // namespace trocar::volumes

#else

namespace trocar::volumes {
ChildResult in_child(const std::function<std::string()>& work, int, std::size_t) { return {true, work()}; }
}  // namespace trocar::volumes

#endif
