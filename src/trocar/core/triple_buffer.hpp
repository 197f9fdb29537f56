// A triple buffer: the newest value from one thread to another, without a lock and without waiting. Its three values
// are made beforehand, so that copying a State into one allocates nothing.
//
//   TripleBuffer<State> published(initial_state(model));
//   published.next() = state;  published.publish();      // the simulation's thread, some ticks apart
//   if (published.refresh()) draw(published.latest());    // the drawing thread, at display rate
//
// One slot is being written, one is being read, and the third, in between, is exchanged atomically. The writer never
// waits; what nobody read in time is replaced.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace trocar::core {

template <class T>
class TripleBuffer {
 public:
  /// All three slots start as copies of `first`, with its capacities; it is what latest() gives before any publish().
  explicit TripleBuffer(const T& first) : m_slots{{first}, {first}, {first}} {}

  /// The slot to fill (writer's thread only). It holds an older value.
  T& next() noexcept { return m_slots[m_writing].value; }
  void publish() noexcept { m_writing = m_between.exchange(m_writing | kFresh, std::memory_order_acq_rel) & kIndex; }

  /// Takes the newest value (reader's thread only); false, and latest() unchanged, when there is no newer one.
  bool refresh() noexcept {
    if ((m_between.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    m_reading = m_between.exchange(m_reading, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  const T& latest() const noexcept { return m_slots[m_reading].value; }

 private:
  static constexpr std::uint32_t kIndex = 3, kFresh = 4;
  static constexpr std::size_t kCacheLine = 64;
  struct alignas(kCacheLine) Slot {
    T value;
  };

  Slot m_slots[3];
  alignas(kCacheLine) std::atomic<std::uint32_t> m_between{1};
  alignas(kCacheLine) std::uint32_t m_writing = 0;  // the writer's own
  alignas(kCacheLine) std::uint32_t m_reading = 2;  // the reader's own
};

}  // namespace trocar::core
