// A board for the box's sketch: a serial line, and chips at an SPI bus, selected by pins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace trocar::arduino {

/// MCP3208: the second and third byte of an exchange hold what the chosen input has.
struct Converter {
  std::array<std::uint16_t, 8> code{};
  std::uint8_t exchange(std::size_t place, std::uint8_t in) {
    if (place == 0) m_input = std::uint8_t((in & 1) << 2), m_asked = (in & 0xfe) == 0x06;
    if (place == 1) m_input = std::uint8_t(m_input | in >> 6);
    if (!m_asked || place == 0) return 0xff;
    return place == 1 ? std::uint8_t(0xe0 | code[m_input] >> 8) : std::uint8_t(code[m_input]);
  }

 private:
  std::uint8_t m_input = 0;
  bool m_asked = false;
};

/// MCP23S17: register after register of the one that is addressed.
struct Switches {
  std::uint8_t address = 0;
  std::uint16_t closed = 0;
  std::uint8_t exchange(std::size_t place, std::uint8_t in) {
    if (place == 0) m_code = in;
    if (place == 1) m_register = in;
    const bool addressed = (m_code & 0xf0) == 0x40 && ((m_addresses ? address : 0) == (m_code >> 1 & 7));
    if (place < 2 || !addressed) return 0;
    const std::size_t reg = m_register + place - 2;
    if ((m_code & 1) == 0 && reg < m_registers.size()) write(reg, in);
    return (m_code & 1) != 0 ? read(reg) : std::uint8_t(0);
  }

 private:
  void write(std::size_t reg, std::uint8_t value) {
    m_registers[reg] = value;
    if (reg == 0x0a || reg == 0x0b) m_addresses = (value & 0x08) != 0;
  }
  /// An open input without a pull-up is read as if it were closed: nothing holds it.
  std::uint8_t read(std::size_t reg) const {
    if (reg != 0x12 && reg != 0x13) return 0;
    const std::size_t port = reg - 0x12;
    return std::uint8_t(m_registers[0x0c + port] & ~(closed >> (8 * port)));
  }

  std::array<std::uint8_t, 0x16> m_registers{};
  std::uint8_t m_code = 0, m_register = 0;
  bool m_addresses = false;
};

struct Board {
  std::array<Converter, 6> converters;  ///< at pins 4 to 9
  std::array<Switches, 2> switches;     ///< at pin 10
  std::deque<std::uint8_t> in;          ///< to the sketch
  std::vector<std::uint8_t> out;        ///< from it
  std::array<bool, 20> selected{};
  std::size_t place = 0;

  Board() { switches[1].address = 1; }
  void select(int pin, bool is_low) {
    selected[std::size_t(pin)] = is_low;
    place = 0;
  }
  std::uint8_t exchange(std::uint8_t byte) {
    std::uint8_t answer = 0;
    for (std::size_t i = 0; i < converters.size(); ++i)
      if (selected[4 + i]) answer = std::uint8_t(answer | converters[i].exchange(place, byte));
    if (selected[10])
      for (Switches& s : switches) answer = std::uint8_t(answer | s.exchange(place, byte));
    ++place;
    return answer;
  }
};

inline Board& board() {
  static Board one;
  return one;
}

}  // namespace trocar::arduino
