#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/rules/arguments.hpp>
#include <trocar/training/rules/condition.hpp>

namespace trocar::training {

using scene::JsonValue;

TriState Condition::holds(const Snapshot& snapshot) const { return holds(snapshot, nullptr); }
TriState Condition::would_hold(const Snapshot& snapshot, const EventInstance& h) const { return holds(snapshot, &h); }

TriState Condition::holds(const Snapshot& snapshot, const EventInstance* h) const {
  switch (m_kind) {
    case Kind::none:
      return TriState::yes;
    case Kind::fact:
      return m_test.of(h ? m_facts->foretold(m_watch, snapshot, *h) : m_facts->value(m_watch, snapshot));
    case Kind::step:
      return of_step(snapshot);
    case Kind::negation:
      return negated(m_parts[0].holds(snapshot, h));
    case Kind::all:
    case Kind::any:
      break;
  }
  const TriState decides = m_kind == Kind::all ? TriState::no : TriState::yes;
  TriState all = negated(decides);
  for (const Condition& part : m_parts) {
    const TriState t = part.holds(snapshot, h);
    if (t == decides) return t;
    if (t == TriState::unknown) all = t;
  }
  return all;
}

TriState Condition::of_step(const Snapshot& snapshot) const {
  const StepStatus& s = (*m_steps)[size_t(m_step)];
  const bool is = m_is == StepIs::done ? s.done : m_is == StepIs::missed ? s.missed : !s.done && !s.missed;
  if (!is || !m_since) return tri_state(is);
  return m_test.of(snapshot.now() - s.at);
}

namespace {

bool complete(const Fact& fact, const Arguments& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i)
    if (fact.parameters[i].needed && !arguments[i].given) return false;
  return true;
}

}  // namespace

FactAt read_fact(const JsonValue& v, std::vector<std::string> keys, const RuleReading& r) {
  const scene::JsonMember* name = v.find("fact");
  if (!name) {
    r.fault(v, "expected a fact, got " + scene::shown(v));
    return {};
  }
  const Fact* fact = find_fact(name->value.text);
  if (!fact) {
    std::vector<std::string> known;
    for (const Fact* f : facts()) known.emplace_back(f->name);
    r.fault(name->value, scene::unknown_name("fact", name->value.text, known));
    return {};
  }
  keys.insert(keys.begin(), "fact");
  for (const Parameter& p : fact->parameters) keys.emplace_back(p.name);
  r.check_keys(v, fmt::format("\"{}\"", fact->name), keys);
  const std::size_t before = r.faults->size();
  const Arguments arguments = read_arguments(v, fact->parameters, fact->name, r);
  if (r.model && !fact->lacks(*r.model).empty())
    r.fault(name->value, tr("expected a scene with {} for \"{}\", got none", fact->lacks(*r.model), fact->name));
  if (!r.model || !r.facts || r.faults->size() != before || !complete(*fact, arguments)) return {fact, -1};
  if (r.facts->all().size() >= kMostWatched) {
    r.fault(v, tr("expected at most {} facts that differ, got more", kMostWatched));
    return {fact, -1};
  }
  if (const std::string why = fact->refuses ? fact->refuses(*r.model, arguments) : std::string(); !why.empty()) {
    r.fault(v, why);
    return {fact, -1};
  }
  return {fact, r.facts->watch(*fact, arguments, *r.model)};
}

class ConditionReader {
 public:
  explicit ConditionReader(const RuleReading& reading) : r(reading) {}

  Condition read(const JsonValue& v) const {
    if (v.kind == JsonValue::Kind::broken || !r.has_room(v)) return {};
    if (v.kind == JsonValue::Kind::object) {
      if (v.find("fact")) return fact(v);
      if (v.find("step")) return step(v);
      if (v.find("all")) return joined(v, "all", Condition::Kind::all);
      if (v.find("any")) return joined(v, "any", Condition::Kind::any);
      if (v.find("not")) return negation(v);
    }
    r.fault(v, "expected a condition: an object with fact, step, all, any or not, got " + scene::shown(v));
    return {};
  }

 private:
  Condition fact(const JsonValue& v) const {
    Condition c;
    const FactAt at = read_fact(v, test_keys(), r);
    if (!at.fact) return c;
    const auto test = read_test(v, {at.fact->name, at.fact->low, at.fact->high, at.fact->is_truth, false}, r);
    if (at.watch < 0 || !test) return c;
    c.m_kind = Condition::Kind::fact;
    c.m_facts = r.facts;
    c.m_watch = at.watch;
    c.m_test = *test;
    return c;
  }

  Condition step(const JsonValue& v) const {
    Condition c;
    r.check_keys(v, "a step's condition", {"step", "is", "since_s"});
    c.m_step = read_step(v.find("step")->value, r);
    if (const scene::JsonMember* is = v.find("is")) {
      if (is->value.text == "missed")
        c.m_is = Condition::StepIs::missed;
      else if (is->value.text == "open")
        c.m_is = Condition::StepIs::open;
      else if (is->value.text != "done")
        r.fault(is->value, scene::unknown_name("state of a step", is->value.text, {"done", "missed", "open"}));
    }
    if (const scene::JsonMember* since = v.find("since_s")) {
      if (c.m_is == Condition::StepIs::open)
        r.fault(since->value, "expected the state done or missed of a step, got open");
      if (const auto test = read_short_test(since->value, {"since_s", 0, 36000, false, false}, r)) {
        c.m_test = *test;
        c.m_since = true;
      }
    }
    if (c.m_step < 0 || !r.steps) return {};
    c.m_kind = Condition::Kind::step;
    c.m_steps = r.steps;
    return c;
  }

  Condition joined(const JsonValue& v, const char* key, Condition::Kind kind) const {
    Condition c;
    c.m_kind = kind;
    r.check_keys(v, "a condition", {key, "for_each"});
    const JsonValue& list = v.find(key)->value;
    if (list.kind != JsonValue::Kind::array || list.items.empty()) {
      r.fault(list, "expected a list of conditions, got " + scene::shown(list));
      return {};
    }
    const scene::JsonMember* each = v.find("for_each");
    if (!each) {
      read_all(list, c);
      return c;
    }
    const Set* set = r.named->set(each->value.text);
    if (!set) {
      std::vector<std::string> known;
      for (const Set& s : r.named->sets()) known.push_back(s.name);
      r.fault(each->value, scene::unknown_name("set", each->value.text, known));
      return {};
    }
    for (const Element& e : set->elements) {
      const Names inner = r.named->at(*set, e);
      const RuleReading reading = r.within(inner);
      ConditionReader(reading).read_all(list, c);
    }
    return c;
  }
  void read_all(const JsonValue& list, Condition& c) const {
    for (const JsonValue& item : list.items) {
      if (r.is_full()) return;
      c.m_parts.push_back(read(item));
    }
  }

  Condition negation(const JsonValue& v) const {
    Condition c;
    c.m_kind = Condition::Kind::negation;
    r.check_keys(v, "a condition", {"not"});
    c.m_parts.push_back(read(v.find("not")->value));
    return c;
  }

  const RuleReading& r;
};

Condition read_condition(const JsonValue& value, const RuleReading& reading) {
  return ConditionReader(reading).read(value);
}

namespace {

/// "identify($side)" -> "identify", "left". @return false: a fault has been reported
bool split(const JsonValue& value, const RuleReading& r, std::string& step, std::string& element) {
  const std::size_t open = value.text.find('(');
  step = value.text.substr(0, open);
  element.clear();
  if (value.kind != JsonValue::Kind::string || step.empty() ||
      (open != std::string::npos && value.text.back() != ')')) {
    r.fault(value, "expected a step (\"stop\", \"identify($side)\"), got " + scene::shown(value));
    return false;
  }
  if (open == std::string::npos) return true;
  JsonValue name = value;
  name.text = value.text.substr(open + 1, value.text.size() - open - 2);
  const auto found = r.name(name);
  if (found) element = found->name;
  return found.has_value();
}

/// Which elements it has only the scene can tell.
bool waits_for_scene(const std::string& step, const RuleReading& r) {
  if (r.model) return false;
  const auto& sets = r.named->sets();
  const auto& steps = (*r.steps);
  return std::any_of(sets.begin(), sets.end(), [](const Set& s) { return s.pending; }) &&
         std::any_of(steps.begin(), steps.end(), [&step](const StepStatus& s) { return s.task == step; });
}

void unknown_step(const JsonValue& value, const std::string& step, const std::string& element, const RuleReading& r) {
  if (waits_for_scene(step, r)) return;
  std::vector<std::string> known;
  for (const StepStatus& s : (*r.steps)) {
    const std::string name = element.empty() ? s.task : s.side.empty() ? s.task : s.task + "(" + s.side + ")";
    if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  }
  r.fault(value, scene::unknown_name("step", element.empty() ? step : step + "(" + element + ")", known));
}

}  // namespace

int read_step(const JsonValue& value, const RuleReading& r) {
  std::string step, element;
  if (!split(value, r, step, element) || !r.steps) return -1;
  int found = -1, count = 0;
  for (int i = 0; i < int((*r.steps).size()); ++i) {
    const StepStatus& s = (*r.steps)[size_t(i)];
    if (s.task != step || (!element.empty() && s.side != element)) continue;
    found = i;
    ++count;
  }
  if (count == 1) return found;
  if (count > 1)
    r.fault(value, tr("expected one step, got {}: name one as \"{}(ELEMENT)\"", count, step));
  else
    unknown_step(value, step, element, r);
  return -1;
}

std::vector<int> read_steps(const JsonValue& value, const RuleReading& r) {
  std::vector<int> found;
  std::string step, element;
  if (!split(value, r, step, element) || !r.steps) return found;
  for (int i = 0; i < int((*r.steps).size()); ++i)
    if (const StepStatus& s = (*r.steps)[size_t(i)]; s.task == step && (element.empty() || s.side == element))
      found.push_back(i);
  if (found.empty()) unknown_step(value, step, element, r);
  return found;
}

}  // namespace trocar::training
