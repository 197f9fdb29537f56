#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/events/event.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/rules/nearness.hpp>

namespace trocar::training {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string readable(std::string name) {
  constexpr std::string_view kTrace = ".trace";  // the whole of a tube, as who looks at it means it
  if (name.ends_with(kTrace)) name.resize(name.size() - kTrace.size());
  for (char& c : name)
    if (c == '_' || c == '.') c = ' ';
  for (const std::string_view side : {" left", " right"})  // "tube left": the left tube
    if (name.ends_with(side))
      return tr("the {} {}", side.substr(1), std::string_view(name).substr(0, name.size() - side.size()));
  return name;
}

std::string name_of(const sim::Model& model, ArgumentKind kind, int index) {
  switch (kind) {
    case ArgumentKind::hand:
      return model.hands[size_t(index)].name;
    case ArgumentKind::mark:
      return model.targets[size_t(index)].name;
    case ArgumentKind::vessel:
      return model.vessels.list[size_t(index)].name;
    case ArgumentKind::strand:
    case ArgumentKind::body: {
      const BodyId body = kind == ArgumentKind::strand ? BodyId::strand(size_t(index)) : BodyId::of_code(index);
      const std::string* name = name_of_body(model, body);
      return name ? *name : std::string();
    }
    default:
      return {};
  }
}

/// What the fact is about, in words: "left", "disc 3".
std::string subject_of(const FactWatches::Watched& watched, const sim::Model& model, const Names& names) {
  std::string out;
  for (std::size_t i = 0; i < watched.arguments.size(); ++i) {
    const Argument& a = watched.arguments[i];
    if (!a.given) continue;
    std::string name = a.index >= 0 ? name_of(model, watched.fact->parameters[i].kind, a.index) : std::string();
    if (watched.fact->parameters[i].kind == ArgumentKind::word) name = a.word;
    if (name.empty()) continue;
    out += (out.empty() ? "" : ", ") + readable(names.title_of(name));
  }
  return out;
}

std::string short_unit(const Unit& unit) {
  if (unit.suffix == "deg") return "\u00b0";
  if (unit.suffix == "C") return "\u00b0C";
  if (unit.suffix == "mm2") return "mm\u00b2";
  if (unit.suffix == "mL_min") return "mL/min";
  if (unit.suffix == "mm_s") return "mm/s";
  if (unit.suffix == "per_min") return "/min";
  if (unit.suffix == "N_s") return "N s";
  return std::string(unit.suffix);
}

/// How much of the way to its bounds a number has come.
double share_of(const Nearness& n) {
  if (n.fulfilled) return 1;
  if (!n.known || n.is_truth || n.outside) return 0;
  const double bound = n.value < n.low ? n.low : n.high, off = std::abs(n.value - bound);
  const double scale = std::max({std::abs(bound), std::isfinite(n.high - n.low) ? n.high - n.low : 0.0, 1e-9});
  if (n.value < n.low && n.low > 0) return std::clamp(n.value / n.low, 0.0, 0.99);
  return std::min(0.99, scale / (scale + off));
}

class NearnessReader {
 public:
  NearnessReader(const Snapshot& snapshot, const Names& names) : m_snapshot(snapshot), m_names(names) {}

  std::vector<Nearness> of(const Condition& c, bool negated) const {
    switch (c.kind()) {
      case Condition::Kind::none:
        return {};
      case Condition::Kind::fact:
        return {of_fact(c, negated)};
      case Condition::Kind::step:
        return of_step(c, negated);
      case Condition::Kind::negation:
        return of(c.parts()[0], !negated);
      case Condition::Kind::all:
      case Condition::Kind::any:
        break;
    }
    return (c.kind() == Condition::Kind::all) != negated ? joined(c, negated) : nearest(c, negated);
  }

 private:
  Nearness of_fact(const Condition& c, bool negated) const {
    const FactWatches::Watched& watched = c.facts()->all()[size_t(c.watch())];
    const FactWords& words = words_of(*watched.fact);
    const Value value = c.facts()->value(c.watch(), m_snapshot);
    const Test& test = c.test();
    Nearness n;
    n.fact = watched.fact;
    n.watch = c.watch();
    n.label = tr(words.label);
    n.subject = subject_of(watched, m_snapshot.model, m_names);
    n.known = value.known;
    n.is_truth = watched.fact->is_truth;
    n.fulfilled = test.of(value) == (negated ? TriState::no : TriState::yes);
    if (n.is_truth) {
      n.wanted = (test.low > 0) != negated;
      n.value = value.number;
    } else {
      in_units(n, value, test, unit_of(watched.fact->name), words.shown, negated);
    }
    n.share = share_of(n);
    return n;
  }

  static void in_units(Nearness& n, const Value& value, const Test& test, const Unit& unit, FactWords::Shown shown,
                       bool negated) {
    const bool percent = shown == FactWords::Shown::percent;
    const double factor = percent ? 100 : 1 / unit.si;
    n.unit = percent ? "%" : short_unit(unit);
    n.value = factor * value.number;
    n.low = factor * test.low;
    n.high = factor * test.high;
    if (test.of_size && std::isinf(n.low))
      n.low = -n.high;  // either sense counts alike
    else if (test.of_size)
      n.value = std::abs(n.value);
    if (!negated) return;
    if (std::isinf(n.low))
      n.low = n.high, n.high = kInfinite;
    else if (std::isinf(n.high))
      n.high = n.low, n.low = -kInfinite;
    else
      n.outside = true;
  }

  std::vector<Nearness> of_step(const Condition& c, bool negated) const {
    const StepStatus* step = c.needed_step();
    if (!step || negated) return {};  // that a step is still open is nothing to work for
    Nearness n;
    n.label = step->name;
    n.is_truth = n.known = true;
    n.fulfilled = step->done;
    n.share = n.value = step->done ? 1 : 0;
    return {n};
  }

  std::vector<Nearness> joined(const Condition& c, bool negated) const {
    std::vector<Nearness> rows;
    for (const Condition& part : c.parts())
      for (Nearness& row : of(part, negated)) add(rows, std::move(row));
    return rows;
  }

  /// A least and a most of the same fact are one row.
  static void add(std::vector<Nearness>& rows, Nearness row) {
    for (Nearness& other : rows) {
      if (row.watch < 0 || other.watch != row.watch || row.is_truth || row.outside || other.outside) continue;
      other.low = std::max(other.low, row.low);
      other.high = std::min(other.high, row.high);
      other.fulfilled = other.fulfilled && row.fulfilled;
      other.share = std::min(other.share, row.share);
      return;
    }
    rows.push_back(std::move(row));
  }

  /// Of alternatives the one that is nearest; where they are alike the first.
  std::vector<Nearness> nearest(const Condition& c, bool negated) const {
    std::vector<Nearness> best;
    double most = -1;
    for (const Condition& part : c.parts()) {
      std::vector<Nearness> rows = of(part, negated);
      double share = 0;
      for (const Nearness& row : rows) share += row.share;
      share /= std::max<double>(1, double(rows.size()));
      if (share <= most) continue;
      most = share;
      best = std::move(rows);
    }
    return best;
  }

  const Snapshot& m_snapshot;
  const Names& m_names;
};

/// What all rows are about stands in the step's title: only where they differ it is said.
void name_subjects(std::vector<Nearness>& rows) {
  const Nearness* first = nullptr;
  bool differ = false;
  for (const Nearness& row : rows) {
    if (row.subject.empty()) continue;
    if (first && first->subject != row.subject) differ = true;
    if (!first) first = &row;
  }
  if (!differ) return;
  for (Nearness& row : rows)
    if (!row.subject.empty()) row.label = tr("{}: {}", row.label, row.subject);
}

/// Rows of one fact, where there are several, as one: how many are fulfilled.
void count_alike(std::vector<Nearness>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].fact) continue;
    const auto alike = [&](const Nearness& r) { return r.fact == rows[i].fact; };
    const auto count = std::count_if(rows.begin(), rows.end(), alike);
    if (count < 2) continue;
    const auto done =
        std::count_if(rows.begin(), rows.end(), [&](const Nearness& r) { return alike(r) && r.fulfilled; });
    const Fact* const fact = rows[i].fact;
    rows[i] = counted(tr(words_of(*fact).label), double(done), double(count), "");
    rows.erase(std::remove_if(rows.begin() + std::ptrdiff_t(i) + 1, rows.end(),
                              [fact](const Nearness& r) { return r.fact == fact; }),
               rows.end());
  }
}

std::string number(double v) {
  const bool coarse = std::abs(v) >= 10 || std::abs(v - std::round(v)) < 0.05;
  const double shown = coarse ? std::round(v) : v;
  return fmt::format("{:.{}f}", shown == 0 ? 0.0 : shown, coarse ? 0 : 1);  // not "-0"
}

}  // namespace

Nearness counted(std::string label, double value, double least, std::string unit) {
  Nearness n;
  n.label = std::move(label);
  n.unit = std::move(unit);
  n.known = true;
  n.value = value;
  n.low = least;
  n.fulfilled = value >= least - 1e-9;
  n.share = share_of(n);
  return n;
}

std::string Nearness::target() const {
  if (is_truth) return {};
  const auto with_unit = [this](std::string range) { return unit.empty() ? range : range + " " + unit; };
  if (outside) return with_unit(tr("not {} to {}", number(low), number(high)));
  if (low == high) return with_unit(number(low));
  if (std::isinf(low)) return with_unit(tr("max {}", number(high)));
  if (std::isinf(high)) return with_unit(tr("min {}", number(low)));
  if (low == -high) return with_unit("\u00b1 " + number(high));
  return with_unit(tr("{} to {}", number(low), number(high)));
}

std::string Nearness::shown_value() const { return known ? number(value) : "-"; }

std::vector<Nearness> nearness(const Condition& condition, const Snapshot& snapshot, const Names& names) {
  std::vector<Nearness> rows = NearnessReader(snapshot, names).of(condition, false);
  name_subjects(rows);
  return rows;
}

std::vector<Nearness> in_short(std::vector<Nearness> rows, std::size_t most) {
  if (rows.size() <= most) return rows;
  count_alike(rows);
  for (std::size_t i = 0; i < rows.size() && rows.size() > most;)
    rows[i].fulfilled ? void(rows.erase(rows.begin() + std::ptrdiff_t(i))) : void(++i);
  if (rows.size() > most) rows.resize(most);
  return rows;
}

}  // namespace trocar::training
