// As much of a web socket as it takes to speak with a service on the same machine: plain text messages, no extensions,
// no encryption.  [RFC 6455]
//
//   WebSocket socket;
//   if (const std::string fault = socket.connect(10001, "/", 2); !fault.empty()) ...
//   socket.send("...");                     // each waits for nothing
//   while (socket.receive(text)) ...
//
// What comes from the other side is bounded: messages up to 64 KiB, headers up to 4 KiB; whatever breaks the protocol
// ends the connection.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace trocar::devices {

/// base64 of SHA-1 of a key with the protocol's own text: what a server answers to it.
std::string web_socket_answer(std::string_view key);

/// Frames of the other side, byte by byte, to whole messages. No socket: for tests and fuzzing.
class FrameReader {
 public:
  static constexpr std::size_t kMostBytes = 65536;

  void add(std::string_view bytes) { m_bytes.append(bytes); }
  /// What came next. `ping` and `closed` have what they carried in `text`.
  enum class Got { nothing, message, ping, closed, fault };
  Got next(std::string& text);

 private:
  std::string m_bytes, m_message;
  bool m_begun = false;
};

/// A frame as clients send it, masked. @param opcode 1 text, 8 close, 10 pong; @param text at most kMostBytes
std::string client_frame(int opcode, std::string_view text, std::uint32_t mask);

class WebSocket {
 public:
  WebSocket() = default;
  ~WebSocket() { close(); }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  /// To 127.0.0.1. Waits for the service's answer. @param patience [s] @returns empty, or what went wrong
  std::string connect(int port, const std::string& path, double patience);
  bool connected() const noexcept { return m_socket >= 0; }
  /// False, and the connection is ended, where it cannot take it all now.
  bool send(std::string_view text) { return send_frame(1, text); }
  /// The next whole message; false where there is none yet, or the connection has ended.
  bool receive(std::string& text);
  void close() noexcept;

 private:
  bool send_frame(int opcode, std::string_view text);
  bool fill();

  int m_socket = -1;
  FrameReader m_reader;
  std::uint64_t m_mask = 0x9e3779b97f4a7c15ull;
};

}  // namespace trocar::devices
