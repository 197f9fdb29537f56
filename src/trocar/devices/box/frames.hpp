// What goes over the line between a box and who asks it, and how it is found in a stream of bytes. Our own
// protocol; multi-byte numbers are little-endian.
//
//   CONFIG  A5 C0 mask[6] crc16                        to the box: send these channels from now on
//   POLL    A5 (0x10 | seq) crc8                       to the box: one block, please
//   DATA    A5 (0x20 | seq) mask-id flags payload crc16   the answer: seq of its poll, 6 + ceil(1.5 n) + 4 bytes
//   raw     76 bytes                                   the answer of a box without frames to any single byte
//
// The checksums are over all that comes before them. mask-id is the 8-bit checksum of the mask that the payload has, so
// that an answer from before a CONFIG, or from a box that was switched on again, is distinguished from others. The
// parsers take any bytes in any portions, keep no more than two of the longest frames, allocate nothing, and after
// nonsense find the next sound frame: they look on from the byte behind a false beginning, not behind the frame that it
// claimed.
//
//   FrameParser parser;
//   parser.expect(mask);
//   parser.feed(bytes, [&](const DataFrame& frame) { use(frame.block); });
#pragma once

#include <algorithm>

#include <trocar/devices/box/block.hpp>

namespace trocar::devices {

inline constexpr std::uint8_t kBoxSync = 0xa5;
inline constexpr std::uint8_t kBoxConfig = 0xc0, kBoxPoll = 0x10, kBoxData = 0x20;  ///< the last two with seq
inline constexpr std::uint8_t kRawRequest = 0x05;  ///< "enquiry"; a raw box answers any byte
inline constexpr std::size_t kConfigBytes = 10, kPollBytes = 3, kDataOverhead = 6;
inline constexpr std::size_t kLongestData = kDataOverhead + kRawBlockBytes;

/// Bits of a DATA's flags.
enum BoxFlag : std::uint8_t {
  kBoxFresh = 1,       ///< switched on, and no CONFIG since
  kBoxBadRequest = 2,  ///< something was asked since the last answer that could not be understood
  kBoxStreams = 4,     ///< it sends by itself; seq counts its blocks
};

struct DataFrame {
  BoxBlock block;
  ChannelMask mask = 0;
  std::uint8_t seq = 0, flags = 0;
};

constexpr std::size_t data_size(ChannelMask mask) noexcept { return kDataOverhead + packed_size(mask); }
std::uint8_t mask_id(ChannelMask mask) noexcept;

/// Each writes a frame and returns its size; `out` has room for kLongestData.
std::size_t write_config(ChannelMask mask, std::span<std::uint8_t> out) noexcept;
std::size_t write_poll(std::uint8_t seq, std::span<std::uint8_t> out) noexcept;
std::size_t write_data(const DataFrame& frame, std::span<std::uint8_t> out) noexcept;

/// Bytes that wait for the rest of their frame.
template <std::size_t kCapacity>
class FrameBuffer {
 public:
  std::span<const std::uint8_t> bytes() const noexcept { return {m_bytes.data() + m_begin, m_end - m_begin}; }
  void drop(std::size_t count) noexcept { m_begin += std::min(count, m_end - m_begin); }
  void clear() noexcept { m_begin = m_end = 0; }
  /// Takes as many as there is room for; the others.
  std::span<const std::uint8_t> take(std::span<const std::uint8_t> more) noexcept {
    std::copy(m_bytes.begin() + std::ptrdiff_t(m_begin), m_bytes.begin() + std::ptrdiff_t(m_end), m_bytes.begin());
    m_end -= m_begin;
    m_begin = 0;
    const std::size_t count = std::min(more.size(), kCapacity - m_end);
    std::copy_n(more.begin(), count, m_bytes.begin() + std::ptrdiff_t(m_end));
    m_end += count;
    return more.subspan(count);
  }

 private:
  std::array<std::uint8_t, kCapacity> m_bytes{};
  std::size_t m_begin = 0, m_end = 0;
};

/// Finds DATA.
class FrameParser {
 public:
  struct Counts {
    std::uint64_t frames = 0;     ///< sound ones
    std::uint64_t bad = 0;        ///< that began and ended as frames do, with a wrong checksum
    std::uint64_t skipped = 0;    ///< bytes that belong to no sound frame
    std::uint64_t strangers = 0;  ///< headers with a mask that is not known here
  };

  /// Besides all channels, which a box sends before its configuration. False: its mask-id is that of another known
  /// mask, and nothing was changed.
  bool expect(ChannelMask mask) noexcept;
  ChannelMask expected() const noexcept { return m_mask; }

  template <class F>
  void feed(std::span<const std::uint8_t> bytes, F&& each) {
    while (!bytes.empty()) {
      bytes = m_buffer.take(bytes);
      drain(each);
    }
  }
  /// Nothing more has come for longer than the line needs for a frame: what was begun will not be ended.
  template <class F>
  void silence(F&& each) {
    while (!m_buffer.bytes().empty()) {
      skip();
      drain(each);
    }
  }
  void clear() noexcept { m_buffer.clear(); }
  const Counts& counts() const noexcept { return m_counts; }

 private:
  enum class Found { nothing, frame };
  Found next(DataFrame& frame) noexcept;
  const ChannelMask* known(std::uint8_t id) const noexcept;
  void skip() noexcept;
  template <class F>
  void drain(F&& each) {
    for (DataFrame frame; next(frame) == Found::frame;) each(frame);
  }

  FrameBuffer<2 * kLongestData> m_buffer;
  ChannelMask m_mask = kAllBoxChannels, m_all = kAllBoxChannels;
  std::uint8_t m_mask_id = mask_id(kAllBoxChannels), m_all_id = m_mask_id;
  Counts m_counts;
};

/// What a box may be asked.
struct BoxRequest {
  enum Kind { poll, config } kind = poll;
  std::uint8_t seq = 0;
  ChannelMask mask = 0;
};

/// Finds CONFIG and POLL: the box's side.
class RequestParser {
 public:
  template <class F>
  void feed(std::span<const std::uint8_t> bytes, F&& each) {
    while (!bytes.empty()) {
      bytes = m_buffer.take(bytes);
      for (BoxRequest request; next(request);) each(request);
    }
  }
  void clear() noexcept { m_buffer.clear(); }
  std::uint64_t bad() const noexcept { return m_bad; }  ///< bytes that belong to no sound request

 private:
  bool next(BoxRequest& request) noexcept;
  FrameBuffer<2 * kConfigBytes> m_buffer;
  std::uint64_t m_bad = 0;
};

/// Cuts raw blocks out of a stream by the silence between them: the first byte after a silence begins a block.
class RawParser {
 public:
  struct Counts {
    std::uint64_t blocks = 0, torn = 0;  ///< torn: begun, and silence before their end
  };

  /// @param silent  was there silence before the first of `bytes`?
  template <class F>
  void feed(std::span<const std::uint8_t> bytes, bool silent, F&& each) {
    if (silent) clear();
    for (const std::uint8_t byte : bytes) {
      m_bytes[m_filled++] = byte;
      if (m_filled < kRawBlockBytes) continue;
      m_filled = 0;
      ++m_counts.blocks;
      each(unpack(m_bytes, kAllBoxChannels));
    }
  }
  void clear() noexcept {
    m_counts.torn += m_filled > 0;
    m_filled = 0;
  }
  const Counts& counts() const noexcept { return m_counts; }

 private:
  std::array<std::uint8_t, kRawBlockBytes> m_bytes{};
  std::size_t m_filled = 0;
  Counts m_counts;
};

}  // namespace trocar::devices
