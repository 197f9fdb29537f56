// What the box's sketch needs of Arduino, on the board of board.hpp.
#pragma once

#include "board.hpp"

inline constexpr int LOW = 0, HIGH = 1, OUTPUT = 1, MSBFIRST = 1, SPI_MODE0 = 0;

inline void pinMode(int, int) {}
inline void digitalWrite(int pin, int level) { trocar::arduino::board().select(pin, level == LOW); }

struct SPISettings {
  SPISettings(long, int, int) {}
};
struct SpiBus {
  void begin() {}
  void beginTransaction(const SPISettings&) {}
  void endTransaction() {}
  std::uint8_t transfer(std::uint8_t byte) { return trocar::arduino::board().exchange(byte); }
};
inline SpiBus SPI;

struct SerialLine {
  void begin(long) {}
  int available() { return int(trocar::arduino::board().in.size()); }
  int read() {
    const int byte = trocar::arduino::board().in.front();
    trocar::arduino::board().in.pop_front();
    return byte;
  }
  void write(std::uint8_t byte) { trocar::arduino::board().out.push_back(byte); }
};
inline SerialLine Serial;
