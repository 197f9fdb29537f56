// A sanitised build has no guard: the sanitisers put their own functions there.
#ifndef TROCAR_SANITIZED
#include <atomic>
#include <chrono>
#include <thread>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

namespace trocar::render {
namespace {

TEST(DriverGuard, StandsBeforeTheCLibraryForEveryLibrary) {
  Dl_info found{};
  ASSERT_NE(dladdr(dlsym(RTLD_DEFAULT, "pthread_mutex_destroy"), &found), 0);
  Dl_info self{};
  static const int here = 0;
  ASSERT_NE(dladdr(&here, &self), 0);
  EXPECT_EQ(found.dli_fbase, self.dli_fbase) << "libraries get it from " << found.dli_fname;
}

TEST(DriverGuard, DestroyingAMutexWaitsForWhoIsAboutToLeaveIt) {
  pthread_mutex_t mutex;
  ASSERT_EQ(pthread_mutex_init(&mutex, nullptr), 0);
  std::atomic<bool> held = false, left = false;
  std::thread holder([&] {
    pthread_mutex_lock(&mutex);
    held = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    left = true;
    pthread_mutex_unlock(&mutex);
  });
  while (!held) std::this_thread::yield();
  EXPECT_EQ(pthread_mutex_destroy(&mutex), 0);
  EXPECT_TRUE(left);
  holder.join();
}

}  // namespace
}  // namespace trocar::render

#endif
