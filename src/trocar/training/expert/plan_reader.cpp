#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/expert/plan_reader.hpp>
#include <trocar/training/rules/arguments.hpp>

namespace trocar::training {
namespace {

using scene::JsonMember;
using scene::JsonValue;
using Kind = JsonValue::Kind;

constexpr double kShortest = 0.1, kLongestGoal = 3600;  // [s] that anything may be asked to take

class PlanReader {
 public:
  explicit PlanReader(const RuleReading& reading) : r(reading) {}

  void read(const JsonValue& list, Plan& plan) const {
    if (!is_list(list, "goals and parts")) return;
    PlanPart* loose = nullptr;  // goals beside each other that stand in no part
    for (const JsonValue& item : list.items) {
      if (!r.has_room(item)) return;
      if (item.find("goals")) {
        parts(item, plan);
        loose = nullptr;
        continue;
      }
      if (!loose) loose = &open(plan);
      loose->goals.push_back(goal(item));
    }
  }

 private:
  static PlanPart& open(Plan& plan) {
    PlanPart part;
    part.group = plan.parts.empty() ? 0 : plan.parts.back().group + 1;
    plan.parts.push_back(std::move(part));
    return plan.parts.back();
  }

  bool is_list(const JsonValue& v, const char* of) const {
    if (v.kind == Kind::broken) return false;
    if (v.kind == Kind::array) return true;
    r.fault(v, tr("expected a list of {}, got {}", of, scene::shown(v)));
    return false;
  }

  void parts(const JsonValue& v, Plan& plan) const {
    r.check_keys(v, "a part", {"for_each", "goals", "at_most_s", "pause_s"});
    PlanPart part;
    part.group = plan.parts.empty() ? 0 : plan.parts.back().group + 1;
    part.at_most = number(v, "at_most_s", part.at_most);
    part.pause = int(std::lround(number(v, "pause_s", 0) / sim::kTick));
    const JsonMember* each = v.find("for_each");
    const Set* set = each ? r.named->set(each->value.text) : nullptr;
    if (each && !set) {
      std::vector<std::string> known;
      for (const Set& s : r.named->sets()) known.push_back(s.name);
      r.fault(each->value, scene::unknown_name("set", each->value.text, known));
    }
    if (!set) {
      goals(v.find("goals")->value, part);
      plan.parts.push_back(std::move(part));
      return;
    }
    for (const Element& element : set->elements) {
      if (r.is_full()) return;
      const Names inner = r.named->at(*set, element);
      PlanPart of = part;
      of.element = element.name;
      PlanReader(r.within(inner)).goals(v.find("goals")->value, of);
      plan.parts.push_back(std::move(of));
    }
  }

  void goals(const JsonValue& list, PlanPart& part) const {
    if (!is_list(list, "goals")) return;
    for (const JsonValue& item : list.items) {
      if (!r.has_room(item)) return;
      part.goals.push_back(goal(item));
      part.goals.back().element = part.element;
    }
  }

  PlanGoal goal(const JsonValue& v) const {
    PlanGoal g;
    g.at = r.at(v);
    r.check_keys(v, "a goal", {"goal", "until", "tries", "optional", "do", "if_failed", "every"});
    const JsonMember* name = v.find("goal");
    if (name && name->value.kind == Kind::string)
      g.name = r.text(name->value);
    else
      r.fault(v, "expected a goal: an object with goal and do, or a part with goals, got " + scene::shown(v));
    if (const JsonMember* until = v.find("until")) g.until = read_condition(until->value, r);
    g.tries = int(number(v, "tries", 0));
    if (const JsonMember* m = v.find("optional")) {
      g.optional = m->value.kind == Kind::boolean && m->value.truth;
      if (m->value.kind != Kind::boolean) r.fault(m->value, "expected true or false, got " + scene::shown(m->value));
    }
    g.every = std::max(1, int(number(v, "every", 1)));
    if (const JsonMember* list = v.find("do"))
      g.todo = some_tasks(list->value);
    else
      r.fault(v, "expected \"do\", the skills for this goal, got none");
    if (const JsonMember* list = v.find("if_failed")) g.if_failed = tasks(list->value);
    return g;
  }

  std::vector<PlanTask> tasks(const JsonValue& list) const {
    std::vector<PlanTask> out;
    if (!is_list(list, "skills")) return out;
    for (const JsonValue& item : list.items) {
      const SkillKind* kind = r.is_full() ? nullptr : skill(item);
      if (kind && r.has_room(item, 1 + kind->parameters.size())) out.push_back(task(item, *kind));
      if (r.is_full()) break;
    }
    return out;
  }

  std::vector<PlanTask> some_tasks(const JsonValue& list) const {
    if (list.kind == Kind::array && list.items.empty()) r.fault(list, "expected skills, got none");
    return tasks(list);
  }

  const SkillKind* skill(const JsonValue& v) const {
    const JsonMember* name = v.find("skill");
    const SkillKind* kind = name ? find_skill(name->value.text) : nullptr;
    if (kind || v.kind == Kind::broken) return kind;
    std::vector<std::string> known;
    for (const SkillKind* k : skills()) known.emplace_back(k->name);
    r.fault(name ? name->value : v, name ? scene::unknown_name("skill", name->value.text, known)
                                         : "expected a skill: an object with skill, got " + scene::shown(v));
    return nullptr;
  }

  PlanTask task(const JsonValue& v, const SkillKind& kind) const {
    PlanTask t = PlanTask::of(kind);
    t.at = r.at(v);
    std::vector<std::string> keys{"skill", "at_most_s", "if_late", "until", "meanwhile"};
    for (const Parameter& p : kind.parameters) keys.emplace_back(p.name);
    r.check_keys(v, tr("the skill \"{}\"", kind.name), keys);
    const std::size_t before = r.faults->size();
    t.arguments = read_arguments(v, kind.parameters, tr("the skill \"{}\"", kind.name), r);
    t.at_most = number(v, "at_most_s", kind.patience);
    if (const JsonMember* late = v.find("if_late")) {
      t.goes_on = late->value.text == "go_on";
      if (!t.goes_on && late->value.text != "fail")
        r.fault(late->value, scene::unknown_name("word", late->value.text, {"fail", "go_on"}));
    }
    if (const JsonMember* until = v.find("until")) t.until = read_condition(until->value, r);
    if (const JsonMember* list = v.find("meanwhile")) t.meanwhile = tasks(list->value);
    if (r.model && r.faults->size() == before) check(t);
    return t;
  }

  void check(const PlanTask& t) const {
    const std::string lack = t.kind->lacks(*r.model, SkillArgs(*t.kind, t.arguments));
    if (lack.empty()) return;
    scene::tell(*r.faults, {t.at, tr("expected a scene that suits the skill \"{}\", got: {}", t.kind->name, lack)});
  }

  double number(const JsonValue& v, const char* key, double otherwise) const {
    const JsonMember* m = v.find(key);
    if (!m) return otherwise;
    const double least = std::string_view(key) == "at_most_s" ? kShortest : 0;
    return r.number(m->value, unit_of(key), least, kLongestGoal).value_or(otherwise);
  }

  const RuleReading& r;
};

}  // namespace

Plan read_plan(const JsonValue& demonstration, const RuleReading& reading) {
  Plan plan;
  PlanReader(reading).read(demonstration, plan);
  return plan;
}

}  // namespace trocar::training
