// What an attempt's conditions look at: every fact with its arguments once, however many conditions ask for it. Facts
// that nobody asks for are not there.
//
//   FactWatches watches;  Condition c = read_condition(value, reading);   // reading.facts = &watches
//   ... every tick: watches.tick(look, report);  every sample: watches.sample(look, dt);  then c.holds(look)
#pragma once

#include <deque>

#include <trocar/sim/model/step_report.hpp>
#include <trocar/training/events/event.hpp>
#include <trocar/training/facts/fact.hpp>

namespace trocar::training {

/// Facts that differ in an exercise, and events; each is looked at in every sample.
inline constexpr std::size_t kMostWatched = 4096;

class FactWatches {
 public:
  /// The number of an observer; equal ones are one.
  int watch(const Fact& fact, const Arguments& arguments, const sim::Model& model);

  /// Every tick, before any condition is asked: memory that changes with events only is brought up to date.
  void tick(const Snapshot& snapshot, const sim::StepReport& report);
  /// Fifty times a second. @param dt  since the last time [s]
  void sample(const Snapshot& snapshot, double dt);

  Value value(int watch, const Snapshot& snapshot) const { return m_watched[size_t(watch)].observer->value(snapshot); }
  /// What it would be if this happened now.
  Value foretold(int watch, const Snapshot& snapshot, const EventInstance& instance) const {
    return m_watched[size_t(watch)].observer->foretold(snapshot, instance);
  }

  struct Watched {
    const Fact* fact;
    Arguments arguments;
    std::unique_ptr<Observer> observer;
  };
  const std::deque<Watched>& all() const { return m_watched; }

 private:
  std::deque<Watched> m_watched;
  std::int32_t m_clips = 0, m_cuts = 0;  ///< in the State's buffers
};

/// Every event with its arguments once; the same for acts.
class EventWatches {
 public:
  int watch(const EventKind& event, const Arguments& arguments, const sim::Model& model);

  /// Every tick: what has happened of each kind, in the order in which they were first asked for.
  template <class Visit>
  void tick(const Snapshot& snapshot, const sim::StepReport& report, Visit&& visit) {
    for (size_t i = 0; i < m_watched.size(); ++i) {
      m_happened.count = 0;
      m_watched[i].detector->tick(snapshot, report, m_happened);
      for (int k = 0; k < m_happened.count; ++k) visit(int(i), m_happened.list[size_t(k)]);
    }
  }
  /// Fifty times a second, the same.
  template <class Visit>
  void sample(const Snapshot& snapshot, double dt, Visit&& visit) {
    for (size_t i = 0; i < m_watched.size(); ++i) {
      m_happened.count = 0;
      m_watched[i].detector->sample(snapshot, dt, m_happened);
      for (int k = 0; k < m_happened.count; ++k) visit(int(i), m_happened.list[size_t(k)]);
    }
  }

  /// Were there more of one kind in a tick than are kept?
  bool lost() const { return m_happened.lost; }

  struct Watched {
    const EventKind* event;
    Arguments arguments;
    std::unique_ptr<EventDetector> detector;
  };
  const std::deque<Watched>& all() const { return m_watched; }

 private:
  std::deque<Watched> m_watched;
  EventInstances m_happened;
};

}  // namespace trocar::training
