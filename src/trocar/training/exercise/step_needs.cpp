#include <algorithm>
#include <array>

#include <trocar/training/exercise/step_needs.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/stitches.hpp>

namespace trocar::training {
namespace {

using interactions::Abilities;

/// Facts about what the picture shows: the endoscope alone makes them true.
bool of_the_picture(std::string_view fact) {
  return fact.starts_with("scope.") || fact.starts_with("marks.seen") || fact == "mark.in_view" ||
         fact == "mark.visible_share" || fact == "mark.seen_for_s" || fact == "mark.off_centre" ||
         fact == "mark.distance_mm" || fact == "mark.facing_deg" || fact == "mark.under_liquid" ||
         fact == "strand.stumps_in_view" || fact == "blood.since_s";
}

/// What an instrument must be able to do for a fact that names no hand; null: nothing special.
bool Abilities::*ability_for(std::string_view name) {
  if (name.starts_with("needle.") || name.starts_with("injected")) return &Abilities::inject;
  if (name.starts_with("loop.")) return &Abilities::sling;
  if (name.starts_with("bag.")) return &Abilities::bag;
  if (name.starts_with("clip")) return &Abilities::set_clips;
  if (name == "cut" || name == "strand.severed") return &Abilities::cut;
  if (name == "activated" || name.ends_with("sealed")) return &Abilities::coagulate;
  if (name == "pool.volume_mL") return &Abilities::irrigate;
  return nullptr;
}

bool of_the_needle(std::string_view name) { return name.starts_with("suture.") || name == "pierced"; }

class Needs {
 public:
  Needs(const Rules& rules, const Snapshot& snapshot) : m_rules(rules), m_snapshot(snapshot) {}

  StepNeeds of(const StepRule& rule) {
    condition(rule.when);
    for (const Cause& cause : rule.on.causes()) {
      verb(m_rules.events().all()[size_t(cause.event)].event->name);
      condition(cause.while_true);
    }
    m_needs.endoscope = m_picture && !m_other;
    const auto most = std::max_element(m_votes.begin(), m_votes.end());
    if (!m_needs.endoscope && *most > 0 && std::count(m_votes.begin(), m_votes.end(), *most) == 1)
      m_needs.hand = int(most - m_votes.begin());
    return m_needs;
  }

 private:
  void condition(const Condition& c) {
    if (c.kind() == Condition::Kind::negation) return;
    if (c.kind() == Condition::Kind::fact && c.watch() >= 0) fact(m_rules.facts().all()[size_t(c.watch())]);
    for (const Condition& part : c.parts()) condition(part);
  }

  void fact(const FactWatches::Watched& watched) {
    const std::string_view name = watched.fact->name;
    m_needs.suction |= name == "pool.volume_mL" || name == "mark.under_liquid";
    if (of_the_picture(name)) {
      m_picture = true;
      return;
    }
    m_other = true;
    m_needs.grasp |= name.starts_with("hand.hold") || name.starts_with("hand.held");
    m_needs.energy |= name.ends_with("sealed") || name.starts_with("tissue.");
    m_needs.inject |= name.starts_with("needle.") || name.starts_with("injected.");
    const int named = hand_of(watched);
    if (named >= 0)
      ++m_votes[size_t(named)];
    else
      who_can(name);
  }

  void verb(std::string_view event) {
    m_other = true;
    m_needs.clip |= event == "clipped";
    m_needs.divide |= event == "cut";
    m_needs.energy |= event == "activated";
    m_needs.inject |= event == "injected";
    m_needs.declare |= event == "declared";
    who_can(event);
  }

  static int hand_of(const FactWatches::Watched& watched) {
    for (size_t i = 0; i < watched.arguments.size(); ++i)
      if (watched.arguments[i].given && watched.fact->parameters[i].kind == ArgumentKind::hand)
        return watched.arguments[i].index;
    return -1;
  }

  void who_can(std::string_view name) {
    bool Abilities::*const can = ability_for(name);
    const bool needle = of_the_needle(name) && has_suture(m_snapshot.model);
    for (size_t h = 0; h < hands(m_snapshot.model); ++h) {
      if (can && m_snapshot.model.tool(m_snapshot.state, h).can().*can) ++m_votes[h];
      if (needle && held_of_suture(m_snapshot.model, m_snapshot.state, h) == 1) ++m_votes[h];
    }
  }

  const Rules& m_rules;
  const Snapshot& m_snapshot;
  StepNeeds m_needs;
  std::array<int, sim::kMaxTools> m_votes{};
  bool m_picture = false, m_other = false;
};

bool declares(const Rules& rules, const Act& act) {
  return std::any_of(act.causes().begin(), act.causes().end(),
                     [&](const Cause& c) { return rules.events().all()[size_t(c.event)].event->name == "declared"; });
}

}  // namespace

StepNeeds needs_of(const Rules& rules, int step, const Snapshot& snapshot) {
  if (step < 0 || step >= int(rules.steps().size())) return {};
  return Needs(rules, snapshot).of(rules.steps()[size_t(step)]);
}

bool asks_for_declaration(const Rules& rules) {
  return std::any_of(rules.steps().begin(), rules.steps().end(),
                     [&](const StepRule& s) { return declares(rules, s.on) || declares(rules, s.missed_on); });
}

}  // namespace trocar::training
