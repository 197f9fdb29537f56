// What must happen for a step or an error: an event of the registry on a body, with attributes within limits.
//
//   {"event": "clipped", "on": "$side.tube", "s_mm": "$first_clip_mm", "tips_visible": 2, "while": CONDITION}
//   {"any": [{...}, {...}]}
#pragma once

#include <string>
#include <vector>

#include <trocar/training/rules/condition.hpp>

namespace trocar::training {

/// An attribute of an event, and what it must be.
struct AttributeTest {
  const Attribute* attribute = nullptr;
  Test test;
};

/// One event that counts.
struct Cause {
  int event = -1;  ///< of the attempt's EventWatches
  enum class On { anything, these, others } on = On::anything;
  std::vector<BodyId> bodies;
  std::vector<int> vessels;
  std::vector<AttributeTest> attributes;
  Condition while_true;
  std::string detail;  ///< what results add; empty: nothing of its own

  bool concerns(const sim::Model& model, const EventInstance& h) const;
  bool matches(const Snapshot& snapshot, const EventInstance& h) const;
};

class Act {
 public:
  bool there() const { return !m_causes.empty(); }
  /// The first cause that what happened is one of; null: none.
  const Cause* of(int event, const Snapshot& snapshot, const EventInstance& h) const;
  const std::vector<Cause>& causes() const { return m_causes; }
  /// Can it happen at all? Not where it is only asked for on no body.
  bool possible() const;

 private:
  friend class ActReader;
  std::vector<Cause> m_causes;
};

Act read_act(const scene::JsonValue& value, const RuleReading& reading);

}  // namespace trocar::training
