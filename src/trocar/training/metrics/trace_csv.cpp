// A Trace as text that spreadsheets and scripts read (comment='#'):
//   # trocar trace 2                     version 1 has no person and no trial
//   # person Ada                         both may be missing
//   # trial 12
//   # rate_hz 50
//   # instrument grasper                 one line each, in order
//   # hand left_lateral shaft forces     or: roll-only, no-forces
//   # mark clipped left_lateral 1234     kind, hand, sample
//   t_s,left_lateral.x_m,...,scope.eye_x_m,...
//   0.02,...
// The comment lines come first. Numbers are plain decimals, without exponent.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/metrics/trace_channels.hpp>
#include <trocar/training/metrics/trace_csv.hpp>

namespace trocar::training {
namespace {

constexpr double kTimeScale = 1e6;
constexpr int kTimeDecimals = 6;
constexpr std::size_t kMaxFaults = 20, kMaxName = 200;
constexpr std::string_view kFirstLine = "# trocar trace 2", kFirstLineOf1 = "# trocar trace 1";

/// A name as it can stand in a column's name: without what separates or ends.
std::string plain(const std::string& name) {
  std::string result;
  for (const char c : name.substr(0, kMaxName))
    result += c > ' ' && c != ',' && c != '"' && c != '#' && c != 127 ? c : '_';
  return result.empty() ? "_" : result;
}

/// @param scope  how many of its channels there are
std::string column_names(const Trace& trace, std::size_t scope) {
  std::string line = "t_s";
  for (const TraceHand& hand : trace.hands)
    for (const auto& channel : kHandChannels) line += ',' + plain(hand.name) + '.' + channel.name;
  for (std::size_t c = 0; c < scope; ++c) line += std::string(",scope.") + kScopeChannels[c].name;
  return line;
}

template <class Sample, class Channels>
void append(std::string& text, const Sample& sample, const Channels& channels) {
  for (const auto& c : channels)
    fmt::format_to(std::back_inserter(text), ",{:.{}f}", value_of(steps_of(c.get(sample), c.scale), c.scale),
                   c.decimals);
}

std::string shown(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, 40)) result += c >= ' ' && c != 127 ? c : '?';
  return result + (text.size() > 40 ? "...'" : "'");
}

/// The whole number of steps that a plain decimal stands for; what is finer than a step is left out.
bool parse_steps(std::string_view text, int decimals, std::int64_t most, std::int64_t& steps) {
  std::size_t i = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (negative || (!text.empty() && text[0] == '+')) ++i;
  std::int64_t value = 0;
  int digits = 0, after = -1;  // digits behind the point; -1: no point yet
  for (; i < text.size(); ++i) {
    if (text[i] == '.' && after < 0) {
      after = 0;
      continue;
    }
    if (text[i] < '0' || text[i] > '9') return false;
    ++digits;
    if (after >= 0 && ++after > decimals) continue;
    value = value * 10 + (text[i] - '0');
    if (value > most) return false;
  }
  for (int d = after < 0 ? 0 : after; d < decimals; ++d) {
    value *= 10;
    if (value > most) return false;
  }
  steps = negative ? -value : value;
  return digits > 0;
}

class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& name) : m_text(text), m_name(name) {}

  const TraceOrigin& origin() const { return m_origin; }

  Trace read() {
    std::string_view line;
    bool named = false;
    while (m_faults.size() < kMaxFaults && next(line)) {
      if (m_line == 1) {
        if (line != kFirstLine && line != kFirstLineOf1) fault(1, tr("expected '{}', got {}", kFirstLine, shown(line)));
        if (!m_faults.empty()) break;
      } else if (!named && !line.empty() && line[0] == '#') {
        comment(line);
      } else if (!named) {
        columns(line);
        named = true;
        if (!m_faults.empty()) break;  // rows would not fit either
      } else if (!line.empty()) {
        row(line);
      }
    }
    if (m_line == 0) fault(1, tr("expected '{}', got an empty file", kFirstLine));
    if (!named && m_faults.empty()) fault(1, "expected a line of column names");
    if (!m_faults.empty()) throw core::BadInput(std::move(m_faults));
    return std::move(m_trace);
  }

 private:
  void fault(std::size_t column, const std::string& what) {
    m_faults.push_back({{m_name, m_line > 0 ? m_line : 1, int(column)}, what});
  }

  bool next(std::string_view& line) {
    if (m_at >= m_text.size()) return false;
    const std::size_t end = m_text.find('\n', m_at);
    line = m_text.substr(m_at, end == std::string_view::npos ? end : end - m_at);
    m_at = end == std::string_view::npos ? m_text.size() : end + 1;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++m_line;
    return true;
  }

  static std::vector<std::string_view> words_of(std::string_view line, char separator) {
    std::vector<std::string_view> words;
    for (std::size_t from = 0;;) {
      const std::size_t to = line.find(separator, from);
      words.push_back(line.substr(from, to == std::string_view::npos ? to : to - from));
      if (to == std::string_view::npos) return words;
      from = to + 1;
    }
  }

  void comment(std::string_view line) {
    const std::vector<std::string_view> words = words_of(line, ' ');
    const std::string_view what = words.size() > 1 ? words[1] : "";
    std::int64_t number = 0;
    if (what == "rate_hz" && words.size() == 3 && parse_steps(words[2], 6, 10'000'000'000, number) &&
        number >= 1'000'000)
      m_trace.rate = value_of(number, 1e6);
    else if (what == "person" && words.size() == 3)
      m_origin.person = words[2].substr(0, kMaxName);
    else if (what == "trial" && words.size() == 3)
      m_origin.trial = words[2].substr(0, kMaxName);
    else if (what == "instrument" && words.size() == 3 && m_trace.instruments.size() < kMaxTraceNames)
      m_trace.instruments.emplace_back(words[2].substr(0, kMaxName));
    else if (what == "hand" && words.size() == 5 && m_trace.hands.size() < kMaxTraceHands &&
             (words[3] == "shaft" || words[3] == "roll-only") && (words[4] == "forces" || words[4] == "no-forces"))
      m_trace.hands.push_back(
          {std::string(words[2].substr(0, kMaxName)), words[3] == "shaft", {}, words[4] == "forces"});
    else if (what == "mark" && words.size() == 5 && m_trace.marks.size() < kMaxTraceMarks)
      mark(words);
    else
      fault(1,
            "expected person NAME, trial NAME, rate_hz (1 to 10000), instrument NAME, hand NAME shaft|roll-only "
            "forces|no-forces, or mark KIND "
            "HAND SAMPLE "
            "(not too many), got " +
                shown(line));
  }

  void mark(const std::vector<std::string_view>& words) {
    TraceMark m;
    m.kind = TraceMark::kinds;
    for (int k = 0; k < TraceMark::kinds; ++k)
      if (words[2] == kMarkNames[k]) m.kind = TraceMark::Kind(k);
    m.hand = -1;
    for (std::size_t h = 0; h < m_trace.hands.size(); ++h)
      if (words[3] == plain(m_trace.hands[h].name)) m.hand = std::int32_t(h);
    std::int64_t sample = 0;
    if (m.kind == TraceMark::kinds || m.hand < 0 || !parse_steps(words[4], 0, kMaxTraceSamples, sample) || sample < 0)
      return fault(1, "expected a mark of a hand of the trace, at a sample");
    m.sample = std::uint32_t(sample);
    m_trace.marks.push_back(m);
  }

  void columns(std::string_view line) {
    const auto has = [line](std::string_view column) { return line.find(column) != std::string_view::npos; };
    m_scope = !has(",scope.eye_x_m") ? 0 : has(",scope.horizon") ? kScopeChannels.size() : kFirstScopeChannels;
    const std::string expected = column_names(m_trace, m_scope);
    if (line == expected) return;
    std::size_t same = 0;  // up to the first name that differs
    for (std::size_t i = 0; i < line.size() && i < expected.size() && line[i] == expected[i]; ++i)
      if (line[i] == ',') same = i + 1;
    const auto name_at = [&](std::string_view names) {
      return shown(names.substr(same, names.find(',', same) - same));
    };
    fault(same + 1, "expected the columns that the comments announce, " + name_at(expected) + ", got " + name_at(line));
  }

  void row(std::string_view line) {
    const std::vector<std::string_view> fields = words_of(line, ',');
    const std::size_t wanted = 1 + m_trace.hands.size() * kHandChannels.size() + m_scope;
    if (fields.size() != wanted) {
      ++m_rows;  // so that the next row's time is right
      return fault(1, tr("expected {} fields, got {}", wanted, fields.size()));
    }
    if (m_rows == kMaxTraceSamples) return fault(1, "expected at most four hours");
    std::size_t next_field = 0;
    const auto steps = [&](int decimals, std::int64_t most) {
      const std::string_view field = fields[next_field++];
      std::int64_t value = 0;
      if (!parse_steps(field, decimals, most, value))
        fault(std::size_t(field.data() - line.data()) + 1,
              "expected a decimal number, not too large, got " + shown(field));
      return value;
    };
    const double time = value_of(steps(kTimeDecimals, kMaxTraceSteps), kTimeScale);
    if (m_rows == 0) m_trace.start = time;
    if (std::fabs(time - m_trace.time(m_rows)) > 0.25 / m_trace.rate)
      fault(1, tr("expected the time {:.6f} s, as the rate says, got {}", m_trace.time(m_rows), shown(fields[0])));
    for (TraceHand& hand : m_trace.hands) {
      TraceSample s;
      for (const auto& c : kHandChannels) c.set(s, value_of(steps(c.decimals, c.most), c.scale));
      if (s.instrument < -1 || s.instrument >= std::int32_t(m_trace.instruments.size()))
        fault(1, "expected the number of an instrument of the trace");
      hand.samples.push_back(s);
    }
    if (m_scope > 0) {
      TraceScope s;
      for (std::size_t i = 0; i < m_scope; ++i) {
        const auto& c = kScopeChannels[i];
        c.set(s, value_of(steps(c.decimals, c.most), c.scale));
      }
      m_trace.scope.push_back(s);
    }
    ++m_rows;
  }

  std::string_view m_text;
  const std::string& m_name;
  std::size_t m_at = 0, m_rows = 0;
  int m_line = 0;
  std::size_t m_scope = 0;  ///< channels
  Trace m_trace;
  TraceOrigin m_origin;
  std::vector<core::Fault> m_faults;
};

}  // namespace

std::string to_csv(const Trace& trace, const TraceOrigin& origin) {
  std::string text = fmt::format("{}\n", kFirstLine);
  if (!origin.person.empty()) text += "# person " + plain(origin.person) + '\n';
  if (!origin.trial.empty()) text += "# trial " + plain(origin.trial) + '\n';
  text += fmt::format("# rate_hz {:.6f}\n", trace.rate);
  for (const std::string& name : trace.instruments) text += "# instrument " + plain(name) + '\n';
  for (const TraceHand& hand : trace.hands)
    text += "# hand " + plain(hand.name) + (hand.has_shaft ? " shaft" : " roll-only") +
            (hand.has_forces ? " forces\n" : " no-forces\n");
  for (const TraceMark& m : trace.marks)
    text +=
        fmt::format("# mark {} {} {}\n", kMarkNames[m.kind], plain(trace.hands[std::size_t(m.hand)].name), m.sample);
  text += column_names(trace, trace.scope.empty() ? 0 : kScopeChannels.size()) + '\n';
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const double time = trace.time(i);
    const bool nothing = time < 0 && time > -0.5 / kTimeScale;  // would be written as -0.000000
    fmt::format_to(std::back_inserter(text), "{:.{}f}", nothing ? 0.0 : time, kTimeDecimals);
    for (const TraceHand& hand : trace.hands) append(text, hand.samples[i], kHandChannels);
    if (!trace.scope.empty()) append(text, trace.scope[i], kScopeChannels);
    text += '\n';
  }
  return text;
}

std::string to_csv(const Trace& trace) { return to_csv(trace, TraceOrigin()); }

Trace trace_from_csv(std::string_view text, const std::string& name) { return CsvReader(text, name).read(); }

Trace trace_from_csv(std::string_view text, const std::string& name, TraceOrigin& origin) {
  CsvReader reader(text, name);
  Trace trace = reader.read();
  origin = reader.origin();
  return trace;
}

bool is_trace_csv(std::string_view text) {
  constexpr std::string_view kBegin = "# trocar trace";
  return text.substr(0, kBegin.size()) == kBegin;
}

}  // namespace trocar::training
