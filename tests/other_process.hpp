// For tests of what happens to another process: one that dies, or one without root's rights.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

namespace trocar::test {

/// Runs `body` in a child process. @return what it returns, 99 after an exception, -1 if it was killed
template <class Body>
int elsewhere(Body&& body) {
  const pid_t child = fork();
  if (child == 0) try {
      _exit(body());
    } catch (...) {
      _exit(99);
    }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Gives up root's rights, for which a read-only folder is no obstacle.
inline bool become_nobody() { return geteuid() != 0 || (setgid(65534) == 0 && setuid(65534) == 0); }

}  // namespace trocar::test
