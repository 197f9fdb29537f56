// The newest value from one thread to another, without a lock and without a queue: how a device thread, at its own
// rate, hands its sample to the simulation, at 1 kHz. The writer never waits and the reader never sees half a sample;
// samples that nobody took in time are replaced. A triple buffer: one slot is being written, one is being read, and
// the third, in between, is exchanged atomically.
//
//   Mailbox<Sample> box;
//   box.put(sample);               // the device's thread
//   if (box.take(sample)) ...      // the simulation's thread: true when there was a newer one
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace trocar::devices {

template <class T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>, "a sample is plain bytes");

 public:
  /// One thread only. Replaces what was not taken yet.
  void put(const T& value) noexcept {
    m_slots[m_writing].value = value;
    m_writing = m_between.exchange(m_writing | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// One (other) thread only. Copies the newest value and returns true, or leaves `value` alone when none is newer.
  bool take(T& value) noexcept {
    if ((m_between.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    m_reading = m_between.exchange(m_reading, std::memory_order_acq_rel) & kIndex;
    value = m_slots[m_reading].value;
    return true;
  }

 private:
  static constexpr std::uint32_t kIndex = 3, kFresh = 4;
  static constexpr std::size_t kCacheLine = 64;
  struct alignas(kCacheLine) Slot {
    T value{};
  };

  Slot m_slots[3];
  alignas(kCacheLine) std::atomic<std::uint32_t> m_between{1};
  alignas(kCacheLine) std::uint32_t m_writing = 0;  // the writer's own
  alignas(kCacheLine) std::uint32_t m_reading = 2;  // the reader's own
};

}  // namespace trocar::devices
