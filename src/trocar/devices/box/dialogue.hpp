// Who asks the box: polls on time without waiting for the answer to the last one (a block takes nearly the whole period
// at 38,400 Bd), knows which answers are missing, tells a box that was switched on again which channels are wanted. No
// port and no clock: bytes and times come from outside.
//
//   BoxDialogue dialogue(settings);
//   write(dialogue.ask(now));                                       // once a period
//   dialogue.hear(bytes, now, [&](const BoxPacket& p) { ... });     // whatever came
#pragma once

#include <optional>

#include <trocar/devices/box/box_time.hpp>
#include <trocar/devices/box/frames.hpp>

namespace trocar::devices {

struct BoxDialogueSettings {
  int baud = 38'400;
  double rate = 50;  ///< blocks a second that are asked for
  bool raw = false;  ///< a box without frames
  ChannelMask mask = kAllBoxChannels;

  BoxTime period() const noexcept { return box_time(1 / rate); }
};

/// A block and what is known of its way.
struct BoxPacket {
  BoxBlock block;
  ChannelMask mask = 0;      ///< channels that came
  std::uint32_t missed = 0;  ///< blocks that were lost since the one before
  std::uint8_t flags = 0;    ///< BoxFlag
  bool checked = false;      ///< by a checksum
  BoxTime acquired = 0;      ///< when it was measured, as far as is known: when the poll was over
  BoxTime arrived = 0;       ///< when its last byte was here
};

struct BoxCounts {
  std::uint64_t asked = 0, blocks = 0, missed = 0;
  std::uint64_t bad = 0;      ///< frames with a wrong checksum, or that nobody asked for; raw: torn, unlikely blocks
  std::uint64_t skipped = 0;  ///< bytes of no frame
  std::uint64_t configs = 0;  ///< times that the box received its channels
  BoxTime round_trip = 0;     ///< of the last block, from asking to its last byte

  double missed_share() const noexcept { return blocks + missed > 0 ? double(missed) / double(blocks + missed) : 0.0; }
};

/// A raw block has no checksum: one in which two of the channels of `mask` leap by a quarter of their range within a
/// period, which no two hands do, is taken for one that was cut at a wrong place.
bool unlikely_after(const BoxBlock& before, const BoxBlock& now, ChannelMask mask) noexcept;

class BoxDialogue {
 public:
  explicit BoxDialogue(const BoxDialogueSettings& settings);

  /// The line is new: opened, or opened again.
  void begin() noexcept;
  /// What is to be written now: a poll, a CONFIG before it where the box needs one, or nothing where the line is to
  /// fall silent. Valid until the next call.
  std::span<const std::uint8_t> ask(BoxTime now) noexcept;
  /// When to ask next: at `due`, but not before the line has had time for the last answer. A request that went late
  /// would else make every later block wait on the line.
  BoxTime next(BoxTime due) const noexcept;

  /// @param bytes  what the line had at `now`, also when that was nothing. Silence lies between two looks at the line:
  ///               a host that slept through bytes has not heard silence.
  template <class F>
  void hear(std::span<const std::uint8_t> bytes, BoxTime now, F&& each) {
    const auto take = [&](const DataFrame& frame) {
      if (const std::optional<BoxPacket> one = packet(frame, now)) each(*one);
    };
    if (bytes.empty()) {
      m_last_looked = now;
      if (silent()) m_parser.silence(take);
      return;
    }
    if (m_settings.raw) {
      m_trusts = m_trusts || silent();
      m_raw.feed(bytes, silent(), [&](const BoxBlock& block) { raw(block, now, each); });
    } else {
      m_parser.feed(bytes, take);
    }
    m_last_heard = now;
  }

  const BoxDialogueSettings& settings() const noexcept { return m_settings; }
  bool answered() const noexcept { return m_heard_any; }  ///< has a block come since begin()?
  BoxCounts counts() const noexcept;

 private:
  std::optional<BoxPacket> packet(const DataFrame& frame, BoxTime now) noexcept;
  BoxPacket raw_packet(const BoxBlock& block, BoxTime now) noexcept;
  BoxTime raw_asked(BoxTime now) const noexcept;
  bool believed(const BoxBlock& block) noexcept;
  template <class F>
  void raw(const BoxBlock& block, BoxTime now, F&& each) {
    if (believed(block)) each(raw_packet(block, now));
  }
  void number(std::uint64_t number, BoxPacket& packet) noexcept;
  bool silent() const noexcept { return m_last_looked - m_last_heard > m_silence; }

  BoxDialogueSettings m_settings;
  BoxTime m_silence;
  FrameParser m_parser;
  RawParser m_raw;
  BoxCounts m_counts;
  std::array<std::uint8_t, kConfigBytes + kPollBytes> m_out{};
  static constexpr BoxTime kNotAsked = -1;
  std::array<BoxTime, 16> m_asked{};  ///< when each seq was asked last; kNotAsked: answered, or never
  std::uint64_t m_number = 0;         ///< of the last poll since begin()
  std::uint64_t m_answered = 0;       ///< number of the last block
  bool m_heard_any = false;           ///< since begin()
  bool m_needs_config = true, m_told_any = false;
  BoxTime m_told = 0;  ///< the last CONFIG
  BoxTime m_last_asked = 0;
  BoxTime m_last_heard = 0, m_last_looked = 0, m_last_block = 0;
  BoxBlock m_before;             ///< raw: the last block
  bool m_wants_silence = false;  ///< raw: nothing is asked until the line has been silent
  bool m_trusts = true;          ///< raw: the next block begins after a silence
  std::uint64_t m_unlikely = 0, m_unasked = 0;
};

}  // namespace trocar::devices
