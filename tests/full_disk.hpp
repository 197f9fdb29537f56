// For tests of what is written where there is no room left.
#pragma once

#include <csignal>

#include <sys/resource.h>

namespace trocar::test {

/// As long as it lives no file of this process grows beyond so many bytes: what has been written until then is there,
/// and the next write fails, as on a disk that is full. The log of the tests is a file, too: nothing may be said
/// meanwhile.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : m_handler(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &m_before);
    const rlimit small{bytes, m_before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &m_before);
    std::signal(SIGXFSZ, m_handler);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*m_handler)(int);
  rlimit m_before{};
};

}  // namespace trocar::test
