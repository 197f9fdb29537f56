#include <pthread.h>
#include <sys/prctl.h>

#include <trocar/devices/real_time.hpp>

namespace trocar::devices {
namespace {

constexpr int kPriority = 40;           // of 1..99: below what the system itself needs
constexpr unsigned long kSlack = 1000;  // [ns] by which sleeping threads may be woken late; the usual 50 us is too much

}  // namespace

bool raise_priority() noexcept {
  prctl(PR_SET_TIMERSLACK, kSlack, 0, 0, 0);
  sched_param wanted{};
  wanted.sched_priority = kPriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
}

}  // namespace trocar::devices
