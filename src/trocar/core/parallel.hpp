// A thread pool for the sections of a tick. Items are taken in their order by whichever thread is free, so the largest
// should come first; they must not write anything in common, then results never depend on timing. The calling thread
// works, too, and waits for no thread that is still asleep. Idle threads look out for the next section for about a
// tenth of a millisecond, then sleep.
// No allocation and no exception once constructed. TROCAR_THREADS bounds the number of workers.
#pragma once

#include <memory>
#include <type_traits>

namespace trocar::core {

/// Threads the pool may use: TROCAR_THREADS if set (1..64), else the cores less one (kept for drawing), at least 1.
int default_thread_count() noexcept;

class ThreadPool {
 public:
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const noexcept;

  /// Calls task(context, i) for i in [0, count), on any threads. Returns when all are done. One run at a time.
  using Task = void (*)(void* context, int index) noexcept;
  void run(int count, Task task, void* context) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// The same for a callable: run(pool, n, [&](int i) noexcept { ... }).
template <class F>
void run(ThreadPool& pool, int count, F&& body) noexcept {
  using Body = std::remove_reference_t<F>;
  pool.run(
      count, [](void* c, int i) noexcept { (*static_cast<Body*>(c))(i); }, &body);
}

}  // namespace trocar::core
