// A fact: a number or a truth of the Model and the State at a fixed tick, with a name, arguments, a unit and bounds,
// that exercises are judged by. Facts never read pixels or clocks and never change the State. What a fact remembers
// (how long something has bled, how far a tube was followed) is bounded and starts at nothing.
//
// A new fact is one file that defines a Fact, and one line in facts.inl.
//
//   Value horizon(const Snapshot& snapshot, const Arguments&) { return ...; }
//   extern const Fact kScopeHorizon{"scope.horizon_deg", {}, -180, 180, "how far the picture is turned ...",
//                                   anywhere, &stateless<horizon>};
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/training/facts/argument.hpp>
#include <trocar/training/facts/value.hpp>

namespace trocar::training {

struct EventInstance;

/// What there is to see at a tick.
struct Snapshot {
  const sim::Model& model;
  const sim::State& state;

  double now() const { return double(state.tick) * sim::kTick; }  ///< [s]
};

/// One fact with its arguments, in one attempt. Called in this order within a tick.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void happened(const Snapshot&) {}        ///< in ticks that report an event
  virtual void sample(const Snapshot&, double) {}  ///< fifty times a second; how long since the last time [s]
  virtual Value value(const Snapshot& snapshot) const = 0;
  /// What it would say if this happened now; for those whose memory events change.
  virtual Value foretold(const Snapshot& snapshot, const EventInstance&) const { return value(snapshot); }
};

struct Fact {
  std::string_view name;
  std::vector<Parameter> parameters;
  double low = 0, high = 1;  ///< of its value, in the unit that its name ends in
  std::string_view meaning;  ///< what it is, and when it is unknown
  /// What a scene lacks for it, for people; empty: nothing.
  std::string_view (*lacks)(const sim::Model& model);
  std::unique_ptr<Observer> (*watch)(const sim::Model& model, const Arguments& arguments);
  bool is_truth = false;
  /// Why these arguments can never be answered, for people ("expected ..., got ..."); empty: they can. Null: all can.
  std::string (*refuses)(const sim::Model& model, const Arguments& arguments) = nullptr;
};

/// Every scene can answer it.
inline std::string_view anywhere(const sim::Model&) { return {}; }

/// A fact without memory.
template <Value (*fact)(const Snapshot&, const Arguments&)>
std::unique_ptr<Observer> stateless(const sim::Model&, const Arguments& arguments) {
  class Stateless final : public Observer {
   public:
    explicit Stateless(const Arguments& a) : m_arguments(a) {}
    Value value(const Snapshot& snapshot) const override { return fact(snapshot, m_arguments); }

   private:
    Arguments m_arguments;
  };
  return std::make_unique<Stateless>(arguments);
}
/// A fact with memory: a class that is made of a Model and the arguments.
template <class Memory>
std::unique_ptr<Observer> remembering(const sim::Model& model, const Arguments& arguments) {
  return std::make_unique<Memory>(model, arguments);
}

}  // namespace trocar::training
