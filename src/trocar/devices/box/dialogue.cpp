#include <cstdlib>

#include <trocar/devices/box/dialogue.hpp>

namespace trocar::devices {
namespace {

// Longer than what adapters keep bytes back (16 ms with those that nobody has told otherwise).
constexpr BoxTime kSilence = 25'000'000;
constexpr BoxTime kTellAgain = 200'000'000;  // a CONFIG that had no effect
constexpr int kLeap = 1024;                  // codes
constexpr BoxTime kEarly = 1'000'000;        // a line may be so much faster than its name says

}  // namespace

bool unlikely_after(const BoxBlock& before, const BoxBlock& now, ChannelMask mask) noexcept {
  int leaps = 0;
  for (std::size_t i = 0; i < kBoxChannels; ++i)
    leaps += (mask >> i & 1) != 0 && std::abs(int(now.codes[i]) - int(before.codes[i])) > kLeap;
  return leaps >= 2;
}

BoxDialogue::BoxDialogue(const BoxDialogueSettings& settings)
    : m_settings(settings), m_silence(std::max(kSilence, 2 * time_on_line(kLongestData, settings.baud))) {
  if (!m_parser.expect(settings.mask)) m_settings.mask = kAllBoxChannels;
  m_asked.fill(kNotAsked);
}

void BoxDialogue::begin() noexcept {
  m_parser.clear();
  m_raw.clear();
  m_asked.fill(kNotAsked);
  m_number = m_answered = 0;
  m_heard_any = false;
  m_needs_config = true;
  m_told_any = false;
  m_told = m_last_asked = m_last_heard = m_last_looked = m_last_block = 0;
  m_wants_silence = false;
  m_trusts = true;
}

std::span<const std::uint8_t> BoxDialogue::ask(BoxTime now) noexcept {
  const std::span<std::uint8_t> out(m_out);
  std::size_t size = 0;
  if (m_wants_silence && !silent()) return {};
  m_wants_silence = false;
  ++m_number;
  ++m_counts.asked;
  m_asked[m_number % m_asked.size()] = m_last_asked = now;
  if (m_settings.raw) {
    out[size++] = kRawRequest;
    return out.first(size);
  }
  if (m_needs_config && (!m_told_any || now - m_told > kTellAgain)) {
    size = write_config(m_settings.mask, out);
    m_told = now;
    m_told_any = true;
    ++m_counts.configs;
  }
  size += write_poll(std::uint8_t(m_number), out.subspan(size));
  return out.first(size);
}

BoxTime BoxDialogue::next(BoxTime due) const noexcept {
  const std::size_t answer = m_settings.raw ? kRawBlockBytes : data_size(m_settings.mask);
  return std::max(due, m_last_asked + time_on_line(answer, m_settings.baud) + kBetweenBlocks);
}

/// Books block `number`, and those that are missing before it.
void BoxDialogue::number(std::uint64_t number, BoxPacket& packet) noexcept {
  if (m_heard_any && number > m_answered + 1) packet.missed = std::uint32_t(number - m_answered - 1);
  m_counts.missed += packet.missed;
  ++m_counts.blocks;
  m_answered = std::max(m_answered, number);
  m_heard_any = true;
  m_last_block = packet.arrived;
  m_counts.round_trip = packet.arrived - packet.acquired;
}

/// Nothing: an answer to what is not asked for now, as of another program before.
std::optional<BoxPacket> BoxDialogue::packet(const DataFrame& frame, BoxTime now) noexcept {
  BoxPacket packet{frame.block, frame.mask, 0, frame.flags, true, 0, now};
  m_needs_config = frame.mask != m_settings.mask || (frame.flags & kBoxFresh) != 0;
  packet.acquired = now - time_on_line(data_size(frame.mask), m_settings.baud);
  BoxTime& asked = m_asked[frame.seq];
  const bool answer = (frame.flags & kBoxStreams) == 0;
  if (answer && asked == kNotAsked) {
    ++m_unasked;
    return {};
  }
  if (answer) packet.acquired = std::min(now, asked + time_on_line(kPollBytes, m_settings.baud));
  asked = kNotAsked;
  // The newest poll with this seq; of a box that sends by itself, the block that follows the last one by as much.
  const std::uint64_t from = answer ? m_number : m_answered;
  const std::uint64_t number = answer ? from - ((from - frame.seq) & 15) : from + ((frame.seq - from) & 15);
  this->number(number, packet);
  return packet;
}

/// One that begins after a silence is; another, where it may follow the last one. Else the line is made to fall silent:
/// what comes then begins a block.
bool BoxDialogue::believed(const BoxBlock& block) noexcept {
  if (m_wants_silence || (!m_trusts && unlikely_after(m_before, block, m_settings.mask))) {
    ++m_unlikely;
    m_wants_silence = true;
    return false;
  }
  m_before = block;
  m_trusts = false;
  return true;
}

/// When the request was over that a raw block answers: the newest from which the line had time for it.
BoxTime BoxDialogue::raw_asked(BoxTime now) const noexcept {
  const BoxTime block = time_on_line(kRawBlockBytes, m_settings.baud), ask = time_on_line(1, m_settings.baud);
  for (std::uint64_t n = m_number; n > 0 && n + m_asked.size() > m_number; --n) {
    const BoxTime over = m_asked[n % m_asked.size()] + ask;
    if (over + block <= now + kEarly) return std::min(now, over);
  }
  return now - block;
}

BoxPacket BoxDialogue::raw_packet(const BoxBlock& block, BoxTime now) noexcept {
  BoxPacket packet{block, kAllBoxChannels, 0, 0, false, 0, now};
  packet.acquired = raw_asked(now);
  const BoxTime since = now - m_last_block;
  const auto blocks_ago = std::uint64_t(std::max<BoxTime>(1, (since + m_settings.period() / 2) / m_settings.period()));
  number(m_answered + (m_heard_any ? blocks_ago : 1), packet);
  return packet;
}

BoxCounts BoxDialogue::counts() const noexcept {
  BoxCounts counts = m_counts;
  counts.bad = m_settings.raw ? m_raw.counts().torn + m_unlikely : m_parser.counts().bad + m_unasked;
  counts.skipped = m_parser.counts().skipped;
  return counts;
}

}  // namespace trocar::devices
