// A box made of software: answers requests as one with that baud rate would, byte by byte in time, with noise, lost and
// corrupted blocks if wanted. No port and no clock: bytes and times come from outside.
//
//   SoftwareBox box(settings, [&](double seconds) { return block_at(seconds); });
//   box.hear(request_bytes, now);
//   const std::size_t count = box.due(now, buffer);      // bytes whose stop bit is over by now
//   sleep_until(box.next_due());
#pragma once

#include <deque>
#include <functional>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/devices/box/box_time.hpp>
#include <trocar/devices/box/frames.hpp>

namespace trocar::devices {

struct SoftwareBoxSettings {
  bool raw = false;  ///< blocks without frames
  int baud = 38'400;
  double stream_rate = 0;    ///< blocks a second that it sends without being asked; 0: on request [1/s]
  double turnaround = 5e-5;  ///< from a request to the first start bit, when the line is free [s]
  double latency = 0;        ///< added to every byte, as adapters do [s]
  double noise = 0;          ///< of every channel, standard deviation [codes]
  double drop = 0;           ///< share of blocks that are not sent
  double corrupt = 0;        ///< share of bytes that arrive as others
  std::uint64_t seed = 1;
  /// 0: its motion goes by the clock from the first request on, and waits while nobody asks. Else every request is so
  /// much later than the one before [s]: who simulates slower than real time still sees all of it.
  double per_request = 0;
};

class SoftwareBox {
 public:
  using Motion = std::function<BoxBlock(double seconds)>;  ///< since the first request
  SoftwareBox(const SoftwareBoxSettings& settings, Motion motion);

  void hear(std::span<const std::uint8_t> bytes, BoxTime now);
  /// Bytes that are over by `now`, at most as many as `out` holds; their number.
  std::size_t due(BoxTime now, std::span<std::uint8_t> out);
  /// When the block that is being sent will be over, or the next one begins by itself.
  BoxTime next_due() const;
  /// Nobody is at the other end: what is not sent is forgotten, and the motion restarts with the next request.
  void hang_up();
  /// Who reads has stopped: the motion waits where it is until the next request. Not of a box that sends by itself.
  bool waits(BoxTime now) const;

  std::uint64_t sent() const { return m_sent; }        ///< blocks
  std::uint64_t dropped() const { return m_dropped; }  ///< blocks
  double seconds() const { return m_seconds; }         ///< of the motion, at the last block

  static constexpr BoxTime kNever = INT64_MAX;
  static constexpr BoxTime kStopped = 500'000'000;  ///< without a request: who reads has stopped

 private:
  struct Sending {
    std::vector<std::uint8_t> bytes;
    BoxTime start = 0;  ///< of the first start bit
    std::size_t sent = 0;
  };
  void asked(std::uint8_t seq, BoxTime now);
  void answer(std::uint8_t seq, BoxTime now);
  void advance_motion(std::uint8_t seq, BoxTime now);
  BoxBlock measured();
  void stream_until(BoxTime now);
  void corrupt(std::vector<std::uint8_t>& bytes);
  BoxTime over(const Sending& sending, std::size_t bytes) const;

  SoftwareBoxSettings m_settings;
  Motion m_motion;
  core::Random m_random;
  RequestParser m_requests;
  ChannelMask m_mask = kAllBoxChannels;
  bool m_fresh = true;
  std::uint64_t m_bad_seen = 0;
  std::deque<Sending> m_queue;
  BoxTime m_line_free = 0, m_began = kNever, m_last_request = 0, m_next_stream = kNever;
  std::uint64_t m_requests_heard = 0;
  std::uint8_t m_last_seq = 0;
  double m_seconds = 0;
  std::uint64_t m_sent = 0, m_dropped = 0;
};

}  // namespace trocar::devices
