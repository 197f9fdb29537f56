#include <algorithm>
#include <cmath>

#include <trocar/devices/box/software_box.hpp>

namespace trocar::devices {
namespace {

constexpr std::size_t kMostWaiting = 15;  // blocks: seq distinguishes no more

/// The sum of twelve even numbers has variance 1.
double normal(core::Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

}  // namespace

SoftwareBox::SoftwareBox(const SoftwareBoxSettings& settings, Motion motion)
    : m_settings(settings), m_motion(std::move(motion)), m_random(settings.seed) {}

void SoftwareBox::hang_up() {
  m_queue.clear();
  m_requests.clear();
  m_line_free = 0;
  m_began = m_next_stream = kNever;
  m_fresh = true;
  m_mask = kAllBoxChannels;
}

void SoftwareBox::hear(std::span<const std::uint8_t> bytes, BoxTime now) {
  if (bytes.empty()) return;
  if (waits(now)) m_began += now - m_last_request;
  m_last_request = now;
  if (m_settings.raw) {
    for (std::size_t i = 0; i < bytes.size(); ++i) asked(std::uint8_t(m_last_seq + 1), now);
    return;
  }
  m_requests.feed(bytes, [&](const BoxRequest& request) {
    if (request.kind == BoxRequest::config) {
      m_mask = request.mask;
      m_fresh = false;
    } else {
      asked(request.seq, now);
    }
  });
}

bool SoftwareBox::waits(BoxTime now) const {
  return m_began != kNever && now - m_last_request > kStopped && !(m_settings.stream_rate > 0);
}

void SoftwareBox::asked(std::uint8_t seq, BoxTime now) {
  if (!(m_settings.stream_rate > 0)) return answer(seq, now);
  if (m_next_stream == kNever) m_next_stream = now;
}

/// Where the motion is when this request has come.
void SoftwareBox::advance_motion(std::uint8_t seq, BoxTime now) {
  if (m_began == kNever) {
    m_began = now;
    m_requests_heard = 0;
    m_last_seq = seq;
  }
  m_requests_heard += (seq - m_last_seq) & 15;  // also those that were lost on their way
  m_last_seq = seq;
  m_seconds =
      m_settings.per_request > 0 ? double(m_requests_heard) * m_settings.per_request : box_seconds(now - m_began);
}

BoxBlock SoftwareBox::measured() {
  BoxBlock block = m_motion(m_seconds);
  if (m_settings.noise > 0)
    for (std::uint16_t& code : block.codes)
      code = std::uint16_t(std::clamp(std::lround(code + m_settings.noise * normal(m_random)), 0l, long(kBoxTopCode)));
  return block;
}

void SoftwareBox::corrupt(std::vector<std::uint8_t>& bytes) {
  if (!(m_settings.corrupt > 0)) return;
  for (std::uint8_t& byte : bytes)
    if (m_random.uniform() < m_settings.corrupt) byte = std::uint8_t(byte ^ (1 + m_random.next() % 255));
}

void SoftwareBox::answer(std::uint8_t seq, BoxTime now) {
  advance_motion(seq, now);
  if (m_queue.size() >= kMostWaiting) return;
  DataFrame frame{measured(), m_mask, seq, 0};
  if (m_fresh) frame.flags |= kBoxFresh;
  if (m_requests.bad() != m_bad_seen) frame.flags |= kBoxBadRequest;
  if (m_settings.stream_rate > 0) frame.flags |= kBoxStreams;
  m_bad_seen = m_requests.bad();
  if (m_settings.drop > 0 && m_random.uniform() < m_settings.drop) {
    ++m_dropped;
    return;
  }
  Sending sending;
  sending.bytes.resize(m_settings.raw ? kRawBlockBytes : data_size(m_mask));
  if (m_settings.raw)
    pack(frame.block, kAllBoxChannels, sending.bytes);
  else
    write_data(frame, sending.bytes);
  corrupt(sending.bytes);
  const BoxTime asked = time_on_line(m_settings.raw ? 1 : kPollBytes, m_settings.baud);  // a pseudo-terminal takes none
  sending.start = std::max(m_line_free, now + asked + box_time(m_settings.turnaround));
  m_line_free = over(sending, sending.bytes.size());
  m_queue.push_back(std::move(sending));
}

BoxTime SoftwareBox::over(const Sending& sending, std::size_t bytes) const {
  return sending.start + time_on_line(bytes, m_settings.baud);
}

/// Blocks that nobody asks for, from the first request on.
void SoftwareBox::stream_until(BoxTime now) {
  while (m_next_stream <= now) {
    const BoxTime at = m_next_stream;
    answer(std::uint8_t(m_last_seq + 1), at);
    m_next_stream = at + box_time(1 / m_settings.stream_rate);
  }
}

std::size_t SoftwareBox::due(BoxTime now, std::span<std::uint8_t> out) {
  stream_until(now);
  const BoxTime left = now - box_time(m_settings.latency);
  std::size_t count = 0;
  while (!m_queue.empty() && count < out.size()) {
    Sending& sending = m_queue.front();
    if (over(sending, sending.sent + 1) > left) break;
    out[count++] = sending.bytes[sending.sent++];
    if (sending.sent < sending.bytes.size()) continue;
    m_queue.pop_front();
    ++m_sent;
  }
  return count;
}

BoxTime SoftwareBox::next_due() const {
  if (m_queue.empty()) return m_next_stream;
  return std::min(m_next_stream, over(m_queue.front(), m_queue.front().bytes.size()) + box_time(m_settings.latency));
}

}  // namespace trocar::devices
