#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

#include <trocar/core/parallel.hpp>

namespace trocar::core {
namespace {

constexpr int kMaxThreads = 64;

// Threads look this often for what they wait for before they sleep: the stages of a tick follow each other within a
// few microseconds, a sleep and a wake-up cost about ten each. Not longer, because the awaited thread may need this
// core.
constexpr int kSpins = 2000;

}  // namespace

int default_thread_count() noexcept {
  if (const char* text = std::getenv("TROCAR_THREADS")) {
    char* end = nullptr;
    const long wanted = std::strtol(text, &end, 10);
    if (end != text && *end == '\0' && wanted >= 1 && wanted <= kMaxThreads) return static_cast<int>(wanted);
  }
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(cores - 1, 1, kMaxThreads);
}

struct ThreadPool::Impl {
  // What the workers run; written by run() before it raises `generation`, read by them after they saw it raised.
  Task task = nullptr;
  void* context = nullptr;
  int count = 0;

  int threads = 1;
  std::atomic<std::uint32_t> generation{0};
  std::atomic<int> busy{0};
  std::atomic<bool> stop{false};
  std::vector<std::thread> workers;  // slots 1 .. threads-1; slot 0 is the thread that calls run()

  void run_slot(int slot) noexcept {
    for (int i = slot; i < count; i += threads) task(context, i);
  }

  void work(int slot) noexcept {
    std::uint32_t seen = 0;
    for (;;) {
      for (int spin = 0; spin < kSpins && generation.load(std::memory_order_acquire) == seen; ++spin) continue;
      generation.wait(seen, std::memory_order_acquire);
      seen = generation.load(std::memory_order_acquire);
      if (stop.load(std::memory_order_acquire)) return;
      run_slot(slot);
      if (busy.fetch_sub(1, std::memory_order_acq_rel) == 1) busy.notify_one();
    }
  }

  void raise_generation() noexcept {
    generation.fetch_add(1, std::memory_order_acq_rel);
    generation.notify_all();
  }

  void wait_for_workers() noexcept {
    for (int spin = 0; spin < kSpins; ++spin)
      if (busy.load(std::memory_order_acquire) == 0) return;
    for (int left = busy.load(std::memory_order_acquire); left != 0; left = busy.load(std::memory_order_acquire))
      busy.wait(left, std::memory_order_acquire);
  }

  void join() noexcept {
    stop.store(true, std::memory_order_release);
    raise_generation();
    for (std::thread& worker : workers) worker.join();
  }
};

ThreadPool::ThreadPool(int threads) : m_impl(std::make_unique<Impl>()) {
  m_impl->threads = std::clamp(threads, 1, kMaxThreads);
  m_impl->workers.reserve(m_impl->threads - 1);
  try {
    for (int slot = 1; slot < m_impl->threads; ++slot)
      m_impl->workers.emplace_back([impl = m_impl.get(), slot] { impl->work(slot); });
  } catch (...) {
    m_impl->join();
    throw;
  }
}

ThreadPool::~ThreadPool() { m_impl->join(); }

int ThreadPool::threads() const noexcept { return m_impl->threads; }

void ThreadPool::run(int count, Task task, void* context) noexcept {
  if (count <= 0) return;
  if (m_impl->threads == 1 || count == 1) {
    for (int i = 0; i < count; ++i) task(context, i);
    return;
  }
  m_impl->task = task;
  m_impl->context = context;
  m_impl->count = count;
  m_impl->busy.store(m_impl->threads - 1, std::memory_order_release);
  m_impl->raise_generation();
  m_impl->run_slot(0);
  m_impl->wait_for_workers();
}

}  // namespace trocar::core
