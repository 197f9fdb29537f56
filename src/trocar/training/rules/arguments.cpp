#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/rules/arguments.hpp>

namespace trocar::training {
namespace {

using scene::JsonValue;

class ArgumentReader {
 public:
  ArgumentReader(const JsonValue& object, std::span<const Parameter> parameters, const RuleReading& reading)
      : m_object(object), m_parameters(parameters), r(reading) {}

  Argument read(const Parameter& p, const JsonValue& value) const {
    Argument a;
    if (p.kind == ArgumentKind::number) {
      if (const auto n = r.number(value, unit_of(p.name), p.low, p.high)) a = exactly(*n);
    } else if (p.kind == ArgumentKind::range) {
      if (const auto i = r.interval(value, unit_of(p.name))) a.given = true, a.low = i->low, a.high = i->high;
    } else if (p.kind == ArgumentKind::bodies) {
      a.given = true;
      for (const NameAt& n : r.names(value))
        if (const BodyId body = BodyId::of_code(index(p.kind, n)); body.exists()) a.bodies.push_back(body);
    } else if (p.kind == ArgumentKind::marks) {
      a.given = true;
      for (const NameAt& n : r.names(value))
        if (const std::int32_t mark = index(p.kind, n); mark >= 0) a.marks.push_back(mark);
    } else if (const auto n = r.name(value)) {
      a.given = true;
      if (p.kind == ArgumentKind::word || p.kind == ArgumentKind::landmark)
        a.word = word(p, *n);
      else
        a.index = index(p.kind, *n);
    }
    return a;
  }

 private:
  static Argument exactly(double number) {
    Argument a;
    a.given = true;
    a.low = a.high = number;
    return a;
  }

  /// The place that bleeds by itself is a mark where rays can ask for it: where something carries the vessel.
  bool hidden_bleeder(ArgumentKind kind, const NameAt& n) const {
    if (kind != ArgumentKind::mark || n.name != "bleeder" || r.model->vessels.bleeder.vessel < 0) return false;
    scene::tell(*r.faults, {n.at,
                            "expected a bleeder on a vessel that is attached to a body there, got an unattached one, "
                            "whose visibility cannot be computed"});
    return true;
  }

  std::int32_t index(ArgumentKind kind, const NameAt& n) const {
    std::int32_t found = -1;
    std::vector<std::string> known;
    if (r.model && !find_named(*r.model, kind, n.name, found, known) && !hidden_bleeder(kind, n))
      scene::tell(*r.faults, {n.at, scene::unknown_name(noun(kind), n.name, known)});
    return found;
  }

  std::string word(const Parameter& p, const NameAt& n) const {
    std::vector<std::string> known = p.words;
    if (p.kind == ArgumentKind::landmark) known = landmarks();
    if (!known.empty() && std::find(known.begin(), known.end(), n.name) == known.end())
      scene::tell(*r.faults,
                  {n.at, scene::unknown_name(p.kind == ArgumentKind::landmark ? "landmark" : "word", n.name, known)});
    return n.name;
  }

  /// Of the strand that another argument names; none without a scene.
  std::vector<std::string> landmarks() const {
    std::vector<std::string> known;
    for (const Parameter& p : m_parameters) {
      const scene::JsonMember* m = p.kind == ArgumentKind::strand && r.model ? m_object.find(p.name) : nullptr;
      if (!m) continue;
      Faults told_already;
      RuleReading quiet = r;
      quiet.faults = &told_already;
      const auto strand = quiet.name(m->value);
      const int i = strand ? r.model->strand_index(strand->name) : -1;
      if (i < 0) continue;
      for (const sim::LandmarkModel& l : r.model->strands[size_t(i)].landmarks) known.push_back(l.name);
      if (known.empty()) known.push_back("none: the strand has no landmarks");
    }
    return known;
  }

  const JsonValue& m_object;
  std::span<const Parameter> m_parameters;
  const RuleReading& r;
};

}  // namespace

Arguments read_arguments(const JsonValue& object, std::span<const Parameter> parameters, std::string_view what,
                         const RuleReading& reading) {
  const ArgumentReader reader(object, parameters, reading);
  Arguments out;
  for (const Parameter& p : parameters) {
    const scene::JsonMember* m = object.find(p.name);
    if (!m && p.needed) reading.fault(object, tr("expected \"{}\" ({}) for {}, got none", p.name, p.meaning, what));
    out.push_back(m ? reader.read(p, m->value) : Argument{});
  }
  return out;
}

}  // namespace trocar::training
