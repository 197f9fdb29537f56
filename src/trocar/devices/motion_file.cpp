#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <string_view>

#include <trocar/core/tick.hpp>
#include <trocar/devices/motion_file.hpp>

namespace trocar::devices {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 256u << 20;
constexpr double kMaxMillimetres = 10'000, kMaxOther = 1000, kMaxMilliseconds = 1e12;
constexpr std::size_t kShownText = 40;

// --- the columns ---

enum Column { kOperator, kTrial, kTime, kFirstHand, kSubtask = kFirstHand + 10, kColumns };

struct ColumnName {
  const char* name;
  double limit;  // of the value's size; 0: text
};
constexpr std::array<ColumnName, kColumns> kNames = {{
    {"operator", 0},
    {"trial", 0},
    {"t_ms", kMaxMilliseconds},
    {"xL", kMaxMillimetres},
    {"yL", kMaxMillimetres},
    {"zL", kMaxMillimetres},
    {"rollL", kMaxOther},
    {"handleL", kMaxOther},
    {"xR", kMaxMillimetres},
    {"yR", kMaxMillimetres},
    {"zR", kMaxMillimetres},
    {"rollR", kMaxOther},
    {"handleR", kMaxOther},
    {"subtask", kMaxOther},
}};

struct Field {
  std::string_view text;
  int column = 1;  // 1-based, in the line
};

std::vector<Field> fields_of(std::string_view line) {
  std::vector<Field> fields;
  for (std::size_t start = 0;;) {
    const std::size_t comma = line.find(',', start);
    fields.push_back({line.substr(start, comma - start), int(start) + 1});
    if (comma == std::string_view::npos) return fields;
    start = comma + 1;
  }
}

/// What stands in the file, made fit for a message: short, without control characters.
std::string shown(std::string_view text) {
  std::string result = "\"";
  for (const char c : text.substr(0, kShownText)) result += c >= ' ' && c != 127 ? c : '?';
  return result + (text.size() > kShownText ? "...\"" : "\"");
}

/// A decimal number that fills `text`; words such as nan, and hexadecimal, are no numbers here.
bool parse_number(std::string_view text, double& value) {
  if (text.empty() || text.size() > 60 || text.find_first_not_of("0123456789+-.eE") != std::string_view::npos)
    return false;
  const std::string ended(text);
  char* end = nullptr;
  value = std::strtod(ended.c_str(), &end);
  return end == ended.c_str() + ended.size() && std::isfinite(value);
}

/// What is expected of a column where `value` is not it; empty when it is fit.
std::string unfit(int column, double value) {
  if (std::abs(value) > kNames[column].limit) return "within +-" + std::to_string(std::int64_t(kNames[column].limit));
  if (column == kSubtask && value != std::floor(value)) return "as a whole number";
  return {};
}

// --- the reader ---

class MotionReader {
 public:
  explicit MotionReader(const std::filesystem::path& path) : m_path(path) {}

  std::vector<MotionTrial> read() {
    std::ifstream file = open();
    return read(file);
  }

  std::vector<MotionTrial> read(std::istream& file) {
    std::string line;
    if (next(file, line)) header(line);
    if (m_line == 0) fault(1, 1, "expected a line of column names, got an empty file");
    while (!full() && next(file, line)) row(line);  // after a fault, to tell the others
    end_trial();
    if (m_faults.empty() && m_trials.empty()) fault(m_line, 1, "expected rows of motion after the column names");
    if (!m_faults.empty()) throw core::BadInput(std::move(m_faults));
    return std::move(m_trials);
  }

 private:
  std::ifstream open() const {
    std::error_code error;
    const bool regular = std::filesystem::is_regular_file(m_path, error);
    if (error) reject(error.message());
    if (!regular) reject("expected a motion file (CSV), this is not a regular file");
    if (std::filesystem::file_size(m_path, error) > kMaxFileBytes)
      reject("expected at most " + std::to_string(kMaxFileBytes >> 20) + " MiB");
    std::ifstream file(m_path, std::ios::binary);
    if (!file) reject(std::strerror(errno));
    return file;
  }

  [[noreturn]] void reject(const std::string& what) const {
    throw core::BadInput({core::Fault{core::Location{m_path.string(), 0, 0}, what}});
  }

  bool full() const { return int(m_faults.size()) >= kMaxMotionFaults; }

  void fault(int line, int column, const std::string& what) {
    if (full()) return;
    m_faults.push_back({core::Location{m_path.string(), line, column}, what});
    if (full()) m_faults.push_back({core::Location{m_path.string(), line, 0}, "too many faults, reading stopped"});
  }

  bool next(std::istream& file, std::string& line) {
    if (!std::getline(file, line)) return false;
    ++m_line;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  }

  void header(const std::string& line) {
    m_place.fill(-1);
    const std::vector<Field> fields = fields_of(line);
    m_fields = fields.size();
    for (std::size_t i = 0; i < fields.size(); ++i)
      for (int c = 0; c < kColumns; ++c) {
        if (fields[i].text != kNames[c].name) continue;
        if (m_place[c] >= 0) fault(1, fields[i].column, "column " + shown(fields[i].text) + " a second time");
        m_place[c] = int(i);
      }
    for (int c = 0; c < kColumns; ++c)
      if (m_place[c] < 0 && c != kSubtask)
        fault(1, 1, std::string("expected a column named ") + kNames[c].name + ", got " + shown(line));
    m_readable = m_faults.empty();
  }

  void row(const std::string& line) {
    if (line.empty() || !m_readable) return;
    const std::vector<Field> fields = fields_of(line);
    if (fields.size() != m_fields)
      return fault(m_line, 1, "expected " + std::to_string(m_fields) + " fields, got " + std::to_string(fields.size()));
    const std::string name =
        std::string(fields[m_place[kOperator]].text) + '/' + std::string(fields[m_place[kTrial]].text);
    if (m_trials.empty() || m_trials.back().name != name) begin_trial(name);
    std::array<double, kColumns> values{};
    if (numbers(fields, values)) add(values, fields[m_place[kTime]]);
  }

  /// All numbers of a row, each fault told.
  bool numbers(const std::vector<Field>& fields, std::array<double, kColumns>& values) {
    bool sound = true;
    for (int c = kTime; c < kColumns; ++c) {
      if (m_place[c] < 0) continue;
      const Field& field = fields[m_place[c]];
      const std::string wrong = parse_number(field.text, values[c]) ? unfit(c, values[c]) : "as a decimal number";
      if (wrong.empty()) continue;
      sound = false;
      fault(m_line, field.column,
            std::string("expected ") + kNames[c].name + ' ' + wrong + ", got " + shown(field.text));
    }
    return sound;
  }

  void begin_trial(const std::string& name) {
    end_trial();
    m_trial_line = m_line;
    m_faults_before = m_faults.size();
    if (!m_seen.insert(name).second)
      fault(m_line, 1, "expected the rows of trial " + shown(name) + " together, they begin a second time here");
    m_trials.push_back({name, {}});
  }

  void end_trial() {
    if (m_trials.empty() || m_faults.size() > m_faults_before) return;  // rows may be missing for a reason already told
    if (m_trials.back().samples.size() < 2)
      fault(m_trial_line, 1, "expected at least two rows of trial " + shown(m_trials.back().name));
  }

  void add(const std::array<double, kColumns>& values, const Field& time) {
    std::vector<MotionSample>& samples = m_trials.back().samples;
    if (samples.empty()) m_start = values[kTime];
    MotionSample sample;
    sample.time = (values[kTime] - m_start) / 1000;
    if (!samples.empty() && !(sample.time > samples.back().time))
      return fault(m_line, time.column, "expected a later time than in the row before, got " + shown(time.text));
    if (sample.time > kMaxMotionDuration)
      return fault(m_line, time.column,
                   "expected a trial of at most " + std::to_string(int(kMaxMotionDuration)) + " s, got a row at " +
                       shown(time.text) + " ms");
    for (int hand = 0; hand < 2; ++hand) {
      const double* from = &values[kFirstHand + 5 * hand];
      sample.hands[hand] = {{from[0] / 1000, from[1] / 1000, from[2] / 1000}, from[3], from[4]};
    }
    sample.subtask = int(values[kSubtask]);
    samples.push_back(sample);
  }

  std::filesystem::path m_path;
  std::array<int, kColumns> m_place{};  // of each column among a line's fields; -1: not there
  std::size_t m_fields = 0;
  bool m_readable = false;
  int m_line = 0, m_trial_line = 0;
  std::size_t m_faults_before = 0;  // the trial's rows
  double m_start = 0;               // the trial's first time [ms]
  std::vector<MotionTrial> m_trials;
  std::set<std::string> m_seen;
  std::vector<core::Fault> m_faults;
};

// --- the curve ---

template <std::size_t N>
using Vector = std::array<double, N>;

template <std::size_t N>
double dot(const Vector<N>& a, const Vector<N>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

/// Velocity at a row, from the velocities `a` before and `b` after it.
template <std::size_t N>
Vector<N> tangent(const Vector<N>& a, const Vector<N>& b) {
  const double speed_a = std::sqrt(dot(a, a)), speed_b = std::sqrt(dot(b, b));
  Vector<N> velocity{};
  if (!(speed_a > 0) || !(speed_b > 0)) return velocity;
  Vector<N> bisector;
  for (std::size_t i = 0; i < N; ++i) bisector[i] = a[i] / speed_a + b[i] / speed_b;
  const double length = std::sqrt(dot(bisector, bisector));  // 2 cos(turn / 2)
  if (!(length > 1e-9)) return velocity;
  const double half = length / 2, speed = 2 * speed_a * speed_b / (speed_a + speed_b) * (half * half * half * half);
  for (std::size_t i = 0; i < N; ++i) velocity[i] = bisector[i] * (speed / length);
  return velocity;
}

template <std::size_t N>
Vector<N> slope(const Vector<N>& from, const Vector<N>& to, double dt) {
  Vector<N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = (to[i] - from[i]) / dt;
  return result;
}

/// Velocity at `at`, where the motion comes from `before` and continues to `after`.
HandMotion velocity_at(const HandMotion& before, const HandMotion& at, const HandMotion& after, double dt_before,
                       double dt_after) {
  const auto scalar = [&](double p, double q, double r) {
    return tangent<1>({(q - p) / dt_before}, {(r - q) / dt_after})[0];
  };
  return {tangent(slope(before.tip, at.tip, dt_before), slope(at.tip, after.tip, dt_after)),
          scalar(before.roll, at.roll, after.roll), scalar(before.handle, at.handle, after.handle)};
}

/// Cubic Hermite weights at u in [0, 1] of an interval of length h.
struct Hermite {
  double p0, v0, p1, v1;
  Hermite(double u, double h)
      : p0((1 + 2 * u) * (1 - u) * (1 - u)),
        v0(h * u * (1 - u) * (1 - u)),
        p1(u * u * (3 - 2 * u)),
        v1(-h * u * u * (1 - u)) {}
  double operator()(double a, double da, double b, double db) const { return p0 * a + v0 * da + p1 * b + v1 * db; }
};

HandMotion blend(const Hermite& w, const HandMotion& a, const HandMotion& da, const HandMotion& b,
                 const HandMotion& db) {
  HandMotion result;
  for (int i = 0; i < 3; ++i) result.tip[i] = w(a.tip[i], da.tip[i], b.tip[i], db.tip[i]);
  result.roll = w(a.roll, da.roll, b.roll, db.roll);
  result.handle = w(a.handle, da.handle, b.handle, db.handle);
  return result;
}

double distance(const Vector<3>& a, const Vector<3>& b) {
  const Vector<3> d = slope(a, b, 1);
  return std::sqrt(dot(d, d));
}

}  // namespace

std::vector<MotionTrial> read_motion_file(const std::filesystem::path& path) { return MotionReader(path).read(); }
std::vector<MotionTrial> read_motion(std::istream& in, const std::string& name) { return MotionReader(name).read(in); }

MotionTrial read_motion_trial(const std::string& argument) {
  const std::size_t mark = argument.rfind('#');
  std::error_code error;
  const bool whole = mark == std::string::npos || std::filesystem::exists(argument, error);
  const std::string path = whole ? argument : argument.substr(0, mark);
  const std::string name = whole ? "" : argument.substr(mark + 1);
  if (path.empty())
    throw core::BadInput({core::Fault{core::Location{"motion:" + argument, 0, 0},
                                      "expected motion:FILE or motion:FILE#OPERATOR/TRIAL, got no file"}});
  std::vector<MotionTrial> trials = read_motion_file(path);
  if (name.empty()) return std::move(trials.front());
  std::string names;
  for (MotionTrial& trial : trials) {
    if (trial.name == name) return std::move(trial);
    names += ' ' + trial.name;
  }
  throw core::BadInput(
      {core::Fault{core::Location{path, 0, 0}, "no trial " + shown(name) + " in this file; there are:" + names}});
}

MotionBounds bounds_of(const MotionTrial& trial, Hand hand) {
  MotionBounds bounds;
  const HandMotion& first = trial.samples.front().hand(hand);
  bounds.low = bounds.high = first.tip;
  bounds.roll_low = bounds.roll_high = first.roll;
  bounds.handle_low = bounds.handle_high = first.handle;
  const double duration = trial.samples.back().time - trial.samples.front().time;
  for (std::size_t i = 0; i < trial.samples.size(); ++i) {
    const HandMotion& now = trial.samples[i].hand(hand);
    for (int k = 0; k < 3; ++k) {
      bounds.low[k] = std::min(bounds.low[k], now.tip[k]);
      bounds.high[k] = std::max(bounds.high[k], now.tip[k]);
    }
    bounds.roll_low = std::min(bounds.roll_low, now.roll), bounds.roll_high = std::max(bounds.roll_high, now.roll);
    bounds.handle_low = std::min(bounds.handle_low, now.handle);
    bounds.handle_high = std::max(bounds.handle_high, now.handle);
    if (i == 0) continue;
    const HandMotion& before = trial.samples[i - 1].hand(hand);
    const double share = (trial.samples[i].time - trial.samples[i - 1].time) / duration;
    for (int k = 0; k < 3; ++k) bounds.centroid[k] += share * (before.tip[k] + now.tip[k]) / 2;
    bounds.path_length += distance(before.tip, now.tip);
  }
  return bounds;
}

double closure(double handle, const MotionBounds& bounds) {
  const double range = bounds.handle_high - bounds.handle_low;
  if (!(range > 0)) return 0;
  return std::clamp((bounds.handle_high - handle) / range, 0.0, 1.0);
}

MotionCurve::MotionCurve(const MotionTrial& trial) {
  const std::vector<MotionSample>& s = trial.samples;
  m_knots.reserve(s.size());
  for (const MotionSample& sample : s) m_knots.push_back({sample, {}});
  for (std::size_t i = 1; i + 1 < s.size(); ++i)
    for (int hand = 0; hand < 2; ++hand)
      m_knots[i].velocity[hand] = velocity_at(s[i - 1].hands[hand], s[i].hands[hand], s[i + 1].hands[hand],
                                              s[i].time - s[i - 1].time, s[i + 1].time - s[i].time);
}

std::uint64_t MotionCurve::ticks() const {
  return std::uint64_t(std::ceil(duration() * double(core::kTicksPerSecond))) + 1;
}

MotionSample MotionCurve::at(double time) const {
  if (!(time > 0)) return m_knots.front().sample;
  if (time >= duration()) return m_knots.back().sample;
  const auto after = std::upper_bound(m_knots.begin(), m_knots.end(), time,
                                      [](double t, const Knot& knot) { return t < knot.sample.time; });
  const Knot &a = *(after - 1), &b = *after;
  const double h = b.sample.time - a.sample.time;
  const Hermite weights((time - a.sample.time) / h, h);
  MotionSample result{time, {}, a.sample.subtask};
  for (int hand = 0; hand < 2; ++hand)
    result.hands[hand] = blend(weights, a.sample.hands[hand], a.velocity[hand], b.sample.hands[hand], b.velocity[hand]);
  return result;
}

}  // namespace trocar::devices
