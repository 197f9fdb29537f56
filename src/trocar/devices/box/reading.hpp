// From a box's blocks to poses of hands: calibrated, filtered, pedals debounced; and what becomes of them while blocks
// are missing.
//
//   BoxReader reader(wiring);
//   const BoxPose& pose = reader.read(packet);         // every block, in order
//
//   BoxBridge bridge(period);
//   bridge.take(pose);
//   const BoxPose& now = bridge.at(time);              // any time: measured, extrapolated, held or frozen
#pragma once

#include <trocar/devices/box/dialogue.hpp>
#include <trocar/devices/box/wiring.hpp>

namespace trocar::devices {

using BoxAngles = std::array<std::array<double, kBoxAxes>, kBoxActors>;

/// What all hands and feet do at one moment. Plain bytes, for a Mailbox.
struct BoxPose {
  BoxAngles axes{};                                ///< [rad], [m], 0 .. 1; 0 where nothing is wired or came
  std::uint32_t wired = 0;                         ///< bit kBoxAxes * actor + axis: it came
  std::uint32_t pedals = 0;                        ///< BoxPedal
  std::array<std::uint8_t, kBoxHands> valves{};    ///< bit 0: irrigates, bit 1: sucks
  std::array<std::uint32_t, kBoxHands> changes{};  ///< how often another instrument was asked for, since it began
  BoxTime acquired = 0, arrived = 0;
  std::uint64_t number = 0;  ///< of the block, from 1
  BoxBlock block;            ///< as it came

  bool has(BoxActor actor, BoxAxis axis) const { return (wired >> (kBoxAxes * int(actor) + int(axis)) & 1) != 0; }
  double of(BoxActor actor, BoxAxis axis) const { return axes[std::size_t(actor)][std::size_t(axis)]; }
};

/// One value through the filter of BoxFilter.
class OneEuro {
 public:
  /// @param dt since the last one [s]  @param rest, per_speed as in BoxFilter
  double next(double value, double dt, double rest, double per_speed) noexcept;

 private:
  double m_value = 0, m_speed = 0;
  bool m_begun = false;
};

/// Contacts bounce for some milliseconds: a change counts at once, and further ones of the same bit only kBounce later.
/// Where no checksum says that a block is sound, a change counts when the next block says so, too.
class Debounce {
 public:
  static constexpr BoxTime kBounce = 5'000'000;
  /// @param at when it was measured  @returns the bits as they count now
  std::uint32_t next(std::uint32_t bits, BoxTime at, bool checked) noexcept;

 private:
  std::uint32_t m_bits = 0, m_last = 0;
  std::array<BoxTime, kBoxDigitalBits> m_changed{};
  bool m_begun = false;
};

/// The light post turns without an end: from one end of its channel to the other is a step of a few degrees, not one
/// back over the whole turn.  @returns `angle`, by whole turns nearer to `before`
double unwrapped(double angle, double before) noexcept;

class BoxReader {
 public:
  explicit BoxReader(const BoxWiring& wiring) : m_wiring(wiring) {}
  const BoxPose& read(const BoxPacket& packet) noexcept;
  const BoxWiring& wiring() const noexcept { return m_wiring; }

 private:
  void read_bits(std::uint32_t bits) noexcept;

  BoxWiring m_wiring;
  BoxPose m_pose;
  double m_post = 0;  ///< before the filter
  std::array<std::array<OneEuro, kBoxAxes>, kBoxActors> m_filters;
  Debounce m_debounce;
  std::uint32_t m_pressed = 0;  ///< bit per hand: its button for another instrument is down
};

/// How fresh what a bridge says is.
enum class BoxFreshness { measured, extrapolated, held, frozen };
const char* name_of(BoxFreshness freshness);

/// Missing blocks: for up to kExtrapolated every axis continues as fast as it did, then it stands still, for up to
/// kHeldBlocks blocks in all; then it is frozen: pedals and valves are let go, and somebody is to be warned.
class BoxBridge {
 public:
  static constexpr BoxTime kExtrapolated = 40'000'000;
  static constexpr int kHeldBlocks = 3;

  explicit BoxBridge(BoxTime period) : m_period(period) {}
  void take(const BoxPose& pose) noexcept;
  const BoxPose& at(BoxTime now) noexcept;
  BoxFreshness freshness() const noexcept { return m_freshness; }
  bool any() const noexcept { return m_new.number != 0; }
  const BoxPose& newest() const noexcept { return m_new; }

 private:
  BoxTime m_period;
  BoxPose m_new, m_out;
  BoxAngles m_speed{};  ///< between the last two blocks [1/s]
  BoxFreshness m_freshness = BoxFreshness::frozen;
};

}  // namespace trocar::devices
