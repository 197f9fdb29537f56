#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/rules/test.hpp>

namespace trocar::training {
namespace {

using scene::JsonValue;
using Kind = JsonValue::Kind;

/// Passes nothing that lies in [least, most].
bool empty(const Test& t, double least, double most) {
  if (t.of_size) least = std::max(least, 0.0);
  return t.low > t.high || (t.low == t.high && (t.beyond_low || t.beyond_high)) || t.low > most ||
         (t.beyond_low && t.low >= most) || t.high < least || (t.beyond_high && t.high <= least);
}

/// The test, if something that the number can be passes it. Nothing: a fault has been reported.
std::optional<Test> possible(const Test& test, const JsonValue& at, const Tested& tested, const RuleReading& r) {
  constexpr double kAnything = std::numeric_limits<double>::infinity();
  const Unit& unit = unit_of(tested.name);
  const bool bounded = tested.low < tested.high;
  const double least = bounded ? tested.low * unit.si : -kAnything;
  const double most = bounded ? tested.high * unit.si : kAnything;
  if (!empty(test, least, most)) return test;
  r.fault(at, bounded ? tr("expected a possible value of \"{}\", {:g} to {:g}{}{}, got {}", tested.name, tested.low,
                           tested.high, unit.suffix.empty() ? "" : " ", unit.suffix, test.shown(unit, false))
                      : tr("expected possible values of \"{}\", got an empty range", tested.name));
  return std::nullopt;
}

class TestReader {
 public:
  TestReader(const JsonValue& object, const Tested& tested, const RuleReading& reading)
      : m_object(object), m_tested(tested), r(reading), m_unit(unit_of(tested.name)) {}

  std::optional<Test> read() {
    if (m_tested.is_truth) return truth_of();
    one("min", &Test::low, nullptr, false);
    one("above", &Test::low, &Test::beyond_low, false);
    one("max", &Test::high, nullptr, false);
    one("below", &Test::high, &Test::beyond_high, false);
    one("min_abs", &Test::low, nullptr, true);
    one("max_abs", &Test::high, nullptr, true);
    if (const scene::JsonMember* in = m_object.find("in")) range(in->value);
    if (const scene::JsonMember* is = m_object.find("is"))
      complain(is->value, tr("expected min, max, above, below or in for the number \"{}\", got is", m_tested.name));
    if (m_bad) return std::nullopt;
    if (!m_said) {
      complain(m_object, tr("expected a bound for \"{}\" (min, max, above, below, in), got none", m_tested.name));
      return std::nullopt;
    }
    return possible(m_test, m_object, m_tested, r);
  }

 private:
  void complain(const JsonValue& at, std::string message) {
    r.fault(at, std::move(message));
    m_bad = true;
  }

  std::optional<Test> truth_of() {
    for (const std::string& key : test_keys())
      if (const scene::JsonMember* m = m_object.find(key); m && key != "is")
        complain(m->value,
                 tr("expected is: true or false for \"{}\", which is true or false, got {}", m_tested.name, key));
    const scene::JsonMember* is = m_object.find("is");
    if (is && is->value.kind != Kind::boolean)
      complain(is->value, "expected true or false, got " + scene::shown(is->value));
    if (m_bad) return std::nullopt;
    const bool wanted = !is || is->value.truth;
    m_test.low = wanted ? 0.5 : -0.5;
    m_test.high = m_test.low + 1;
    return m_test;
  }

  void one(const char* key, double Test::*bound, bool Test::*beyond, bool of_size) {
    const scene::JsonMember* m = m_object.find(key);
    if (!m) return;
    m_said = true;
    m_test.of_size = m_test.of_size || of_size;
    const std::optional<double> n = r.number(m->value, m_unit);
    if (!n) {
      m_bad = true;
      return;
    }
    if (std::isfinite(m_test.*bound)) complain(m->value, tr("expected one bound on this side, got {} too", key));
    m_test.*bound = *n;
    if (beyond) m_test.*beyond = true;
  }

  void range(const JsonValue& value) {
    const std::optional<Interval> i = r.interval(value, m_unit);
    if (!i) {
      m_bad = true;
      return;
    }
    if (m_said) complain(value, "expected in alone, got min, max, above or below too");
    m_said = true;
    m_test.low = i->low;
    m_test.high = i->high;
  }

  const JsonValue& m_object;
  const Tested& m_tested;
  const RuleReading& r;
  const Unit& m_unit;
  Test m_test;
  bool m_said = false, m_bad = false;
};

}  // namespace

std::string Test::shown(const Unit& unit, bool is_truth) const {
  if (is_truth) return low > 0 ? "yes" : "no";
  const double from = low / unit.si, to = high / unit.si;
  if (low == high) return fmt::format("{:g}", from);
  if (std::isinf(low)) return fmt::format("{} {:g}", beyond_high ? "less than" : "at most", to);
  if (std::isinf(high)) return fmt::format("{} {:g}", beyond_low ? "more than" : "at least", from);
  return fmt::format("{:g} to {:g}", from, to);
}

const std::vector<std::string>& test_keys() {
  static const std::vector<std::string> keys{"min", "max", "above", "below", "in", "min_abs", "max_abs", "is"};
  return keys;
}

std::optional<Test> read_test(const JsonValue& object, const Tested& tested, const RuleReading& reading) {
  return TestReader(object, tested, reading).read();
}

std::optional<Test> read_short_test(const JsonValue& value, const Tested& tested, const RuleReading& r) {
  if (value.kind == Kind::broken) return std::nullopt;
  if (value.kind == Kind::object) {
    r.check_keys(value, fmt::format("\"{}\"", tested.name), test_keys());
    return read_test(value, tested, r);
  }
  Test test;
  if (tested.is_truth) {
    if (value.kind == Kind::boolean) {
      test.low = value.truth ? 0.5 : -0.5;
      test.high = test.low + 1;
      return test;
    }
    r.fault(value, tr("expected true or false for \"{}\", got {}", tested.name, scene::shown(value)));
    return std::nullopt;
  }
  const std::optional<Interval> i = r.interval(value, unit_of(tested.name));
  if (!i) return std::nullopt;
  if (!i->is_range && !tested.is_count) {
    r.fault(value,
            tr("expected a range, or {{\"min\": ...}} or {{\"max\": ...}} for \"{}\", got one number", tested.name));
    return std::nullopt;
  }
  test.low = i->low;
  test.high = i->high;
  return possible(test, value, tested, r);
}

}  // namespace trocar::training
