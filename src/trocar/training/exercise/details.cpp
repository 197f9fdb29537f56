#include <algorithm>

#include <trocar/core/json.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/exercise/details.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {
namespace {

using scene::JsonValue;

constexpr std::size_t kMostDone = 128;  // of acts that are reported; a State's buffers hold fewer clips and cuts

Json number(double si, std::string_view name, bool is_truth) {
  if (is_truth) return si != 0;
  return si / unit_of(name).si;
}

}  // namespace

void Details::read(const Part& part, const RuleReading& outer) {
  RuleReading r = outer;
  r.file = &part.file;
  const scene::JsonMember* each = part.value.find("for_each");
  if (!each) return read_one(part.value, "", r);
  const Set* set = r.named->set(each->value.text);
  if (!set) {
    std::vector<std::string> known;
    for (const Set& s : r.named->sets()) known.push_back(s.name);
    return r.fault(each->value, scene::unknown_name("set", each->value.text, known));
  }
  for (const Element& e : set->elements) {
    const Names names = r.named->at(*set, e);
    read_one(part.value, e.name, r.within(names));
  }
}

void Details::read_one(const JsonValue& v, const std::string& side, const RuleReading& r) {
  const scene::JsonMember *name = v.find("detail"), *value = v.find("value"), *keep = v.find("keep"),
                          *w = v.find("while");
  if (!name || !value || !r.has_room(v)) return;  // told
  Told t;
  t.name = name->value.text;
  t.side = side;
  const FactAt at = read_fact(value->value, {}, r);
  t.fact = at.fact;
  t.watch = at.watch;
  t.facts = r.facts;
  if (at.fact && unit_of(t.name).suffix != unit_of(at.fact->name).suffix)
    r.fault(name->value, "expected a name in the unit of \"" + std::string(at.fact->name) + "\", got another");
  if (w) t.while_true = read_condition(w->value, r);
  if (keep && keep->value.text == "most") t.keep = Keep::most;
  if (keep && keep->value.text == "range") t.keep = Keep::range;
  if (t.watch >= 0) m_told.push_back(std::move(t));
}

void Details::sample(const Snapshot& snapshot) {
  for (Told& t : m_told) {
    if (t.while_true.there() && t.while_true.holds(snapshot) != TriState::yes) continue;
    const Value v = t.facts->value(t.watch, snapshot);
    if (t.keep == Keep::last) {
      t.known = v.known;
      t.value = v.number;
    } else if (v.known) {
      t.value = t.known ? std::max(t.value, v.number) : v.number;
      t.least = t.known ? std::min(t.least, v.number) : v.number;
      t.known = true;
    }
  }
}

void Details::happened(int event, const EventInstance& h, const Snapshot& snapshot, const std::string& side,
                       bool good) {
  const EventKind* kind = m_events->all()[size_t(event)].event;
  if (kind->attributes.empty() || h.number < 0 || m_done.size() >= kMostDone) return;
  Done d{kind, side, h.name ? *h.name : std::string(), snapshot.now(), good, {}};
  for (const Attribute& a : kind->attributes) d.attributes.push_back(a.value(snapshot, h));
  m_done.push_back(std::move(d));
}

void Details::tell(Json& result) const {
  std::vector<std::string> sides;
  const auto note = [&sides](const std::string& side) {
    if (std::find(sides.begin(), sides.end(), side) == sides.end()) sides.push_back(side);
  };
  for (const Told& t : m_told) note(t.side);
  for (const Done& d : m_done) note(d.side);
  Json& all = result["details"] = Json::array();
  for (const std::string& side : sides) {
    Json j{{"side", side}};
    for (const Done& d : m_done) {
      if (d.side != side) continue;
      Json act{{"on", d.on}};
      for (std::size_t i = 0; i < d.attributes.size(); ++i)
        if (const Attribute& a = d.event->attributes[i]; d.attributes[i].known)
          act[std::string(a.name)] = number(d.attributes[i].number, a.name, a.is_truth);
      act["good"] = d.good;
      act["at_s"] = d.at;
      j[std::string(d.event->name)].push_back(std::move(act));
    }
    for (const Told& t : m_told) {
      if (t.side != side || !t.known) continue;
      const std::string_view name = t.fact->name;
      j[t.name] = t.keep == Keep::range
                      ? Json{{"from", number(t.least, name, false)}, {"to", number(t.value, name, false)}}
                      : number(t.value, name, t.fact->is_truth);
    }
    all.push_back(std::move(j));
  }
}

}  // namespace trocar::training
