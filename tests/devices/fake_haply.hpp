// A service that speaks as Haply's does, for one client: a first message of its own, then one for each that it gets.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/devices/haptics/web_socket.hpp>

namespace trocar::devices {

class FakeHaply {
 public:
  /// @param answer  from what the client said ("" at first) to what the service says
  explicit FakeHaply(std::function<std::string(const std::string&)> answer) : m_answer(std::move(answer)) {
    m_listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(m_listening, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 && listen(m_listening, 1) == 0)
      getsockname(m_listening, reinterpret_cast<sockaddr*>(&address), &size);
    m_port = ntohs(address.sin_port);
    m_thread = std::thread([this] { serve(); });
  }
  ~FakeHaply() {
    m_stop = true;
    m_thread.join();
    close(m_listening);
  }
  int port() const { return m_port; }
  int messages() const { return m_messages; }

  /// A whole, unmasked frame as servers send it.
  static std::string frame(const std::string& text, int opcode = 1) {
    std::string f(1, char(0x80 | opcode));
    if (text.size() < 126) {
      f += char(text.size());
    } else {
      f += char(126);
      f += char(text.size() >> 8);
      f += char(text.size());
    }
    return f + text;
  }

 private:
  bool wait(int fd) {
    for (int i = 0; i < 2000 && !m_stop; ++i) {
      pollfd p{fd, POLLIN, 0};
      if (poll(&p, 1, 5) > 0) return true;
    }
    return false;
  }
  std::string read_some(int fd) {
    char bytes[4096];
    const ssize_t n = wait(fd) ? recv(fd, bytes, sizeof bytes, 0) : 0;
    return n > 0 ? std::string(bytes, std::size_t(n)) : std::string();
  }
  void say(int fd, const std::string& bytes) { static_cast<void>(!send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL)); }

  void serve() {
    if (!wait(m_listening)) return;
    const int fd = accept(m_listening, nullptr, nullptr);
    std::string request;
    while (request.find("\r\n\r\n") == std::string::npos) {
      const std::string more = read_some(fd);
      if (more.empty()) break;
      request += more;
    }
    const std::string name = "Sec-WebSocket-Key: ";
    const std::size_t at = request.find(name);
    if (at != std::string::npos) {
      const std::string key = request.substr(at + name.size(), 24);
      say(fd,
          "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " +
              web_socket_answer(key) + "\r\n\r\n" + frame(m_answer("")));
      talk(fd);
    }
    close(fd);
  }
  void talk(int fd) {
    std::string bytes;
    while (!m_stop) {
      const std::string more = read_some(fd);
      if (more.empty()) return;
      bytes += more;
      while (bytes.size() >= 6) {  // masked frames with short or 16 bit lengths
        std::size_t size = std::uint8_t(bytes[1]) & 127, head = 6;
        if (size == 126) size = std::size_t(std::uint8_t(bytes[2])) << 8 | std::uint8_t(bytes[3]), head = 8;
        if (bytes.size() < head + size) break;
        std::string text = bytes.substr(head, size);
        for (std::size_t i = 0; i < size; ++i) text[i] = char(text[i] ^ bytes[head - 4 + i % 4]);
        const int opcode = std::uint8_t(bytes[0]) & 15;
        bytes.erase(0, head + size);
        if (opcode == 8) return;
        ++m_messages;
        say(fd, frame(m_answer(text)));
      }
    }
  }

  std::function<std::string(const std::string&)> m_answer;
  int m_listening = -1, m_port = 0;
  std::atomic<int> m_messages{0};
  std::atomic<bool> m_stop{false};
  std::thread m_thread;
};

}  // namespace trocar::devices
