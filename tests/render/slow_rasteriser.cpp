// Preloaded: every thread of Mesa's software rasteriser sleeps 0.2 ms before it tells that it is done, while it holds
// the fence's lock. Without gl_driver_guard.hpp nearly every program that draws dies of that.
#include <cstring>
#include <ctime>

#include <dlfcn.h>
#include <pthread.h>

extern "C" __attribute__((visibility("default"))) int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  static const auto next = reinterpret_cast<int (*)(pthread_cond_t*)>(dlsym(RTLD_NEXT, "pthread_cond_broadcast"));
  char name[16] = "";
  pthread_getname_np(pthread_self(), name, sizeof name);
  if (std::strncmp(name, "llvmpipe", 8) == 0) {
    const timespec delay{0, 200'000};
    nanosleep(&delay, nullptr);
  }
  return next(condition);
}
