// A Trace as bytes, little-endian:
//   "TRCT", u32 format, f64 rate, f64 start, u32 instruments, a text each, u32 hands, a text and u8 (1 = has_shaft, 2 =
//   has_forces) each, u8 scope, u32 marks, (u32 kind, u32 hand, u32 sample) each, u32 samples, the columns: all samples
//   of one channel after the other, hands first, then the scope, u64 checksum (XXH3) of everything before.
// A text is u32 length and so many bytes. A column is whole numbers of steps; stored are differences of order 1 or 2,
// zigzag (0 -1 1 -2 .. as 0 1 2 3 ..) in 7-bit groups, lowest first, with bit 7 = more follows; a 0 is followed by the
// number of further zeros, at most 1023, so that stillness costs nothing and size stays bounded by the bytes there are.
#include <cstring>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/training/metrics/trace_channels.hpp>

namespace trocar::training {
namespace {

constexpr std::uint32_t kFormat = 2;  // 1 has no horizon
constexpr char kMagic[4] = {'T', 'R', 'C', 'T'};
constexpr std::size_t kMaxText = 200;
constexpr std::uint64_t kMaxRun = 1024;  // zeros that one entry stands for

// --- writing ---

class Writer {
 public:
  void integer(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) m_bytes.push_back(std::uint8_t(value >> (8 * i)));
  }
  void number(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    integer(bits, 8);
  }
  void text(const std::string& value) {
    const std::size_t size = value.size() < kMaxText ? value.size() : kMaxText;
    integer(size, 4);
    m_bytes.insert(m_bytes.end(), value.begin(), value.begin() + std::ptrdiff_t(size));
  }
  template <class Sample>
  void column(const std::vector<Sample>& samples, const TraceChannel<Sample>& channel) {
    std::uint64_t last = 0, before = 0, zeros = 0;
    for (const Sample& s : samples) {
      const auto now = std::uint64_t(steps_of(channel.get(s), channel.scale));
      const std::uint64_t foretold = channel.order == 2 ? 2 * last - before : last;
      before = last;
      last = now;
      if (now == foretold) {
        if (++zeros == kMaxRun) flush(zeros);
        continue;
      }
      flush(zeros);
      const auto difference = std::int64_t(now - foretold);
      groups((std::uint64_t(difference) << 1) ^ std::uint64_t(difference >> 63));
    }
    flush(zeros);
  }
  std::vector<std::uint8_t> finish() {
    integer(core::hash_bytes(m_bytes.data(), m_bytes.size()), 8);
    return std::move(m_bytes);
  }

 private:
  void groups(std::uint64_t value) {
    for (; value >= 128; value >>= 7) m_bytes.push_back(std::uint8_t(value | 128));
    m_bytes.push_back(std::uint8_t(value));
  }
  void flush(std::uint64_t& zeros) {
    if (zeros == 0) return;
    m_bytes.push_back(0);
    groups(zeros - 1);
    zeros = 0;
  }
  std::vector<std::uint8_t> m_bytes;
};

// --- reading ---

class BytesReader {
 public:
  BytesReader(std::span<const std::uint8_t> bytes, const std::string& name) : m_bytes(bytes), m_name(name) {}

  Trace read() {
    head();
    Trace trace;
    trace.rate = finite("a rate", 1, 10000);
    trace.start = finite("a start", -1e9, 1e9);
    const std::uint64_t instruments = count("instruments", kMaxTraceNames);
    for (std::uint64_t i = 0; i < instruments; ++i) trace.instruments.push_back(text());
    const std::uint64_t hands = count("hands", kMaxTraceHands);
    for (std::uint64_t h = 0; h < hands; ++h) {
      trace.hands.push_back({text(), true, {}});
      const std::uint64_t known = integer(1);
      if (known > 3) reject("expected 0 to 3 for what is known of a hand");
      trace.hands.back().has_shaft = (known & 1) != 0;
      trace.hands.back().has_forces = (known & 2) != 0;
    }
    const bool scope = integer(1) != 0;
    const std::uint64_t marks = count("marks", kMaxTraceMarks);
    for (std::uint64_t i = 0; i < marks; ++i) trace.marks.push_back(mark(hands));
    columns(trace, scope);
    if (m_at != m_bytes.size()) reject("expected the end");
    return trace;
  }

 private:
  [[noreturn]] void reject(const std::string& what) const {
    throw core::BadInput({{{m_name, 0, 0}, "byte " + std::to_string(m_at) + ": " + what}});
  }

  /// Magic, format and checksum; then the checksum's bytes are taken off.
  void head() {
    if (m_bytes.size() < 16 || std::memcmp(m_bytes.data(), kMagic, 4) != 0) reject("expected a motion trace");
    const std::span<const std::uint8_t> content = m_bytes.first(m_bytes.size() - 8);
    m_at = content.size();
    const std::uint64_t told = integer(8);
    if (told != core::hash_bytes(content.data(), content.size())) reject("damaged: wrong checksum");
    m_bytes = content;
    m_at = 4;
    const std::uint64_t format = integer(4);
    if (format != kFormat && format != 1) reject("expected format 1 or 2, got " + std::to_string(format));
    if (format == 1) m_scope_channels = kFirstScopeChannels;
  }

  std::uint64_t integer(int size) {
    if (m_bytes.size() - m_at < std::size_t(size)) reject("expected more bytes");
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i) value |= std::uint64_t(m_bytes[m_at++]) << (8 * i);
    return value;
  }
  double finite(const char* what, double low, double high) {
    const std::uint64_t bits = integer(8);
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!(value >= low && value <= high)) reject(std::string("expected ") + what + " that makes sense");
    return value;
  }
  std::uint64_t count(const char* what, std::uint64_t most) {
    const std::uint64_t value = integer(4);
    if (value > most)
      reject("expected at most " + std::to_string(most) + ' ' + what + ", got " + std::to_string(value));
    return value;
  }
  std::string text() {
    const std::uint64_t size = count("bytes of text", kMaxText);
    if (m_bytes.size() - m_at < size) reject("expected more bytes");
    std::string value(size, ' ');
    for (char& c : value) c = char(m_bytes[m_at++]);
    return value;
  }
  TraceMark mark(std::uint64_t hands) {
    TraceMark m;
    const std::uint64_t kind = integer(4), hand = integer(4);
    if (kind >= TraceMark::kinds || hand >= hands) reject("expected a mark of a hand of the trace");
    m.kind = TraceMark::Kind(kind);
    m.hand = std::int32_t(hand);
    const std::uint64_t sample = integer(4);
    if (sample > kMaxTraceSamples) reject("expected a mark at a sample");
    m.sample = std::uint32_t(sample);
    return m;
  }

  void columns(Trace& trace, bool scope) {
    const std::uint64_t samples = count("samples", kMaxTraceSamples);
    const std::uint64_t channels = trace.hands.size() * kHandChannels.size() + (scope ? m_scope_channels : 0);
    // Two bytes stand for at most kMaxRun values: nothing is allocated that the bytes cannot fill.
    if (samples * channels > (m_bytes.size() - m_at) * kMaxRun / 2) reject("expected more bytes for so many samples");
    if (channels == 0 && samples > 0) reject("expected no samples without hands and scope");
    for (TraceHand& hand : trace.hands) {
      hand.samples.resize(samples);
      for (const auto& channel : kHandChannels) column(hand.samples, channel);
      for (const TraceSample& s : hand.samples)
        if (s.instrument < -1 || s.instrument >= std::int32_t(trace.instruments.size()))
          reject("expected instruments of the trace");
    }
    if (scope) {
      trace.scope.resize(samples);
      for (std::size_t c = 0; c < m_scope_channels; ++c) column(trace.scope, kScopeChannels[c]);
    }
  }

  std::uint64_t groups() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint64_t byte = integer(1);
      value |= (byte & 127) << shift;
      if (byte < 128) return value;
    }
    reject("expected a number of at most 64 bits");
  }

  template <class Sample>
  void column(std::vector<Sample>& samples, const TraceChannel<Sample>& channel) {
    std::uint64_t last = 0, before = 0, zeros = 0;
    for (Sample& s : samples) {
      std::uint64_t difference = 0;
      if (zeros > 0) {
        --zeros;
      } else {
        const std::uint64_t code = groups();
        difference = (code >> 1) ^ (0 - (code & 1));
        if (code == 0) zeros = groups();
        if (zeros >= kMaxRun) reject("expected a shorter run of zeros");
      }
      const std::uint64_t now = (channel.order == 2 ? 2 * last - before : last) + difference;
      const auto steps = std::int64_t(now);
      if (steps > channel.most || steps < -channel.most)
        reject(std::string("expected ") + channel.name + " within bounds");
      before = last;
      last = now;
      channel.set(s, value_of(steps, channel.scale));
    }
    if (zeros > 0) reject("expected the run of zeros to end with the samples");
  }

  std::span<const std::uint8_t> m_bytes;
  const std::string& m_name;
  std::size_t m_at = 0, m_scope_channels = kScopeChannels.size();
};

}  // namespace

std::vector<std::uint8_t> to_bytes(const Trace& trace) {
  Writer w;
  for (const char c : kMagic) w.integer(std::uint8_t(c), 1);
  w.integer(kFormat, 4);
  w.number(trace.rate);
  w.number(trace.start);
  w.integer(trace.instruments.size(), 4);
  for (const std::string& name : trace.instruments) w.text(name);
  w.integer(trace.hands.size(), 4);
  for (const TraceHand& hand : trace.hands) {
    w.text(hand.name);
    w.integer((hand.has_shaft ? 1u : 0u) | (hand.has_forces ? 2u : 0u), 1);
  }
  w.integer(trace.scope.empty() ? 0 : 1, 1);
  w.integer(trace.marks.size(), 4);
  for (const TraceMark& m : trace.marks) {
    w.integer(std::uint64_t(m.kind), 4);
    w.integer(std::uint64_t(m.hand), 4);
    w.integer(m.sample, 4);
  }
  w.integer(trace.size(), 4);
  for (const TraceHand& hand : trace.hands)
    for (const auto& channel : kHandChannels) w.column(hand.samples, channel);
  if (!trace.scope.empty())
    for (const auto& channel : kScopeChannels) w.column(trace.scope, channel);
  return w.finish();
}

Trace trace_from_bytes(std::span<const std::uint8_t> bytes, const std::string& name) {
  return BytesReader(bytes, name).read();
}

}  // namespace trocar::training
