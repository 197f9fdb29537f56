#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/exercise/rule_files.hpp>

namespace trocar::training {
namespace {

using scene::JsonObject;
using scene::JsonValue;
using scene::needed;
namespace keys = scene::keys;

const scene::Shape& limit_shape() {
  static const scene::Shape shape{
      "limit",
      "A limit and its source.",
      {needed(keys::any("value", "a number or [from, to], in the unit that the name ends in")),
       keys::any("in", "its value in other anatomies of the scene, by the variant's name: numbers or ranges likewise"),
       needed(keys::text("source", "a publication, or \"our estimate\"")),
       keys::choice("stricter", {"low", "high"}, "in common rules: the direction that makes it stricter"),
       keys::text("loosened", "why this exercise allows more than the common rules")}};
  return shape;
}

struct Figure {
  double low = 0, high = 0;
  bool is_range = false;
};
/// None: it is neither a number nor a range.
std::optional<Figure> figure_of(const JsonValue& v) {
  const auto number = [](const JsonValue& i) { return i.kind == JsonValue::Kind::number; };
  if (number(v)) return Figure{v.number, v.number, false};
  if (v.kind == JsonValue::Kind::array && v.items.size() == 2 && number(v.items[0]) && number(v.items[1]))
    return Figure{v.items[0].number, v.items[1].number, true};
  return std::nullopt;
}

void elsewhere(const JsonValue& in, const JsonObject& o, Limit& l) {
  if (in.kind != JsonValue::Kind::object)
    return o.fault("in", "expected values by the names of variants in {}, got " + scene::shown(in));
  for (const scene::JsonMember& m : in.members) {
    const std::optional<Figure> f = figure_of(m.value);
    if (!f || f->is_range != l.is_range || f->low > f->high)
      o.fault("in", tr("expected {} for \"{}\", as the value is, got {}",
                       l.is_range ? "[from, to] with from <= to" : "a number", m.key, scene::shown(m.value)));
    else
      l.elsewhere.push_back({m.key, f->low, f->high});
  }
}

bool looser(const Limit& own, const Limit& common) {
  if (own.is_range != common.is_range) return true;
  if (common.stricter == Limit::Stricter::low) return own.high > common.high;
  if (common.stricter == Limit::Stricter::high) return own.low < common.low;
  return own.low < common.low || own.high > common.high;
}

std::vector<std::string> given(const JsonObject& o, const char* key, const std::vector<std::string>& otherwise) {
  return o.names(key) ? o.texts(key) : otherwise;
}

const JsonValue* limits_of(const JsonObject& file) {
  const scene::JsonMember* limits = file.value().find("limits");
  return limits ? &limits->value : nullptr;
}

}  // namespace

void RuleFiles::read(const Said& by, bool own) {
  limits(by.limits, own);
  sets(by.sets, by.sets.at().file);
  errors(by.errors, by.errors.at().file, own);
}

void RuleFiles::limits(const std::vector<const JsonObject*>& files, bool own) {
  if (own) m_common_limits = m_exercise.limits.size();
  for (auto file = files.rbegin(); file != files.rend(); ++file) {
    const JsonValue* all = limits_of(**file);
    if (!all) continue;
    if (all->kind != JsonValue::Kind::object) {
      (*file)->fault("limits", "expected limits by their names in {}, got " + scene::shown(*all));
      continue;
    }
    const auto named_above = [&](const std::string& name) {
      return std::any_of(files.begin(), file.base() - 1, [&name](const JsonObject* above) {
        const JsonValue* theirs = limits_of(*above);
        return theirs && theirs->find(name);
      });
    };
    for (const scene::JsonMember& m : all->members)
      if (!named_above(m.key)) limit(m, (*file)->at().file, own);
  }
}

void RuleFiles::limit(const scene::JsonMember& member, const std::string& path, bool own) {
  const JsonObject o(member.value, limit_shape(), path, m_faults);
  Limit l;
  l.name = member.key;
  l.at = {path, member.line, member.column};
  l.source = o.text("source");
  const std::string stricter = o.text("stricter");
  l.stricter = stricter == "low"    ? Limit::Stricter::low
               : stricter == "high" ? Limit::Stricter::high
                                    : Limit::Stricter::either;
  static const JsonValue kNothing;
  const scene::JsonMember* value = member.value.find("value");
  const JsonValue& v = value ? value->value : kNothing;
  if (const std::optional<Figure> f = figure_of(v)) {
    l.is_range = f->is_range;
    l.low = f->low, l.high = f->high;
    if (l.low > l.high) o.fault("value", "expected [from, to] with from <= to, got an empty range");
  } else {
    if (value) o.fault("value", "expected a number or [from, to], got " + scene::shown(v));
    l.broken = true;
  }
  if (const scene::JsonMember* in = member.value.find("in")) elsewhere(in->value, o, l);
  const auto same = [&l](const Limit& other) { return other.name == l.name; };
  const auto known = std::find_if(m_exercise.limits.begin(), m_exercise.limits.end(), same);
  if (known == m_exercise.limits.end() && m_exercise.limits.size() >= kMaxLimits)
    return o.fault(o.at(), tr("expected at most {} limits in an exercise, got more", kMaxLimits));
  if (known == m_exercise.limits.end()) {
    m_exercise.limits.push_back(std::move(l));
    return;
  }
  if (!own || std::size_t(known - m_exercise.limits.begin()) >= m_common_limits)
    return o.fault(o.at(), tr("expected each limit once, got \"{}\" again", l.name));
  if (!l.broken && looser(l, *known) && !o.has("loosened"))
    o.fault("value", tr("expected a limit at least as strict as {}:{} ({}), or a reason in \"loosened\", got {}",
                        known->at.file, known->at.line, known->shown(), l.shown()));
  *known = std::move(l);
}

void RuleFiles::sets(const JsonObject& file, const std::string& path) {
  const scene::JsonMember* all = file.value().find("sets");
  if (!all) return;
  if (all->value.kind != JsonValue::Kind::object)
    return file.fault("sets", "expected sets by their names in {}, got " + scene::shown(all->value));
  for (const scene::JsonMember& m : all->value.members) {
    const auto same = [&m](const auto& other) { return other.first == m.key; };
    const auto known = std::find_if(m_exercise.sets.begin(), m_exercise.sets.end(), same);
    if (known != m_exercise.sets.end())
      known->second = {m.value, path};
    else if (m_exercise.sets.size() >= std::size_t(kMaxSets))
      return file.fault("sets", tr("expected at most {} sets in an exercise, got more", kMaxSets));
    else
      m_exercise.sets.push_back({m.key, {m.value, path}});
  }
}

void RuleFiles::errors(const JsonObject& file, const std::string& path, bool own) {
  if (own) m_common_errors = m_exercise.penalties.size();
  for (const JsonObject& o : file.objects("errors")) {
    Penalty p;
    p.code = o.text("code");
    const auto same = [&p](const Penalty& other) { return other.code == p.code; };
    const auto known = std::find_if(m_exercise.penalties.begin(), m_exercise.penalties.end(), same);
    if (known != m_exercise.penalties.end()) {
      if (own && std::size_t(known - m_exercise.penalties.begin()) < m_common_errors)
        make_stricter(*known, o, path);
      else
        o.fault("code", "expected each code once, got \"" + p.code + "\" again");
      continue;
    }
    if (m_exercise.penalties.size() >= std::size_t(kMaxErrors))
      return o.fault(o.at(), tr("expected at most {} errors in an exercise, got more", kMaxErrors));
    for (const char* key : {"name", "meaning", "source"})
      if (!o.names(key)) o.fault(o.at(), tr("expected \"{}\" in the error {}, got none", key, p.code));
    if (!o.names("points") && !o.flag("fails"))
      o.fault(o.at(), tr("expected a penalty for {}: points, or fails: true, got none", p.code));
    if (!o.names("on") && !o.names("when"))
      o.fault(o.at(), tr("expected \"on\" or \"when\" for {}, got neither", p.code));
    p.name = o.text("name");
    p.points = o.number("points");
    p.fail = o.flag("fails");
    p.meaning = o.text("meaning");
    p.hint = o.text("hint");
    p.source = o.text("source");
    p.implies = o.texts("implies");
    p.may = o.texts("may");
    p.leaves = o.texts("leaves");
    p.misses = o.texts("misses");
    p.for_each = o.text("for_each");
    p.part = {o.value(), path};
    if (const scene::JsonMember* at = o.value().find("at")) p.at = {at->value, path};
    m_exercise.penalties.push_back(std::move(p));
  }
}

void RuleFiles::make_stricter(Penalty& common, const JsonObject& o, const std::string& path) {
  for (const char* key : {"for_each", "on", "when", "for_s", "once_per", "detail"})
    if (o.names(key))
      o.fault(key,
              tr("expected only keys that make {} stricter (points, fails) or change its text, got {}: the error is "
                 "defined in {}",
                 common.code, key, common.part.file));
  if (o.has("points") && o.number("points") < common.points)
    o.fault("points",
            tr("expected at least {:g}, as in {}, got {:g}", common.points, common.part.file, o.number("points")));
  if (o.has("fails") && common.fail && !o.flag("fails"))
    o.fault("fails", tr("expected true, as in {}, got false", common.part.file));
  if (const scene::JsonMember* at = o.value().find("at")) common.at = {at->value, path};
  common.points = o.number("points", common.points);
  common.fail = o.flag("fails", common.fail);
  common.name = o.text("name", common.name);
  common.meaning = o.text("meaning", common.meaning);
  common.hint = o.text("hint", common.hint);
  common.source = o.text("source", common.source);
  common.implies = given(o, "implies", common.implies);
  common.may = given(o, "may", common.may);
  common.leaves = given(o, "leaves", common.leaves);
  common.misses = given(o, "misses", common.misses);
}

}  // namespace trocar::training
