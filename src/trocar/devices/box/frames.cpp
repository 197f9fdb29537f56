#include <trocar/devices/box/crc.hpp>
#include <trocar/devices/box/frames.hpp>

namespace trocar::devices {
namespace {

constexpr std::uint8_t kTypeBits = 0xf0, kSeqBits = 0x0f;
constexpr std::size_t kHeaderBytes = 4;

void put_mask(ChannelMask mask, std::uint8_t* out) noexcept {
  for (std::size_t i = 0; i < kBoxMaskBytes; ++i) out[i] = std::uint8_t(mask >> (8 * i));
}

ChannelMask get_mask(std::span<const std::uint8_t> bytes) noexcept {
  ChannelMask mask = 0;
  for (std::size_t i = 0; i < kBoxMaskBytes; ++i) mask |= ChannelMask(bytes[i]) << (8 * i);
  return mask;
}

/// Puts the checksum behind `size` bytes; the size with it.
std::size_t seal16(std::span<std::uint8_t> out, std::size_t size) noexcept {
  const std::uint16_t crc = box_crc16(out.first(size));
  out[size] = std::uint8_t(crc);
  out[size + 1] = std::uint8_t(crc >> 8);
  return size + 2;
}

/// Is the end of `frame` the checksum of what comes before it?
bool sound16(std::span<const std::uint8_t> frame) noexcept {
  const std::size_t size = frame.size() - 2;
  return box_crc16(frame.first(size)) == unsigned(frame[size] | frame[size + 1] << 8);
}

}  // namespace

std::uint8_t mask_id(ChannelMask mask) noexcept {
  std::array<std::uint8_t, kBoxMaskBytes> bytes{};
  put_mask(mask, bytes.data());
  return box_crc8(bytes);
}

std::size_t write_config(ChannelMask mask, std::span<std::uint8_t> out) noexcept {
  out[0] = kBoxSync;
  out[1] = kBoxConfig;
  put_mask(mask & kAllBoxChannels, &out[2]);
  return seal16(out, 2 + kBoxMaskBytes);
}

std::size_t write_poll(std::uint8_t seq, std::span<std::uint8_t> out) noexcept {
  out[0] = kBoxSync;
  out[1] = std::uint8_t(kBoxPoll | (seq & kSeqBits));
  out[2] = box_crc8(out.first(2));
  return kPollBytes;
}

std::size_t write_data(const DataFrame& frame, std::span<std::uint8_t> out) noexcept {
  out[0] = kBoxSync;
  out[1] = std::uint8_t(kBoxData | (frame.seq & kSeqBits));
  out[2] = mask_id(frame.mask);
  out[3] = frame.flags;
  pack(frame.block, frame.mask, out.subspan(kHeaderBytes));
  return seal16(out, kHeaderBytes + packed_size(frame.mask));
}

bool FrameParser::expect(ChannelMask mask) noexcept {
  mask &= kAllBoxChannels;
  const std::uint8_t id = mask_id(mask);
  if (mask != m_all && id == m_all_id) return false;
  m_mask = mask;
  m_mask_id = id;
  return true;
}

const ChannelMask* FrameParser::known(std::uint8_t id) const noexcept {
  if (id == m_mask_id) return &m_mask;
  return id == m_all_id ? &m_all : nullptr;
}

void FrameParser::skip() noexcept {
  m_buffer.drop(1);
  ++m_counts.skipped;
}

FrameParser::Found FrameParser::next(DataFrame& frame) noexcept {
  for (;;) {
    const std::span<const std::uint8_t> bytes = m_buffer.bytes();
    if (bytes.empty()) return Found::nothing;
    if (bytes[0] != kBoxSync || (bytes.size() > 1 && (bytes[1] & kTypeBits) != kBoxData)) {
      skip();
      continue;
    }
    if (bytes.size() < kHeaderBytes) return Found::nothing;
    const ChannelMask* mask = known(bytes[2]);
    if (!mask) {
      ++m_counts.strangers;
      skip();
      continue;
    }
    const std::size_t size = data_size(*mask);
    if (bytes.size() < size) return Found::nothing;
    if (!sound16(bytes.first(size))) {
      ++m_counts.bad;
      skip();
      continue;
    }
    frame = {unpack(bytes.subspan(kHeaderBytes), *mask), *mask, std::uint8_t(bytes[1] & kSeqBits), bytes[3]};
    m_buffer.drop(size);
    ++m_counts.frames;
    return Found::frame;
  }
}

bool RequestParser::next(BoxRequest& request) noexcept {
  for (;;) {
    const std::span<const std::uint8_t> bytes = m_buffer.bytes();
    if (bytes.empty()) return false;
    if (bytes[0] == kBoxSync && bytes.size() == 1) return false;
    if (bytes[0] == kBoxSync && (bytes[1] & kTypeBits) == kBoxPoll) {
      if (bytes.size() < kPollBytes) return false;
      if (box_crc8(bytes.first(2)) == bytes[2]) {
        request = {BoxRequest::poll, std::uint8_t(bytes[1] & kSeqBits), 0};
        m_buffer.drop(kPollBytes);
        return true;
      }
    } else if (bytes[0] == kBoxSync && bytes[1] == kBoxConfig) {
      if (bytes.size() < kConfigBytes) return false;
      if (sound16(bytes.first(kConfigBytes))) {
        request = {BoxRequest::config, 0, get_mask(bytes.subspan(2)) & kAllBoxChannels};
        m_buffer.drop(kConfigBytes);
        return true;
      }
    }
    m_buffer.drop(1);
    ++m_bad;
  }
}

}  // namespace trocar::devices
