// A condition of an exercise file: facts held against limits, and steps, joined by all, any, not. Three-valued: a fact
// about something that is gone is unknown, and then neither the condition nor its negation counts.
//
//   {"fact": "hand.pull_N", "hand": "suprapubic", "in": "$pull_N"}
//   {"all": [...]}  {"any": [...]}  {"not": {...}}     either with "for_each": "side": once an element
//   {"step": "identify($side)", "is": "done"}          also "missed", "open"; with "since_s" how long ago it was closed
#pragma once

#include <vector>

#include <trocar/training/rules/test.hpp>
#include <trocar/training/rules/watches.hpp>

namespace trocar::training {

class Condition {
 public:
  /// Is there one at all? One that is not there holds.
  bool there() const { return m_kind != Kind::none; }
  /// May be asked when the watches know the tick.
  TriState holds(const Snapshot& snapshot) const;
  /// The same if this happened now.
  TriState would_hold(const Snapshot& snapshot, const EventInstance& instance) const;

  // What it consists of, for who shows it.
  enum class Kind { none, fact, step, all, any, negation };
  Kind kind() const { return m_kind; }
  const std::vector<Condition>& parts() const { return m_parts; }
  const FactWatches* facts() const { return m_facts; }
  int watch() const { return m_watch; }        ///< of a fact
  const Test& test() const { return m_test; }  ///< of a fact
  /// Of a step that has to be done; null: of something else.
  const StepStatus* needed_step() const {
    return m_kind == Kind::step && m_is == StepIs::done && !m_since ? &(*m_steps)[size_t(m_step)] : nullptr;
  }

  /// The facts that it asks for, with their tests, however deep.
  template <class Visit>
  void each_fact(Visit&& visit) const {
    if (m_kind == Kind::fact && m_watch >= 0) visit(m_watch, m_test);
    for (const Condition& part : m_parts) part.each_fact(visit);
  }

  /// The steps without which it cannot hold.
  template <class Visit>
  void each_needed_step(Visit&& visit) const {
    if (m_kind == Kind::step && m_is == StepIs::done) visit(m_step);
    if (m_kind == Kind::all || (m_kind == Kind::any && m_parts.size() == 1))
      for (const Condition& part : m_parts) part.each_needed_step(visit);
  }

 private:
  enum class StepIs { done, missed, open };

  friend class ConditionReader;
  TriState holds(const Snapshot& snapshot, const EventInstance* instance) const;
  TriState of_step(const Snapshot& snapshot) const;

  Kind m_kind = Kind::none;
  const FactWatches* m_facts = nullptr;
  int m_watch = -1;
  Test m_test;
  const Steps* m_steps = nullptr;
  int m_step = -1;
  StepIs m_is = StepIs::done;
  bool m_since = false;  ///< the test is of how long ago the step was closed
  std::vector<Condition> m_parts;
};

/// What the value says; with faults a condition that may only be thrown away.
Condition read_condition(const scene::JsonValue& value, const RuleReading& reading);

/// A fact with its arguments. `watch`: its number; -1: a fault has been reported, or there is no scene yet.
struct FactAt {
  const Fact* fact = nullptr;
  int watch = -1;
};
/// @param keys  that the object may have beside "fact" and the arguments
FactAt read_fact(const scene::JsonValue& object, std::vector<std::string> keys, const RuleReading& reading);

/// The number of a step that a file names: "stop", "identify($side)", "see(niche_3)"; -1: a fault has been reported, or
/// the step's set waits for its scene.
int read_step(const scene::JsonValue& value, const RuleReading& reading);
/// The same where a name stands for the step of all elements: "first_clip".
std::vector<int> read_steps(const scene::JsonValue& value, const RuleReading& reading);

}  // namespace trocar::training
