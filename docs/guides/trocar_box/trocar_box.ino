// Instrument box for Trocar: 48 potentiometers and 32 switches at an Arduino Nano or Uno.
// docs/guides/box_build.md has the parts, the wiring and how to try it.
//
// Six MCP3208 (8 channels of 12 bits each) and two MCP23S17 (16 switches each) share the SPI bus.
// Channels and switches are measured all the time, so that an answer begins at once.
#include <SPI.h>

#include "box_protocol.h"

const long kBaud = 38400;            // as "baud" of box.json; 57600 or more for all 48 channels in frames
const bool kRaw = false;             // true: "protocol": "raw"
const uint8_t kConverters[] = {4, 5, 6, 7, 8, 9};  // pins that select the MCP3208, channels rising
const uint8_t kSwitches = 10;        // pin that selects the MCP23S17, whose addresses are 0 and 1
const uint8_t kSwitchChips = 2;      // that are fitted: 0, 1 or 2. The switches of others are open

const SPISettings kConverterBus(1000000, MSBFIRST, SPI_MODE0);  // the MCP3208 allow 2 MHz at 5 V
const SPISettings kSwitchBus(4000000, MSBFIRST, SPI_MODE0);

trocar_box::Box box;
trocar_box::Measured measured;
uint8_t next_channel = 0;

// Registers of the MCP23S17, as they are after a reset (BANK 0).
const uint8_t kConfiguration = 0x0a, kPullUps = 0x0c, kPort = 0x12;

void write_switches(uint8_t address, uint8_t reg, uint8_t a, uint8_t b) {
  SPI.beginTransaction(kSwitchBus);
  digitalWrite(kSwitches, LOW);
  SPI.transfer(uint8_t(0x40 | address << 1));
  SPI.transfer(reg);
  SPI.transfer(a);
  SPI.transfer(b);
  digitalWrite(kSwitches, HIGH);
  SPI.endTransaction();
}

uint16_t read_switches(uint8_t address) {
  SPI.beginTransaction(kSwitchBus);
  digitalWrite(kSwitches, LOW);
  SPI.transfer(uint8_t(0x41 | address << 1));
  SPI.transfer(kPort);
  const uint8_t a = SPI.transfer(0), b = SPI.transfer(0);
  digitalWrite(kSwitches, HIGH);
  SPI.endTransaction();
  return uint16_t(a | b << 8);
}

uint16_t read_channel(uint8_t channel) {
  const uint8_t pin = kConverters[channel / 8], input = uint8_t(channel % 8);
  SPI.beginTransaction(kConverterBus);
  digitalWrite(pin, LOW);
  SPI.transfer(uint8_t(0x06 | input >> 2));                // a start bit, one input against ground, its number
  const uint8_t high = SPI.transfer(uint8_t(input << 6));
  const uint8_t low = SPI.transfer(0);
  digitalWrite(pin, HIGH);
  SPI.endTransaction();
  return uint16_t((high & 0x0f) << 8 | low);
}

void setup() {
  for (uint8_t i = 0; i < sizeof kConverters; ++i) {
    pinMode(kConverters[i], OUTPUT);
    digitalWrite(kConverters[i], HIGH);
  }
  pinMode(kSwitches, OUTPUT);
  digitalWrite(kSwitches, HIGH);
  SPI.begin();
  write_switches(0, kConfiguration, 0x08, 0x08);  // addresses count from here on; until then both take address 0
  for (uint8_t address = 0; address < kSwitchChips; ++address) write_switches(address, kPullUps, 0xff, 0xff);
  Serial.begin(kBaud);
}

// One channel, and after the last of them the switches: a closed one pulls its input to ground.
void measure() {
  measured.code[next_channel] = read_channel(next_channel);
  if (++next_channel < trocar_box::kChannels) return;
  next_channel = 0;
  measured.bits = 0;
  for (uint8_t address = 0; address < kSwitchChips; ++address)
    measured.bits |= uint32_t(uint16_t(~read_switches(address))) << 16 * address;
}

void loop() {
  measure();
  while (Serial.available() > 0) {
    const uint8_t heard = uint8_t(Serial.read());
    if (kRaw) {
      trocar_box::Box::send_raw(measured, Serial);
      continue;
    }
    box.hear(heard);
    while (box.is_asked()) box.send(measured, Serial);
  }
}
