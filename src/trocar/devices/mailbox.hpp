// The newest value from one thread to another: how a device thread, at its own rate, hands its sample to the
// simulation, at 1 kHz. The writer never waits and the reader never sees half a sample; samples that nobody took in
// time are replaced (core/triple_buffer.hpp).
//
//   Mailbox<Sample> box;
//   box.put(sample);               // the device's thread
//   if (box.take(sample)) ...      // the simulation's thread: true when there was a newer one
#pragma once

#include <type_traits>

#include <trocar/core/triple_buffer.hpp>

namespace trocar::devices {

template <class T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>, "a sample is plain bytes");

 public:
  /// One thread only. Replaces what was not taken yet.
  void put(const T& value) noexcept {
    m_buffer.next() = value;
    m_buffer.publish();
  }

  /// One (other) thread only. Copies the newest value and returns true, or leaves `value` alone when none is newer.
  bool take(T& value) noexcept {
    if (!m_buffer.refresh()) return false;
    value = m_buffer.latest();
    return true;
  }

 private:
  core::TripleBuffer<T> m_buffer{T{}};
};

}  // namespace trocar::devices
