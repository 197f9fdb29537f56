// A software box at a pseudo-terminal, served by a thread until it goes out of scope.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include <trocar/devices/box/serving.hpp>

namespace trocar::attempt {

class PluggedBox {
 public:
  PluggedBox(const std::string& port, const devices::SoftwareBoxSettings& settings, devices::SoftwareBox::Motion motion)
      : m_terminal(port),
        m_box(settings, std::move(motion)),
        m_thread([this] { devices::serve(m_box, m_terminal, [this] { return m_stop.load(); }); }) {}
  ~PluggedBox() {
    m_stop = true;
    m_thread.join();
  }
  PluggedBox(const PluggedBox&) = delete;
  PluggedBox& operator=(const PluggedBox&) = delete;

 private:
  devices::PseudoTerminal m_terminal;
  devices::SoftwareBox m_box;
  std::atomic<bool> m_stop{false};
  std::thread m_thread;
};

}  // namespace trocar::attempt
