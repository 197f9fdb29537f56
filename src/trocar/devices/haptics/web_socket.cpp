#include <array>
#include <chrono>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/random.hpp>
#include <trocar/devices/haptics/web_socket.hpp>

namespace trocar::devices {
namespace {

constexpr char kGuid[] = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // [RFC 6455 section 1.3]
constexpr std::size_t kMostHeader = 4096, kMostControl = 125;
constexpr int kContinued = 0, kClose = 8, kPing = 9, kPong = 10;

std::uint32_t turned(std::uint32_t x, int by) { return (x << by) | (x >> (32 - by)); }

/// One block of SHA-1.  [RFC 3174]
void add_block(std::array<std::uint32_t, 5>& h, const std::uint8_t* block) {
  std::array<std::uint32_t, 80> w{};
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t k = 0; k < 4; ++k) w[i] = (w[i] << 8) | block[4 * i + k];
  for (std::size_t i = 16; i < 80; ++i) w[i] = turned(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
  auto [a, b, c, d, e] = h;
  for (std::size_t i = 0; i < 80; ++i) {
    const std::uint32_t f = i < 20   ? (b & c) | (~b & d)
                            : i < 40 ? b ^ c ^ d
                            : i < 60 ? (b & c) | (b & d) | (c & d)
                                     : b ^ c ^ d;
    constexpr std::uint32_t kRound[] = {0x5a827999, 0x6ed9eba1, 0x8f1bbcdc, 0xca62c1d6};
    const std::uint32_t t = turned(a, 5) + f + e + kRound[i / 20] + w[i];
    e = d, d = c, c = turned(b, 30), b = a, a = t;
  }
  h[0] += a, h[1] += b, h[2] += c, h[3] += d, h[4] += e;
}

std::string sha1(std::string text) {
  const std::uint64_t bits = 8 * std::uint64_t(text.size());
  text.push_back(char(0x80));
  while (text.size() % 64 != 56) text.push_back(0);
  for (int i = 7; i >= 0; --i) text.push_back(char(bits >> (8 * i)));
  std::array<std::uint32_t, 5> h{0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476, 0xc3d2e1f0};
  for (std::size_t at = 0; at < text.size(); at += 64)
    add_block(h, reinterpret_cast<const std::uint8_t*>(text.data()) + at);
  std::string out;
  for (const std::uint32_t word : h)
    for (int i = 3; i >= 0; --i) out.push_back(char(word >> (8 * i)));
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = (three << 8) | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k <= bytes.size() ? kDigits[(three >> (18 - 6 * k)) & 63] : '=');
  }
  return out;
}

using Clock = std::chrono::steady_clock;

bool wait_until_ready(int socket, short what, Clock::time_point until) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
  pollfd p{socket, what, 0};
  return left > 0 && poll(&p, 1, int(left)) > 0 && (p.revents & (what | POLLHUP | POLLERR)) != 0;
}

/// Up to the empty line, byte by byte, so that nothing of the first message is taken.
std::string read_header(int socket, Clock::time_point until) {
  std::string header;
  while (header.size() < kMostHeader && header.find("\r\n\r\n") == std::string::npos) {
    char c = 0;
    const ssize_t n = recv(socket, &c, 1, 0);
    if (n == 1)
      header.push_back(c);
    else if (n == 0 || !wait_until_ready(socket, POLLIN, until))
      return {};
  }
  return header;
}

}  // namespace

std::string web_socket_answer(std::string_view key) { return base64(sha1(std::string(key) + kGuid)); }

// [RFC 6455 section 5.2]
FrameReader::Got FrameReader::next(std::string& text) {
  while (m_bytes.size() >= 2) {
    const auto byte = [this](std::size_t i) { return std::uint8_t(m_bytes[i]); };
    const bool last = (byte(0) & 0x80) != 0;
    const int opcode = byte(0) & 15;
    if ((byte(0) & 0x70) != 0 || (byte(1) & 0x80) != 0) return Got::fault;  // no extensions; servers do not mask
    std::uint64_t size = byte(1) & 127;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (m_bytes.size() < 2 + more) return Got::nothing;
    if (more > 0) size = 0;
    for (std::size_t i = 0; i < more; ++i) size = (size << 8) | byte(2 + i);
    const bool control = opcode >= kClose;
    if (size > kMostBytes || (control && (size > kMostControl || !last))) return Got::fault;
    if (m_bytes.size() < 2 + more + size) return Got::nothing;
    const std::string carried = m_bytes.substr(2 + more, std::size_t(size));
    m_bytes.erase(0, 2 + more + std::size_t(size));
    if (opcode == kPong) continue;
    if (control) {
      text = carried;
      return opcode == kPing ? Got::ping : opcode == kClose ? Got::closed : Got::fault;
    }
    if (opcode > 2 || (opcode == kContinued) != m_begun || m_message.size() + carried.size() > kMostBytes)
      return Got::fault;
    m_message += carried;
    m_begun = !last;
    if (!last) continue;
    text.swap(m_message);
    m_message.clear();
    return Got::message;
  }
  return Got::nothing;
}

std::string client_frame(int opcode, std::string_view text, std::uint32_t mask) {
  std::string frame;
  frame.push_back(char(0x80 | opcode));
  if (text.size() < 126) {
    frame.push_back(char(0x80 | int(text.size())));
  } else {
    const int bytes = text.size() < 65536 ? 2 : 8;
    frame.push_back(char(0x80 | (bytes == 2 ? 126 : 127)));
    for (int i = bytes - 1; i >= 0; --i) frame.push_back(char(std::uint64_t(text.size()) >> (8 * i)));
  }
  const char key[4] = {char(mask >> 24), char(mask >> 16), char(mask >> 8), char(mask)};
  frame.append(key, 4);
  for (std::size_t i = 0; i < text.size(); ++i) frame.push_back(char(text[i] ^ key[i % 4]));
  return frame;
}

std::string WebSocket::connect(int port, const std::string& path, double patience) {
  close();
  m_reader = {};
  const auto until =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience));
  m_socket = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto fail = [this](std::string why) {
    close();
    return why;
  };
  if (m_socket < 0 || ::connect(m_socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    return fail("nobody listens");
  const int on = 1;
  setsockopt(m_socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  fcntl(m_socket, F_SETFL, fcntl(m_socket, F_GETFL) | O_NONBLOCK);
  core::Random random(std::uint64_t(Clock::now().time_since_epoch().count()));  // so that no cache on the way answers
  m_mask = random.next();
  std::string key;
  for (int i = 0; i < 16; ++i) key.push_back(char(random.next() >> 40));
  key = base64(key);
  const std::string request = fmt::format(
      "GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: {}\r\nSec-WebSocket-Version: 13\r\n\r\n",
      path, port, key);
  if (::send(m_socket, request.data(), request.size(), MSG_NOSIGNAL) != ssize_t(request.size()))
    return fail("it takes nothing");
  const std::string header = read_header(m_socket, until);
  if (header.rfind("HTTP/1.1 101", 0) != 0)
    return fail(header.empty() ? "it does not answer" : "it is not a web socket");
  const std::string field = "sec-websocket-accept:";
  const std::size_t at = core::in_small_letters(header).find(field);
  if (at == std::string::npos) return fail("it is not a web socket");
  const std::size_t begin = header.find_first_not_of(' ', at + field.size()), end = header.find("\r\n", at);
  if (begin == std::string::npos || begin > end || header.substr(begin, end - begin) != web_socket_answer(key))
    return fail("it is not a web socket");
  return {};
}

bool WebSocket::send_frame(int opcode, std::string_view text) {
  if (m_socket < 0) return false;
  core::Random random(m_mask);
  m_mask = random.next();
  const std::string frame = client_frame(opcode, text, std::uint32_t(m_mask));
  if (::send(m_socket, frame.data(), frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == ssize_t(frame.size())) return true;
  ::close(m_socket);
  m_socket = -1;
  return false;
}

/// What has arrived so far. False: the other side has gone.
bool WebSocket::fill() {
  std::array<char, 8192> bytes;
  const ssize_t n = recv(m_socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (n > 0) m_reader.add({bytes.data(), std::size_t(n)});
  return n > 0 || (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
}

bool WebSocket::receive(std::string& text) {
  if (m_socket < 0) return false;
  const bool there = fill();
  for (;;) switch (m_reader.next(text)) {
      case FrameReader::Got::message:
        return true;
      case FrameReader::Got::ping:
        send_frame(kPong, text);
        break;
      case FrameReader::Got::nothing:
        if (!there) close();
        return false;
      default:
        close();
        return false;
    }
}

void WebSocket::close() noexcept {
  if (m_socket < 0) return;
  const std::string goodbye = client_frame(kClose, {}, 0);
  static_cast<void>(!::send(m_socket, goodbye.data(), goodbye.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  ::close(m_socket);
  m_socket = -1;
}

}  // namespace trocar::devices
