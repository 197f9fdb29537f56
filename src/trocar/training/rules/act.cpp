#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/rules/act.hpp>
#include <trocar/training/rules/arguments.hpp>

namespace trocar::training {

using scene::JsonValue;

bool Cause::concerns(const sim::Model& model, const EventInstance& h) const {
  if (on == On::anything) return true;
  bool named = h.body.exists() && std::find(bodies.begin(), bodies.end(), h.body) != bodies.end();
  for (const int v : vessels) named = named || h.name == &model.vessels.list[size_t(v)].name;
  return named == (on == On::these);
}

bool Cause::matches(const Snapshot& snapshot, const EventInstance& h) const {
  if (!concerns(snapshot.model, h)) return false;
  for (const AttributeTest& a : attributes)
    if (a.test.of(a.attribute->value(snapshot, h)) != TriState::yes) return false;
  return while_true.holds(snapshot) == TriState::yes;
}

const Cause* Act::of(int event, const Snapshot& snapshot, const EventInstance& h) const {
  for (const Cause& c : m_causes)
    if (c.event == event && c.matches(snapshot, h)) return &c;
  return nullptr;
}

bool Act::possible() const {
  return std::any_of(m_causes.begin(), m_causes.end(), [](const Cause& c) {
    return c.on != Cause::On::these || !c.bodies.empty() || !c.vessels.empty();
  });
}

class ActReader {
 public:
  ActReader(Act& act, const RuleReading& reading) : m_act(act), r(reading) {}

  void read(const JsonValue& v) {
    if (v.kind == JsonValue::Kind::broken || !r.has_room(v)) return;
    if (v.kind == JsonValue::Kind::object && v.find("event")) return cause(v);
    const scene::JsonMember* any = v.kind == JsonValue::Kind::object ? v.find("any") : nullptr;
    if (!any || any->value.kind != JsonValue::Kind::array || any->value.items.empty())
      return r.fault(v, "expected an event, or any: [events], got " + scene::shown(v));
    r.check_keys(v, "an act", {"any"});
    for (const JsonValue& item : any->value.items) {
      if (r.is_full()) return;
      read(item);
    }
  }

 private:
  void cause(const JsonValue& v) {
    const JsonValue& name = v.find("event")->value;
    const EventKind* event = find_event(name.text);
    if (!event) {
      std::vector<std::string> known;
      for (const EventKind* e : event_kinds()) known.emplace_back(e->name);
      return r.fault(name, scene::unknown_name("event", name.text, known));
    }
    check_keys(v, *event);
    const std::size_t before = r.faults->size();
    const Arguments arguments = read_arguments(v, event->parameters, event->name, r);
    Cause c;
    attributes(v, *event, c);
    if (const scene::JsonMember* on = v.find("on")) bodies(on->value, *event, c);
    if (const scene::JsonMember* w = v.find("while")) c.while_true = read_condition(w->value, r);
    if (const scene::JsonMember* d = v.find("detail")) c.detail = r.text(d->value);
    if (r.model && !event->lacks(*r.model).empty())
      r.fault(name, tr("expected a scene with {} for \"{}\", got none", event->lacks(*r.model), event->name));
    if (r.events && r.events->all().size() >= kMostWatched)
      r.fault(v, tr("expected at most {} events that differ, got more", kMostWatched));
    if (r.model && r.events && r.faults->size() == before) c.event = r.events->watch(*event, arguments, *r.model);
    m_act.m_causes.push_back(std::move(c));
  }

  void check_keys(const JsonValue& v, const EventKind& event) const {
    std::vector<std::string> keys{"event", "while", "detail"};
    if (event.has_body) keys.emplace_back("on");
    for (const Parameter& p : event.parameters) keys.emplace_back(p.name);
    for (const Attribute& a : event.attributes) keys.emplace_back(a.name);
    r.check_keys(v, fmt::format("\"{}\"", event.name), keys);
  }

  void attributes(const JsonValue& v, const EventKind& event, Cause& c) const {
    for (const Attribute& a : event.attributes)
      if (const scene::JsonMember* m = v.find(a.name))
        if (const auto test = read_short_test(m->value, {a.name, a.low, a.high, a.is_truth, a.is_count}, r))
          c.attributes.push_back({&a, *test});
  }

  void bodies(const JsonValue& on, const EventKind& event, Cause& c) const {
    if (!event.has_body) return;  // told as an unknown key
    const scene::JsonMember* no = on.kind == JsonValue::Kind::object ? on.find("not") : nullptr;
    if (no) r.check_keys(on, "on", {"not"});
    c.on = no ? Cause::On::others : Cause::On::these;
    for (const NameAt& n : r.names(no ? no->value : on)) {
      if (!r.model) continue;
      std::int32_t index = -1;
      std::vector<std::string> known, vessels;
      if (find_named(*r.model, ArgumentKind::body, n.name, index, known)) {
        if (const BodyId body = BodyId::of_code(index); body.exists()) c.bodies.push_back(body);
      } else if (find_named(*r.model, ArgumentKind::vessel, n.name, index, vessels)) {
        c.vessels.push_back(index);
      } else {
        known.insert(known.end(), vessels.begin(), vessels.end());
        scene::tell(*r.faults, {n.at, scene::unknown_name("body of the scene", n.name, known)});
      }
    }
  }

  Act& m_act;
  const RuleReading& r;
};

Act read_act(const JsonValue& value, const RuleReading& reading) {
  Act act;
  ActReader(act, reading).read(value);
  return act;
}

}  // namespace trocar::training
