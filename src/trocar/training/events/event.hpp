// An event: something that happened in a tick, with attributes. Some are what the step reports (grasped, cut), some are
// detected by watching the State (pulled too hard for too long). Exercises name them to say which acts count.
//
// A new event is one file that defines an EventKind, and one line in events.inl.
#pragma once

#include <array>

#include <trocar/sim/model/step_report.hpp>
#include <trocar/training/facts/event_instance.hpp>
#include <trocar/training/facts/fact.hpp>

namespace trocar::training {

/// What would happen if a hand did now what it is about to do.
struct Foreseen {
  EventInstance instance;
  interactions::Clip clip;  ///< that the instance points at
};

/// Those of one kind in a tick, of which the step reports at most as many.
struct EventInstances {
  std::array<EventInstance, sim::kMaxEvents> list;
  int count = 0;
  bool lost = false;  ///< some did not fit, ever
  void add(const EventInstance& h) {
    lost = lost || count == int(list.size());
    if (count < int(list.size())) list[size_t(count++)] = h;
  }
};

/// Detects one kind of event with its arguments, in one attempt.
class EventDetector {
 public:
  virtual ~EventDetector() = default;
  virtual void tick(const Snapshot&, const sim::StepReport&, EventInstances&) {}
  /// Fifty times a second; how long since the last time [s].
  virtual void sample(const Snapshot&, double, EventInstances&) {}
};

/// A number or a truth value of one event.
struct Attribute {
  std::string_view name;
  std::string_view meaning;
  Value (*value)(const Snapshot& snapshot, const EventInstance& h);
  double low = 0, high = 1;  ///< that it can be, in the unit that its name ends in
  bool is_truth = false, is_count = false;
};

inline constexpr double kLongest = 1000;  ///< [mm] along or between strands

struct EventKind {
  /// Does it happen to what a hand holds, or held just before?
  enum class Hold { none, now, before };

  std::string_view name;
  std::vector<Parameter> parameters;
  std::vector<Attribute> attributes;
  std::string_view meaning;
  std::string_view (*lacks)(const sim::Model& model);
  std::unique_ptr<EventDetector> (*watch)(const sim::Model& model, const Arguments& arguments);
  bool has_body = false;  ///< it happens to a body: rules may ask for "on"
  Hold of_hold = Hold::none;
  /// What this hand is about to do; false: nothing of this kind. Null: it cannot be foreseen.
  bool (*foresee)(const Snapshot& snapshot, int hand, Foreseen& out) = nullptr;
};

template <class N>
std::unique_ptr<EventDetector> make_detector(const sim::Model& model, const Arguments& arguments) {
  return std::make_unique<N>(model, arguments);
}

/// The name of a body; null for kNoBody.
const std::string* name_of_body(const sim::Model& model, BodyId body);

}  // namespace trocar::training
