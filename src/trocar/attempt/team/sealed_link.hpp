// Messages between two programs that know the same token, over TCP: nobody else can read, change, repeat or add one.
// Both sides send 32 random bytes; token and both give a key for each direction (BLAKE2b); a message is a length, and
// its bytes sealed with that key and their number as nonce (ChaCha20-Poly1305, libsodium). Who has not the token cannot
// make a first message that opens, and is cut off without an answer.
//
//   SealedLink link(socket, SealedLink::Side::host, token);
//   link.exchange();                                  // when poll() says that the socket may be read, or written
//   link.send(bytes);                                 // goes out with the next exchange()
//   while (link.take(bytes)) ...
//   if (!link.open()) link.why();
#pragma once

#include <array>
#include <deque>
#include <string>

#include <trocar/core/byte_code.hpp>

namespace trocar::attempt {

inline constexpr std::size_t kLargestMessage = 1 << 20;   ///< [bytes]
inline constexpr std::size_t kLargestBacklog = 64 << 20;  ///< [bytes] not yet taken by the other side

class SealedLink {
 public:
  enum class Side { host, member };
  /// Owns the socket, which does not block from now on.
  SealedLink(int socket, Side side, const std::string& token);
  ~SealedLink();
  SealedLink(const SealedLink&) = delete;
  SealedLink& operator=(const SealedLink&) = delete;

  /// Takes what has come and sends what can go without waiting.
  void exchange();
  void send(core::ByteView message);
  bool take(core::ByteString& message);

  bool open() const { return m_socket >= 0; }
  /// A message of the other side has opened: it has the token.
  bool trusted() const { return m_received > 0; }
  bool wants_to_write() const { return m_sent < m_out.size(); }
  int socket() const { return m_socket; }
  const std::string& why() const { return m_why; }  ///< it closed
  void close(const std::string& why);

 private:
  using Key = std::array<unsigned char, 32>;
  void receive();
  void transmit();
  void open_messages();
  void derive(const unsigned char* theirs);

  int m_socket;
  Side m_side;
  Key m_token{}, m_seal{}, m_opener{};
  std::array<unsigned char, 32> m_random{};
  bool m_keyed = false;
  std::uint64_t m_sealed = 0, m_received = 0;  ///< messages
  core::ByteString m_in, m_out;
  std::size_t m_sent = 0;                  ///< of m_out
  std::deque<core::ByteString> m_waiting;  ///< to be sealed once there are keys
  std::deque<core::ByteString> m_messages;
  std::string m_why;
};

/// 26 letters and digits by chance (130 bits): what to tell the others.
std::string random_token();

}  // namespace trocar::attempt
