// Makes rules of an exercise's steps and errors, in a scene or, to check them, without one.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/controls/control_keys.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/exercise/rules.hpp>
#include <trocar/training/exercise/step_circles.hpp>

namespace trocar::training {

using scene::JsonValue;

class RulesReader {
 public:
  RulesReader(Rules& rules, const Exercise& exercise, const sim::Model* model, Faults& faults)
      : m_rules(rules), m_exercise(exercise), m_model(model), m_faults(faults) {}

  void read() {
    owners();
    if (!place_steps() || !errors_fit()) return;
    put_steps_on_board();
    for (const Placed& p : m_placed) step(p);
    circles();
    for (const Penalty& p : m_exercise.penalties) error(p);
    details();
  }

 private:
  /// A step of the board, and where it comes from.
  struct Placed {
    const StepText* text;
    const Set* set;
    const Element* element;
  };

  void whole(std::string message) { scene::tell(m_faults, {{m_exercise.file.string(), 0, 0}, std::move(message)}); }

  RuleReading reading(const Names& names, const std::string& file) {
    RuleReading r;
    r.named = &names;
    r.model = m_model;
    r.facts = &m_rules.m_facts;
    r.events = &m_rules.m_events;
    r.steps = &m_rules.m_board.steps();
    r.file = &file;
    r.faults = &m_faults;
    r.parts = m_parts;
    return r;
  }

  Names names_at(const Set* set, const Element* element) const {
    return set ? m_rules.m_names.at(*set, *element) : m_rules.m_names;
  }

  /// Null: a fault has been reported, or it is there once.
  const Set* set_of(const std::string& name, const Part& part) {
    if (name.empty()) return nullptr;
    const Set* set = m_rules.m_names.set(name);
    if (set) return set;
    std::vector<std::string> known;
    for (const Set& s : m_rules.m_names.sets()) known.push_back(s.name);
    const scene::JsonMember* at = part.value.find("for_each");
    reading(m_rules.m_names, part.file).fault(at ? at->value : part.value, scene::unknown_name("set", name, known));
    return nullptr;
  }

  /// Bodies by which it is known which element somebody works on. A set of other sets is followed, so that a circle is
  /// found also where nothing asks for it.
  void owners() {
    for (const Set& set : m_rules.m_names.sets()) {
      const RuleReading r = reading(m_rules.m_names, set.file);
      for (std::size_t i = 0; i < set.elements.size() && !r.is_full(); ++i) {
        if (const JsonValue& self = set.elements[i].self; self.text.substr(0, 1) == "$") r.names(self);
        for (const std::string& member : set.held) own(set, i, member);
      }
    }
  }
  void own(const Set& set, std::size_t element, const std::string& member) {
    const Element& e = set.elements[element];
    const RuleReading r = reading(m_rules.m_names, set.file);
    if (!r.has_room(set.at)) return;
    const JsonValue* value = e.member(member);
    if (!value)
      return r.fault(set.at,
                     tr("expected the member \"{}\" of \"{}\", which \"held\" needs, got none", member, e.name));
    for (const NameAt& n : r.names(*value)) {
      std::int32_t code = -1;
      std::vector<std::string> known;
      if (!m_model) continue;
      if (!find_named(*m_model, ArgumentKind::body, n.name, code, known))
        scene::tell(m_faults, {n.at, scene::unknown_name(noun(ArgumentKind::body), n.name, known)});
      else if (const BodyId body = BodyId::of_code(code); body.exists())
        m_rules.m_guide.belongs(body, set.name, int(element), e.name);
    }
  }

  /// Steps of one set that follow each other are shown an element after another.
  /// @return false: there are too many
  bool place_steps() {
    const std::vector<StepText>& all = m_exercise.steps;
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && !all[i].for_each.empty() && all[end].for_each == all[i].for_each) ++end;
      const Set* set = set_of(all[i].for_each, all[i].part);
      const int first = int(m_placed.size());
      if (set)
        for (const Element& e : set->elements)
          for (std::size_t k = i; k < end; ++k) m_placed.push_back({&all[k], set, &e});
      else
        for (std::size_t k = i; k < end; ++k) m_placed.push_back({&all[k], nullptr, nullptr});
      m_rules.m_guide.add({set ? set->name : "", first, int(end - i), set ? int(set->elements.size()) : 1});
      i = end;
    }
    if (m_placed.size() <= std::size_t(kMaxSteps)) return true;
    whole(tr("expected at most {} steps (one for each element), got {}", kMaxSteps, m_placed.size()));
    return false;
  }

  bool errors_fit() {
    std::size_t count = 0;
    for (const Penalty& p : m_exercise.penalties) {
      const Set* set = p.for_each.empty() ? nullptr : m_rules.m_names.set(p.for_each);
      count += set ? set->elements.size() : 1;
    }
    if (count <= std::size_t(kMaxErrors)) return true;
    whole(tr("expected at most {} errors (one for each element), got {}", kMaxErrors, count));
    return false;
  }

  void put_steps_on_board() {
    for (const Placed& p : m_placed) {
      const Names names = names_at(p.set, p.element);
      StepStatus s;
      s.name = names.text(p.text->title);
      if (p.element && p.text->title.find('{') == std::string::npos) s.name = p.element->title + ": " + s.name;
      s.hint_pattern = names.text(p.text->hint);
      s.hint = core::with_keys(s.hint_pattern, core::KeyDevice::mouse_and_keys);
      s.task = p.text->name;
      s.side = p.element ? p.element->name : "";
      s.optional = p.text->optional;
      m_rules.m_board.add_step(std::move(s), p.text->weight);
    }
  }

  void step(const Placed& p) {
    const Names names = names_at(p.set, p.element);
    const RuleReading r = reading(names, p.text->part.file);
    const JsonValue& v = p.text->part.value;
    StepRule rule;
    rule.step = int(m_rules.m_steps.size());
    if (const auto* m = v.find("after")) rule.after = steps_named(m->value, r, rule.step);
    if (const auto* m = v.find("needs")) rule.needs = steps_named(m->value, r, rule.step);
    if (const auto* m = v.find("when")) rule.when = read_condition(m->value, r);
    if (const auto* m = v.find("missed_when")) rule.missed_when = read_condition(m->value, r);
    if (const auto* m = v.find("undone_when")) rule.undone_when = read_condition(m->value, r);
    if (const auto* m = v.find("on")) rule.on = act_of_step(m->value, r, p.text->name);
    if (const auto* m = v.find("missed_on")) rule.missed_on = read_act(m->value, r);
    rule.done_for.needs = m_exercise.hold_time;
    rule.missed_for.needs = rule.undone_for.needs = m_exercise.hold_time;
    if (const auto* m = v.find("for_s"))
      if (const auto n = r.number(m->value, unit_of("for_s"), 0, 3600)) rule.done_for.needs = *n;
    const bool when = v.find("when"), on = v.find("on");
    if (!when && !on)
      r.fault(v, tr("expected when or on for the step \"{}\", got neither: nothing can make it true", p.text->name));
    if (when && on)
      r.fault(v.find("on")->value, "expected when or on, got both: the condition of an event is its \"while\"");
    m_rules.m_steps.push_back(std::move(rule));
  }

  Act act_of_step(const JsonValue& v, const RuleReading& r, const std::string& name) {
    const std::size_t before = m_faults.size();
    Act act = read_act(v, r);
    if (m_model && m_faults.size() == before && !act.possible())
      r.fault(v, tr("expected an event that can make the step \"{}\" true, got one on no body", name));
    return act;
  }

  /// "previous", a step, or several.
  std::vector<int> steps_named(const JsonValue& v, const RuleReading& r, int step) {
    std::vector<int> all;
    if (!r.has_room(v)) return all;
    if (v.kind == JsonValue::Kind::array) {
      for (const JsonValue& item : v.items)
        for (const int i : steps_named(item, r, step)) all.push_back(i);
    } else if (v.text == "previous") {
      if (step > 0) all.push_back(step - 1);
    } else {
      all = same_element_first(v, r, step);
    }
    return all;
  }
  /// Within for_each a step of the same set means that of the same element.
  std::vector<int> same_element_first(const JsonValue& v, const RuleReading& r, int step) {
    std::vector<int> found = read_steps(v, r);
    const std::string& side = m_rules.m_board.step(step).side;
    if (side.empty() || v.text.find('(') != std::string::npos) return found;
    std::vector<int> same;
    for (const int i : found)
      if (m_placed[std::size_t(i)].set == m_placed[std::size_t(step)].set && m_rules.m_board.step(i).side == side)
        same.push_back(i);
    return same.empty() ? found : same;
  }

  /// "cut" waits for "present", and "present" waits for "cut"
  void circles() {
    const std::vector<int> circle = circle_of(m_rules.m_steps);
    if (circle.empty()) return;
    std::string way;
    for (std::size_t i = 0; i < circle.size(); ++i) {
      const std::string next = '"' + step_name(circle[(i + 1) % circle.size()]) + '"';
      way += tr("{}\"{}\" waits for {}", i == 0 ? "" : ", and ", step_name(circle[i]),
                circle.size() == 1 ? "itself" : next);
    }
    const Part& part = m_placed[std::size_t(circle[0])].text->part;
    reading(m_rules.m_names, part.file).fault(part.value, "expected steps that can all be done, got a cycle: " + way);
  }
  std::string step_name(int step) const {
    const StepStatus& s = m_rules.m_board.step(step);
    return s.side.empty() ? s.task : s.task + "(" + s.side + ")";
  }

  void error(const Penalty& p) {
    const Set* set = set_of(p.for_each, p.part);
    if (!set) return error(p, nullptr, nullptr);
    for (const Element& e : set->elements) error(p, set, &e);
  }

  void error(const Penalty& p, const Set* set, const Element* element) {
    const Names names = names_at(set, element);
    const RuleReading r = reading(names, p.part.file);
    const JsonValue& v = p.part.value;
    ErrorRule rule;
    rule.penalty = &p;
    rule.side = element ? element->name : "";
    if (const auto* m = v.find("on")) rule.on = read_act(m->value, r);
    if (const auto* m = v.find("when")) rule.when = read_condition(m->value, r);
    if (const auto* m = v.find("for_s"))
      if (const auto n = r.number(m->value, unit_of("for_s"), 0, 3600)) rule.held.needs = *n;
    if (const auto* m = v.find("once_per")) rule.once = m->value.text == "attempt";
    if (const auto* m = v.find("detail")) rule.detail = r.text(m->value);
    if (!p.at.file.empty()) rule.mark = mark(p.at.value, reading(names, p.at.file));
    for (const std::string& step : p.misses) {
      const auto* m = v.find("misses");
      const JsonValue& place = m ? m->value : v;
      JsonValue name;
      name.kind = JsonValue::Kind::string;
      name.line = place.line, name.column = place.column;
      name.text = step;
      if (!r.has_room(place)) break;
      for (const int i : read_steps(name, r)) rule.misses.push_back(i);
    }
    m_rules.m_errors.push_back(std::move(rule));
  }

  int mark(const JsonValue& v, const RuleReading& r) {
    const auto name = r.name(v);
    std::int32_t index = -1;
    std::vector<std::string> known;
    if (name && m_model && !find_named(*m_model, ArgumentKind::mark, name->name, index, known))
      scene::tell(m_faults, {name->at, scene::unknown_name(noun(ArgumentKind::mark), name->name, known)});
    return index;
  }

  void details() {
    m_rules.m_details.watch(m_rules.m_events);
    for (const Part& part : m_exercise.details) m_rules.m_details.read(part, reading(m_rules.m_names, part.file));
  }

  Rules& m_rules;
  const Exercise& m_exercise;
  const sim::Model* m_model;
  Faults& m_faults;
  std::shared_ptr<std::size_t> m_parts = std::make_shared<std::size_t>(0);
  std::vector<Placed> m_placed;
};

Rules::Rules(const Exercise& exercise, const sim::Model* model, std::uint64_t seed, Scoreboard& board, Faults& faults)
    : m_exercise(exercise), m_board(board), m_names(exercise.names(model, seed, faults)) {
  RulesReader(*this, m_exercise, model, faults).read();
}

}  // namespace trocar::training
