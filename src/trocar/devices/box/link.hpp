// A box at a port: the dialogue over a line that may be unplugged and come back at any moment.
//
//   BoxLink link("/dev/ttyUSB0", settings);
//   link.open();                                   // throws core::EnvironmentLacks
//   link.ask();                                    // once a period
//   link.listen(until, [&](const BoxPacket& p) { ... });
#pragma once

#include <functional>
#include <string>

#include <trocar/devices/box/dialogue.hpp>
#include <trocar/devices/box/serial_port.hpp>

namespace trocar::devices {

class BoxLink {
 public:
  using Clock = std::function<BoxTime()>;
  /// @param clock  what packets are stamped with; the steady clock by default
  BoxLink(std::string path, const BoxDialogueSettings& settings, Clock clock = box_now);

  void open();         ///< @throws core::EnvironmentLacks
  bool try_to_open();  ///< the same without a word
  bool is_open() const { return bool(m_port); }
  void ask();
  BoxTime next(BoxTime due) const { return m_dialogue.next(due); }  ///< when to ask again (BoxDialogue::next)
  /// Takes what comes until `until` of the steady clock, or until `enough` says so after a packet.
  template <class F>
  void listen(BoxTime until, F&& each, const std::function<bool()>& enough = {}) {
    while (m_port && m_port.wait(until)) {
      std::array<std::uint8_t, 4096> bytes;
      const long count = m_port.read(bytes);
      if (count < 0) return lose();
      if (count > 0) m_dialogue.hear(std::span(bytes).first(std::size_t(count)), m_clock(), each);
      if ((enough && enough()) || box_now() >= until) return;
    }
    const BoxTime now = m_clock();  // before the look: what comes after it is not missed
    if (m_port && !m_port.wait(0)) m_dialogue.hear({}, now, each);
  }

  const std::string& path() const { return m_path; }
  const BoxDialogueSettings& settings() const { return m_dialogue.settings(); }
  bool answered() const { return m_dialogue.answered(); }  ///< since it was opened
  BoxCounts counts() const { return m_dialogue.counts(); }
  std::uint64_t opened() const { return m_opened; }  ///< times

 private:
  void lose();
  std::string m_path;
  BoxDialogue m_dialogue;
  Clock m_clock;
  SerialPort m_port;
  std::uint64_t m_opened = 0;
};

}  // namespace trocar::devices
