// The instrument box's side of its protocol (docs/guides/box.md#protocol), for a microcontroller: no memory is
// allocated, and nothing of a board is needed. What it measures comes from the sketch beside it.
//
//   static trocar_box::Box box;
//   box.hear(byte);
//   while (box.is_asked()) box.send(measured, Serial);     // a byte at a time, by Serial.write(byte)
#ifndef TROCAR_BOX_PROTOCOL_H
#define TROCAR_BOX_PROTOCOL_H

#include <stdint.h>

namespace trocar_box {

const uint8_t kChannels = 48, kMaskBytes = 6;

// What is measured: codes of 0 to 4095, and a bit for each switch.
struct Measured {
  uint16_t code[kChannels];
  uint32_t bits;
};

// CRC-16 X-25: low bit first, begins with ones, inverted at the end. What a byte makes of it.
inline uint16_t crc16_next(uint16_t crc, uint8_t byte) {
  crc = uint16_t(crc ^ byte);
  for (uint8_t bit = 0; bit < 8; ++bit) crc = uint16_t((crc & 1) ? (crc >> 1) ^ 0x8408 : crc >> 1);
  return crc;
}

// CRC-8 ROHC: low bit first, begins with ones.
inline uint8_t crc8(const uint8_t* bytes, uint8_t size) {
  uint8_t crc = 0xff;
  for (uint8_t i = 0; i < size; ++i) {
    crc = uint8_t(crc ^ bytes[i]);
    for (uint8_t bit = 0; bit < 8; ++bit) crc = uint8_t((crc & 1) ? (crc >> 1) ^ 0xe0 : crc >> 1);
  }
  return crc;
}

class Box {
 public:
  Box() : m_filled(0), m_sequence(0), m_fresh(true), m_bad(false) {
    for (uint8_t i = 0; i < kMaskBytes; ++i) m_mask[i] = 0xff;  // all channels, until it is configured
    m_mask_id = crc8(m_mask, kMaskBytes);
  }

  // A byte of the line. is_asked() is called until it is false before the next one.
  void hear(uint8_t byte) { m_bytes[m_filled++] = byte; }

  // True, once for each request: a block is asked for.
  bool is_asked() {
    while (m_filled > 0) {
      const uint8_t size = frame_size();
      if (size != 0 && m_filled < size) return false;
      if (size == 0 || !is_sound(size)) {  // no frame begins here: look on from the next byte
        m_bad = true;
        drop(1);
      } else if (take(size)) {
        return true;
      }
    }
    return false;
  }

  // The answer to the request that was heard last. Its first byte goes out at once, the others while the line is busy.
  template <class Line>
  void send(const Measured& measured, Line& line) {
    Checked<Line> out(line);
    out.put(0xa5);
    out.put(uint8_t(0x20 | m_sequence));
    out.put(m_mask_id);
    out.put(uint8_t((m_fresh ? 1 : 0) | (m_bad ? 2 : 0)));
    m_bad = false;
    pack(measured, m_mask, out);
    const uint16_t crc = uint16_t(~out.crc);
    line.write(uint8_t(crc & 0xff));
    line.write(uint8_t(crc >> 8));
  }

  // A block without a frame: all channels, 76 bytes, the answer to any byte.
  template <class Line>
  static void send_raw(const Measured& measured, Line& line) {
    const uint8_t all[kMaskBytes] = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
    Checked<Line> out(line);
    pack(measured, all, out);
  }

 private:
  // A line, and the checksum of what went through it.
  template <class Line>
  struct Checked {
    explicit Checked(Line& to) : line(to), crc(0xffff) {}
    void put(uint8_t byte) {
      line.write(byte);
      crc = crc16_next(crc, byte);
    }
    Line& line;
    uint16_t crc;
  };

  static const uint8_t kPoll = 3, kConfig = 10;

  // Of the frame that begins with the first byte; 2 while its kind is not known; 0: none begins there.
  uint8_t frame_size() const {
    if (m_bytes[0] != 0xa5) return 0;
    if (m_filled < 2) return 2;
    if ((m_bytes[1] & 0xf0) == 0x10) return kPoll;
    return m_bytes[1] == 0xc0 ? kConfig : 0;
  }
  bool is_sound(uint8_t size) const {
    if (size == kPoll) return crc8(m_bytes, 2) == m_bytes[2];
    uint16_t crc = 0xffff;
    for (uint8_t i = 0; i < kConfig - 2; ++i) crc = crc16_next(crc, m_bytes[i]);
    crc = uint16_t(~crc);
    return m_bytes[kConfig - 2] == uint8_t(crc & 0xff) && m_bytes[kConfig - 1] == uint8_t(crc >> 8);
  }
  bool take(uint8_t size) {
    const bool asked = size == kPoll;
    if (asked) {
      m_sequence = uint8_t(m_bytes[1] & 0x0f);
    } else {
      for (uint8_t i = 0; i < kMaskBytes; ++i) m_mask[i] = m_bytes[2 + i];
      m_mask_id = crc8(m_mask, kMaskBytes);
      m_fresh = false;
    }
    drop(size);
    return asked;
  }
  void drop(uint8_t count) {
    for (uint8_t i = count; i < m_filled; ++i) m_bytes[i - count] = m_bytes[i];
    m_filled = uint8_t(m_filled - count);
  }

  // Two codes in three bytes, channels rising, then the bits.
  template <class Out>
  static void pack(const Measured& measured, const uint8_t* mask, Out& out) {
    uint8_t rest = 0;   // the upper four bits of a code, which share a byte with the next one
    bool half = false;  // there is such a rest
    for (uint8_t channel = 0; channel < kChannels; ++channel) {
      if ((mask[channel / 8] >> (channel % 8) & 1) == 0) continue;
      const uint16_t code = uint16_t(measured.code[channel] & 0x0fff);
      if (half) {
        out.put(uint8_t(rest | (code << 4 & 0xf0)));
        out.put(uint8_t(code >> 4));
      } else {
        out.put(uint8_t(code & 0xff));
        rest = uint8_t(code >> 8);
      }
      half = !half;
    }
    if (half) out.put(rest);
    for (uint8_t i = 0; i < 4; ++i) out.put(uint8_t(measured.bits >> (8 * i) & 0xff));
  }

  uint8_t m_bytes[kConfig], m_filled;  // of a request that has begun
  uint8_t m_mask[kMaskBytes];          // channels that are wanted, bit i for channel i
  uint8_t m_mask_id;                   // its checksum, by which answers name it
  uint8_t m_sequence;                  // of the request that was heard last
  bool m_fresh, m_bad;                 // not configured since it was switched on; something was not understood
};

}  // namespace trocar_box

#endif
