#include <cerrno>
#include <chrono>

#include <dlfcn.h>
#include <pthread.h>
#include <sched.h>

#include <trocar/render/gl/gl_driver_guard.hpp>

namespace trocar::render {

void link_driver_guard() noexcept {}

namespace {

// Who leaves needs microseconds of processor time, and a busy machine may not give it any for a while. A mutex that
// stays locked is somebody's mistake, and theirs to make.
constexpr std::chrono::seconds kPatience{1};

[[maybe_unused]] void wait_until_left(pthread_mutex_t* mutex) noexcept {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    const int taken = pthread_mutex_trylock(mutex);
    if (taken == 0) pthread_mutex_unlock(mutex);
    if (taken != EBUSY || std::chrono::steady_clock::now() > end) return;
    sched_yield();
  }
}

}  // namespace
}  // namespace trocar::render

// The sanitisers put their own functions there.
#ifndef TROCAR_SANITIZED
extern "C" __attribute__((visibility("default"))) int pthread_mutex_destroy(pthread_mutex_t* mutex) noexcept {
  static const auto next = reinterpret_cast<int (*)(pthread_mutex_t*)>(dlsym(RTLD_NEXT, "pthread_mutex_destroy"));
  trocar::render::wait_until_left(mutex);
  return next ? next(mutex) : 0;
}
#endif
