#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/rules/names.hpp>

namespace trocar::training {
namespace {

using scene::JsonValue;
using Kind = JsonValue::Kind;

/// What a value stands for: itself, or what "$..." names.
struct Meaning {
  const JsonValue* value = nullptr;  ///< and the file that it stands in
  const std::string* file = nullptr;
  const Limit* limit = nullptr;
  const Set* set = nullptr;  ///< all of its elements, or that member of all
  std::string member;
};

bool is_reference(const JsonValue& v) { return v.kind == Kind::string && v.text.size() > 1 && v.text[0] == '$'; }

std::vector<std::string> referable(const Names& names) {
  std::vector<std::string> known;
  for (const Limit& l : names.limits()) known.push_back(l.name);
  for (const Set& s : names.sets()) known.push_back(s.name);
  return known;
}

std::vector<std::string> members_of(const Element& e) {
  std::vector<std::string> known;
  for (const scene::JsonMember& m : e.members.members) known.push_back(m.key);
  return known;
}

/// Nothing: a fault has been reported.
std::optional<Meaning> meaning(const JsonValue& v, const RuleReading& r) {
  if (v.kind == Kind::broken) return std::nullopt;
  if (!is_reference(v)) return Meaning{&v, r.file, nullptr, nullptr, {}};
  const std::size_t dot = v.text.find('.');
  const std::string name = v.text.substr(1, dot == std::string::npos ? dot : dot - 1);
  const std::string member = dot == std::string::npos ? "" : v.text.substr(dot + 1);
  const Set* set = r.named->set(name);
  if (set) {
    const Element* bound = r.named->bound(name);
    if (!bound) return Meaning{nullptr, &set->file, nullptr, set, member};
    const JsonValue* value = member.empty() ? &bound->self : bound->member(member);
    if (value) return Meaning{value, &set->file, nullptr, nullptr, {}};
    r.fault(v, scene::unknown_name("member of \"" + bound->name + "\"", member, members_of(*bound)));
    return std::nullopt;
  }
  if (const Limit* limit = member.empty() ? r.named->limit(name) : nullptr)
    return Meaning{nullptr, nullptr, limit, nullptr, {}};
  r.fault(v, scene::unknown_name("limit or set", name, referable(*r.named)));
  return std::nullopt;
}

std::optional<Interval> of_limit(const Limit& limit, const JsonValue& at, const Unit& unit, const RuleReading& r) {
  if (limit.broken) return std::nullopt;
  if (limit.unit().suffix == unit.suffix) return Interval{limit.si_low(), limit.si_high(), limit.is_range};
  r.fault(at, tr("expected a limit in the unit \"{}\" ({}), got \"{}\" ({})", unit.suffix, unit.words, limit.name,
                 limit.unit().words));
  return std::nullopt;
}

}  // namespace

Names::Names(Limits limits, Sets sets)
    : m_tables(std::make_shared<const Tables>(Tables{std::move(limits), std::move(sets)})) {}

Names Names::at(const Set& set, const Element& element) const {
  Names inner = *this;
  inner.m_bound.push_back({&set, &element});
  return inner;
}

const Element* Names::bound(std::string_view set) const {
  for (std::size_t i = m_bound.size(); i-- > 0;)
    if (m_bound[i].set->name == set) return m_bound[i].element;
  return nullptr;
}

std::string Names::text(const std::string& pattern) const {
  std::string out;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '{') {
      out += pattern[i];
      continue;
    }
    const std::size_t end = pattern.find('}', i);
    if (end == std::string::npos) return out.append(pattern, i);
    const std::string key = pattern.substr(i + 1, end - i - 1);
    if (const Limit* l = limit(key)) {
      out += l->shown();
    } else if (!m_bound.empty() && (key == "name" || key == "title" || key == "n" || key == "of")) {
      const Bound& b = m_bound.back();
      out += key == "name"    ? b.element->name
             : key == "title" ? b.element->title
             : key == "n"     ? std::to_string(b.element - b.set->elements.data() + 1)
                              : std::to_string(b.set->elements.size());
    } else {
      out += pattern.substr(i, end - i + 1);
    }
    i = end;
  }
  return out;
}

std::string Names::title_of(const std::string& name) const {
  for (const Set& s : sets())
    for (const Element& e : s.elements)
      if (e.name == name && e.title != name) return e.title;
  return name;
}

void RuleReading::fault(const JsonValue& value, std::string message) const {
  scene::tell(*faults, {at(value), std::move(message)});
}

bool RuleReading::is_full() const { return *parts > kMostParts || faults->size() > scene::kMaxFaults; }

bool RuleReading::has_room(const JsonValue& value, std::size_t count) const {
  if (is_full()) return false;
  *parts += count;
  if (*parts <= kMostParts) return true;
  fault(value, tr("expected at most {} conditions, names and skills, one for each element of their sets, got more",
                  kMostParts));
  return false;
}

std::string RuleReading::text(const JsonValue& value) const {
  constexpr std::size_t kBytesOfPart = 16;  // of a text, whose fields make it longer
  const bool read = value.kind == Kind::string && has_room(value, value.text.size() / kBytesOfPart);
  return read ? named->text(value.text) : std::string();
}

void RuleReading::check_keys(const JsonValue& object, const std::string& what,
                             const std::vector<std::string>& known) const {
  for (const scene::JsonMember& m : object.members)
    if (std::find(known.begin(), known.end(), m.key) == known.end())
      scene::tell(*faults, {{*file, m.line, m.column}, scene::unknown_name("key of " + what, m.key, known)});
}

std::optional<Interval> RuleReading::interval(const JsonValue& value, const Unit& unit) const {
  const std::optional<Meaning> m = meaning(value, *this);
  if (!m) return std::nullopt;
  if (m->limit) return of_limit(*m->limit, value, unit, *this);
  const JsonValue* v = m->value;
  if (v && v->kind == Kind::number) return Interval{v->number * unit.si, v->number * unit.si, false};
  if (v && v->kind == Kind::array && v->items.size() == 2) {
    RuleReading inner = *this;
    inner.file = m->file;
    const std::optional<double> from = inner.number(v->items[0], unit), to = inner.number(v->items[1], unit);
    if (!from || !to) return std::nullopt;
    if (*from <= *to) return Interval{*from, *to, true};
    fault(value, "expected [from, to] with from <= to, got an empty range");
    return std::nullopt;
  }
  fault(value, "expected a number, [from, to] or a limit (\"$...\"), got " + scene::shown(value));
  return std::nullopt;
}

std::optional<double> RuleReading::number(const JsonValue& value, const Unit& unit) const {
  const std::optional<Interval> i = interval(value, unit);
  if (!i) return std::nullopt;
  if (!i->is_range) return i->low;
  fault(value, "expected one number, got a range");
  return std::nullopt;
}

std::optional<double> RuleReading::number(const JsonValue& value, const Unit& unit, double low, double high) const {
  constexpr double kRounding = 1e-9;
  const std::optional<double> n = number(value, unit);
  if (!n || (*n >= low * unit.si - kRounding && *n <= high * unit.si + kRounding)) return n;
  fault(value, tr("expected a number in [{:g}, {:g}]{}{}, got {:g}", low, high, unit.suffix.empty() ? "" : " ",
                  unit.suffix, *n / unit.si));
  return std::nullopt;
}

std::vector<NameAt> RuleReading::names(const JsonValue& value) const {
  constexpr int kDeepest = 8;
  std::vector<NameAt> out;
  if (!has_room(value)) return out;
  if (depth > kDeepest) {
    fault(value, "expected names, got a set that contains itself");
    return out;
  }
  const std::optional<Meaning> m = meaning(value, *this);
  if (!m) return out;
  if (m->set) {
    for (const Element& e : m->set->elements) {
      const JsonValue* v = m->member.empty() ? &e.self : e.member(m->member);
      if (!v) {
        fault(value, scene::unknown_name("member of \"" + e.name + "\"", m->member, members_of(e)));
        continue;
      }
      RuleReading inner = *this;
      inner.file = m->file;
      ++inner.depth;
      for (NameAt& n : inner.names(*v)) out.push_back(std::move(n));
    }
    return out;
  }
  if (!m->value || (m->value->kind != Kind::string && m->value->kind != Kind::array)) {
    fault(value, "expected a name or a list of names, got " + scene::shown(value));
    return out;
  }
  RuleReading inner = *this;
  inner.file = m->file;
  ++inner.depth;
  if (m->value->kind == Kind::string) return {{m->value->text, inner.at(*m->value)}};
  for (const JsonValue& item : m->value->items)
    for (NameAt& n : inner.names(item)) out.push_back(std::move(n));
  return out;
}

std::optional<NameAt> RuleReading::name(const JsonValue& value) const {
  const std::size_t before = faults->size();
  std::vector<NameAt> all = names(value);
  if (all.size() == 1) return std::move(all[0]);
  if (is_full()) return std::nullopt;
  const std::optional<Meaning> m = faults->size() == before ? meaning(value, *this) : std::nullopt;
  if (m && !(m->set && m->set->pending)) fault(value, tr("expected one name, got {}", all.size()));
  return std::nullopt;
}

}  // namespace trocar::training
