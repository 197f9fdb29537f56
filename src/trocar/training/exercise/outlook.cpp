#include <algorithm>

#include <fmt/format.h>

#include <trocar/training/exercise/outlook.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

/// Would it be this, if it happened? Unlike Act::of, it asks facts what they would say then.
/// @param least  what attributes must say: what is not known yet (how fast jaws will have closed) is no error, but it
/// is
///               no reason against a step either
const Cause* cause_of(const Act& act, int event, const Snapshot& snapshot, const EventInstance& h, TriState least) {
  for (const Cause& c : act.causes()) {
    if (c.event != event || !c.concerns(snapshot.model, h)) continue;
    const bool fits = std::all_of(c.attributes.begin(), c.attributes.end(), [&](const AttributeTest& a) {
      return a.test.of(a.attribute->value(snapshot, h)) >= least;
    });
    if (fits && c.while_true.would_hold(snapshot, h) == TriState::yes) return &c;
  }
  return nullptr;
}

/// "off the cross-section: 12 degrees (at most 15)"
Foretold::Finding finding(const AttributeTest& a, const Value& value) {
  const Unit& unit = unit_of(a.attribute->name);
  std::string text(a.attribute->meaning.substr(0, a.attribute->meaning.find(';')));
  if (a.attribute->is_truth)
    text += value.number != 0 ? ": yes" : ": no";
  else
    text += fmt::format(": {:.3g}{}{}", value.number / unit.si, unit.suffix.empty() ? "" : " ", unit.suffix);
  return {fmt::format("{} ({})", text, a.test.shown(unit, a.attribute->is_truth)), a.test.of(value) == TriState::yes};
}

}  // namespace

Outlook::Outlook(const Exercise& exercise, const sim::Model& model, std::uint64_t seed)
    : m_exercise(std::make_unique<const Exercise>(exercise)),
      m_board(std::make_unique<Scoreboard>(*m_exercise, Mode::familiarisation)) {
  Faults faults;
  m_rules = std::make_unique<Rules>(*m_exercise, &model, seed, *m_board, faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
}

std::optional<Foretold> Outlook::of(const sim::Model& model, const sim::State& state, std::span<const bool> done) {
  const Snapshot snapshot{model, state};
  m_rules->look_at(snapshot);
  for (std::size_t i = 0; i < done.size() && i < m_board->steps().size(); ++i)
    if (done[i]) m_board->done(int(i));
  const auto& events = m_rules->events().all();
  for (std::size_t i = 0; i < events.size(); ++i)
    for (std::size_t h = 0; h < hands(model) && events[i].event->foresee; ++h) {
      Foreseen f;
      if (events[i].event->foresee(snapshot, int(h), f)) return foretell(snapshot, int(i), f.instance);
    }
  return std::nullopt;
}

Foretold Outlook::foretell(const Snapshot& snapshot, int event, const EventInstance& h) const {
  Foretold out;
  if (h.name) out.on = m_rules->names().title_of(*h.name);
  std::vector<std::string_view> told;
  for (const StepRule& rule : m_rules->steps()) {
    for (const Cause& c : rule.on.causes())
      for (const AttributeTest& a : c.attributes) {
        const Value value = a.attribute->value(snapshot, h);
        const bool again = std::find(told.begin(), told.end(), a.attribute->name) != told.end();
        if (c.event != event || !c.concerns(snapshot.model, h) || !value.known || again) continue;
        told.push_back(a.attribute->name);
        out.findings.push_back(finding(a, value));
      }
    if (m_board->open(rule.step) && cause_of(rule.on, event, snapshot, h, TriState::unknown))
      out.steps.push_back(rule.step);
  }
  for (const ErrorRule& rule : m_rules->errors())
    if (const Cause* c = cause_of(rule.on, event, snapshot, h, TriState::yes)) {
      out.codes.push_back(rule.penalty->code);
      const bool names_it = (c->detail + rule.detail).find("{on}") != std::string::npos;
      out.findings.push_back({names_it ? rule.penalty->meaning + ": " + out.on : rule.penalty->meaning, false});
    }
  return out;
}

}  // namespace trocar::training
