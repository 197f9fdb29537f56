#include <trocar/core/error.hpp>
#include <trocar/devices/box/link.hpp>

namespace trocar::devices {

BoxLink::BoxLink(std::string path, const BoxDialogueSettings& settings, Clock clock)
    : m_path(std::move(path)), m_dialogue(settings), m_clock(std::move(clock)) {}

void BoxLink::open() {
  m_port = SerialPort::open(m_path, m_dialogue.settings().baud);
  m_dialogue.begin();
  ++m_opened;
}

bool BoxLink::try_to_open() {
  try {
    open();
  } catch (const core::EnvironmentLacks&) {
    m_port.close();
  }
  return is_open();
}

void BoxLink::ask() {
  if (m_port && !m_port.write(m_dialogue.ask(m_clock()))) lose();
}

void BoxLink::lose() { m_port.close(); }

}  // namespace trocar::devices
