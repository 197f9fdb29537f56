#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sodium.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/attempt/team/sealed_link.hpp>
#include <trocar/core/error.hpp>

namespace trocar::attempt {
namespace {

constexpr std::array<unsigned char, 8> kGreeting = {'T', 'R', 'O', 'C', 'A', 'R', '-', '1'};
constexpr std::size_t kHello = kGreeting.size() + 32, kTag = crypto_aead_chacha20poly1305_ietf_ABYTES;
constexpr std::size_t kPiece = 1 << 16;

void need_sodium() {
  if (sodium_init() < 0) throw core::EnvironmentLacks("libsodium cannot start: this machine gives no random numbers");
}

std::array<unsigned char, crypto_aead_chacha20poly1305_ietf_NPUBBYTES> nonce_of(std::uint64_t number) {
  std::array<unsigned char, crypto_aead_chacha20poly1305_ietf_NPUBBYTES> nonce{};
  for (std::size_t i = 0; i < 8; ++i) nonce[i] = static_cast<unsigned char>(number >> (8 * i));
  return nonce;
}

}  // namespace

SealedLink::SealedLink(int socket, Side side, const std::string& token) : m_socket(socket), m_side(side) {
  need_sodium();
  fcntl(m_socket, F_SETFL, fcntl(m_socket, F_GETFL, 0) | O_NONBLOCK);
  const int on = 1;
  setsockopt(m_socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  crypto_generichash(m_token.data(), m_token.size(), reinterpret_cast<const unsigned char*>(token.data()), token.size(),
                     nullptr, 0);
  randombytes_buf(m_random.data(), m_random.size());
  m_out.insert(m_out.end(), kGreeting.begin(), kGreeting.end());
  m_out.insert(m_out.end(), m_random.begin(), m_random.end());
}

SealedLink::~SealedLink() { close("closed"); }

void SealedLink::close(const std::string& why) {
  if (m_socket < 0) return;
  ::close(m_socket);
  m_socket = -1;
  m_why = why;
}

void SealedLink::exchange() {
  if (open()) receive();
  if (open()) transmit();
}

void SealedLink::send(core::ByteView message) {
  if (!open()) return;
  if (message.size() > kLargestMessage) return close("a message is too long");
  if (!m_keyed) {
    m_waiting.emplace_back(message.begin(), message.end());
    return;
  }
  if (m_out.size() - m_sent > kLargestBacklog) return close("the other side no longer receives");
  const std::size_t size = message.size() + kTag;
  core::put(m_out, std::uint32_t(size));
  const std::size_t at = m_out.size();
  m_out.resize(at + size);
  const auto nonce = nonce_of(m_sealed++);
  crypto_aead_chacha20poly1305_ietf_encrypt(m_out.data() + at, nullptr, message.data(), message.size(), nullptr, 0,
                                            nullptr, nonce.data(), m_seal.data());
}

bool SealedLink::take(core::ByteString& message) {
  if (m_messages.empty()) return false;
  message = std::move(m_messages.front());
  m_messages.pop_front();
  return true;
}

void SealedLink::receive() {
  std::array<unsigned char, kPiece> piece;
  // One who sends without end does not keep the others waiting.
  for (int pieces = 0; pieces < 16; ++pieces) {
    const ssize_t got = ::recv(m_socket, piece.data(), piece.size(), 0);
    if (got > 0) {
      m_in.insert(m_in.end(), piece.begin(), piece.begin() + got);
      open_messages();
      if (!open()) return;
      continue;
    }
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (got < 0 && errno == EINTR) continue;
    return close(got == 0 ? "the other side has disconnected" : std::strerror(errno));
  }
}

void SealedLink::transmit() {
  while (m_sent < m_out.size()) {
    const ssize_t put = ::send(m_socket, m_out.data() + m_sent, m_out.size() - m_sent, MSG_NOSIGNAL);
    if (put > 0) {
      m_sent += std::size_t(put);
      continue;
    }
    if (put < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
    if (put < 0 && errno == EINTR) continue;
    return close(std::strerror(errno));
  }
  m_out.erase(m_out.begin(), m_out.begin() + std::ptrdiff_t(m_sent));
  m_sent = 0;
}

/// One key a direction, of the token and what both sides drew.
void SealedLink::derive(const unsigned char* theirs) {
  const bool host = m_side == Side::host;
  const unsigned char *of_host = host ? m_random.data() : theirs, *of_member = host ? theirs : m_random.data();
  const auto key = [&](unsigned char direction, Key& to) {
    crypto_generichash_state state;
    crypto_generichash_init(&state, m_token.data(), m_token.size(), to.size());
    crypto_generichash_update(&state, &direction, 1);
    crypto_generichash_update(&state, of_host, 32);
    crypto_generichash_update(&state, of_member, 32);
    crypto_generichash_final(&state, to.data(), to.size());
  };
  key('h', host ? m_seal : m_opener);
  key('m', host ? m_opener : m_seal);
  m_keyed = true;
  for (const core::ByteString& message : m_waiting) send(message);
  m_waiting.clear();
}

void SealedLink::open_messages() {
  std::size_t at = 0;
  if (!m_keyed) {
    if (m_in.size() < kHello) return;
    if (!std::equal(kGreeting.begin(), kGreeting.end(), m_in.begin()))
      return close("the other side is not Trocar of this version");
    derive(m_in.data() + kGreeting.size());
    at = kHello;
  }
  while (open() && m_in.size() - at >= 4) {
    core::ByteReader head(core::ByteView(m_in).subspan(at, 4));
    const std::size_t size = head.get<std::uint32_t>();
    if (size < kTag || size > kLargestMessage + kTag) return close("an invalid message was received");
    if (m_in.size() - at - 4 < size) break;
    core::ByteString message(size - kTag);
    const auto nonce = nonce_of(m_received);
    if (crypto_aead_chacha20poly1305_ietf_decrypt(message.data(), nullptr, nullptr, m_in.data() + at + 4, size, nullptr,
                                                  0, nonce.data(), m_opener.data()) != 0)
      return close("the tokens differ");
    ++m_received;
    m_messages.push_back(std::move(message));
    at += 4 + size;
  }
  m_in.erase(m_in.begin(), m_in.begin() + std::ptrdiff_t(at));
}

std::string random_token() {
  need_sodium();
  static constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz234567";
  std::string token(26, ' ');
  for (char& c : token) c = kLetters[randombytes_uniform(32)];
  return token;
}

}  // namespace trocar::attempt
