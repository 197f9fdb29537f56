#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

#include <trocar/core/parallel.hpp>

namespace trocar::core {
namespace {

constexpr int kMaxThreads = 64;

// Threads look this often for what they wait for before they sleep: about a tenth of a millisecond, with which the
// stages of a tick that run on one thread are bridged; between ticks they sleep. To be woken takes some 40 us.
constexpr int kSpins = 8000;

/// Informs the processor that this thread is only looking.
inline void pause() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

/// One run of the pool and how far it has come, in one word, so that a thread that comes late can never take an item
/// of another run than it looked at.
struct Ticket {
  std::uint64_t word = 0;  // run << 32 | items taken << 16 | items

  static constexpr std::uint64_t kMask = (1u << 16) - 1;
  static Ticket of(std::uint64_t run, int count) noexcept { return {run << 32 | std::uint64_t(count)}; }
  std::uint64_t run() const noexcept { return word >> 32; }
  int taken() const noexcept { return int(word >> 16 & kMask); }
  int count() const noexcept { return int(word & kMask); }
  Ticket with_one_more_taken() const noexcept { return {word + (kMask + 1)}; }
};
constexpr int kMostItems = int(Ticket::kMask);  // in one go

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
  int threads = 1;
  int spins = 0;
  std::atomic<Task> task{nullptr};  // both of the run that the ticket names; written before it, read after it
  std::atomic<void*> context{nullptr};
  std::atomic<std::uint64_t> ticket{0};
  std::atomic<int> done{0};  // items of that run
  std::atomic<bool> stop{false};
  std::vector<std::thread> workers;  // one thread less than there are: the one that calls run() works, too

  /// Takes and does items of the run that the ticket names, until none is left.
  void work_off() noexcept {
    Ticket now{ticket.load(std::memory_order_acquire)};
    while (now.taken() < now.count()) {
      const Task run = task.load(std::memory_order_relaxed);
      void* const with = context.load(std::memory_order_relaxed);
      if (!ticket.compare_exchange_weak(now.word, now.with_one_more_taken().word, std::memory_order_acq_rel,
                                        std::memory_order_acquire))
        continue;
      // Nobody has changed the ticket since it was read, so task and context belong to it.
      run(with, now.taken());
      if (done.fetch_add(1, std::memory_order_acq_rel) + 1 == now.count()) done.notify_one();
      now.word = ticket.load(std::memory_order_acquire);
    }
  }

  bool is_news(std::uint64_t seen) const noexcept {
    return Ticket{ticket.load(std::memory_order_acquire)}.run() != seen || stop.load(std::memory_order_acquire);
  }

  /// Sleeps on the very word that was no news: a run that is announced in between is not slept through.
  void sleep_until_news(std::uint64_t seen) noexcept {
    for (;;) {
      const std::uint64_t word = ticket.load(std::memory_order_acquire);
      if (Ticket{word}.run() != seen || stop.load(std::memory_order_acquire)) return;
      ticket.wait(word, std::memory_order_acquire);
    }
  }

  void serve() noexcept {
    std::uint64_t seen = 0;
    for (;;) {
      for (int i = 0; i < spins && !is_news(seen); ++i) pause();
      sleep_until_news(seen);
      if (stop.load(std::memory_order_acquire)) return;
      seen = Ticket{ticket.load(std::memory_order_acquire)}.run();
      work_off();
    }
  }

  void announce(int count) noexcept {
    const Ticket last{ticket.load(std::memory_order_relaxed)};
    done.store(0, std::memory_order_relaxed);
    // Not a mere store: who is about to sleep must see it, or be seen by notify_all().
    ticket.exchange(Ticket::of(last.run() + 1, count).word, std::memory_order_seq_cst);
    ticket.notify_all();
  }

  void wait_for(int count) noexcept {
    for (int i = 0; i < spins && done.load(std::memory_order_acquire) != count; ++i) pause();
    for (int so_far = done.load(std::memory_order_acquire); so_far != count;
         so_far = done.load(std::memory_order_acquire))
      done.wait(so_far, std::memory_order_acquire);
  }

  void join() noexcept {
    stop.store(true, std::memory_order_release);
    announce(0);
    for (std::thread& worker : workers) worker.join();
  }
};

ThreadPool::ThreadPool(int threads) : m_impl(std::make_unique<Impl>()) {
  m_impl->threads = std::clamp(threads, 1, kMaxThreads);
  // Looking out is for threads that have a core of their own; elsewhere it would hold up what is waited for.
  if (unsigned(m_impl->threads) <= std::thread::hardware_concurrency()) m_impl->spins = kSpins;
  m_impl->workers.reserve(m_impl->threads - 1);
  try {
    for (int i = 1; i < m_impl->threads; ++i) m_impl->workers.emplace_back([impl = m_impl.get()] { impl->serve(); });
  } catch (...) {
    m_impl->join();
    throw;
  }
}

ThreadPool::~ThreadPool() { m_impl->join(); }

int ThreadPool::threads() const noexcept { return m_impl->threads; }

void ThreadPool::run(int count, Task task, void* context) noexcept {
  if (m_impl->threads == 1 || count <= 1 || count > kMostItems) {
    for (int i = 0; i < count; ++i) task(context, i);
    return;
  }
  m_impl->task.store(task, std::memory_order_relaxed);
  m_impl->context.store(context, std::memory_order_relaxed);
  m_impl->announce(count);
  m_impl->work_off();
  m_impl->wait_for(count);
}

}  // namespace trocar::core
