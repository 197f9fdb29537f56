// What the hands do wrong, whatever the exercise is about: pull or pinch too hard, lose their grip, move or push in
// where the camera does not look, strike each other. Each watch is asked at its rate and adds incidents;
// the files of events/ make events of them.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <trocar/sim/stages/step.hpp>

namespace trocar::training {

/// What counts as rough or careless, in SI.
struct Handling {
  double pull_limit = 0, pull_limit_other = 0, pull_excursion = 0;
  double pinch_limit = 0, pinch_impulse = 0;
  double blind_time = 0, blind_speed = 0;
  double collision_speed = 0, insertion_depth = 0;
};

struct Incident {
  enum Kind {
    overpulled,
    torn,
    overpinched,
    moved_blind,
    inserted_blind,
    collided,
    idle,         ///< a pedal is pressed beside nothing
    off_target,   ///< current through tissue that was not to be treated
    never_there,  ///< ... or that never may be
    hot_tip,
    spread,
  } kind = overpulled;
  int hand = -1;
  Vec3d where;
  const char* detail = "";
};

/// Incidents of one tick.
struct Incidents {
  std::array<Incident, 16> list;
  int count = 0;
  bool lost = false;  ///< some did not fit
  void add(const Incident& m) {
    lost = lost || count == int(list.size());
    if (count < int(list.size())) list[size_t(count++)] = m;
  }
};

inline bool has(const std::vector<BodyId>& list, BodyId body) {
  return std::find(list.begin(), list.end(), body) != list.end();
}

/// Bodies of the scene that bear little.
struct Tissues {
  std::vector<BodyId> delicate, bowel;
};

/// Over-forces, one an excursion. Asked every tick.
class PullWatch {
 public:
  void update(const Handling& limits, const Tissues& tissues, const sim::Model& model, const sim::State& state,
              Incidents& out);

 private:
  std::array<double, sim::kMaxTools> m_over_for{};
};

/// Tissue that tears by a hand, once a body for as long as it continues tearing.
class TearWatch {
 public:
  void update(const sim::Model& model, const sim::State& state, const sim::StepReport& report, Incidents& out);

 private:
  struct Torn {
    BodyId body;
    std::uint64_t tick = 0;  ///< when last
  };
  std::vector<Torn> m_torn;
};

/// Bowel pinched too hard or too long, each once a hold. Asked every tick.
class PinchWatch {
 public:
  void update(const Handling& limits, const Tissues& tissues, const sim::Model& model, const sim::State& state,
              Incidents& out);

 private:
  std::array<double, sim::kMaxTools> m_impulse{};
  std::array<bool, sim::kMaxTools> m_told{};
};

/// Instruments that move, or are brought in, where the camera does not look.
class SightWatch {
 public:
  explicit SightWatch(const sim::Model& model);
  void exchanged(int hand) { m_inserting[size_t(hand)] = true; }
  /// Once a sample of `dt` [s]; tips before and now.
  void update(const Handling& limits, const sim::Model& model, const sim::State& state,
              const std::array<Vec3d, sim::kMaxTools>& before, const std::array<Vec3d, sim::kMaxTools>& now, double dt,
              Incidents& out);

 private:
  struct Targets {
    int jaw[2] = {-1, -1}, shaft = -1;
  };
  std::array<Targets, sim::kMaxTools> m_targets;
  std::array<double, sim::kMaxTools> m_blind_for{};
  std::array<Vec3d, sim::kMaxTools> m_velocity{};  ///< smoothed: a tremor is no motion [m/s]
  std::array<bool, sim::kMaxTools> m_inserting{}, m_told{};
};

/// Instruments that strike each other, once a meeting.
class CollisionWatch {
 public:
  void update(const Handling& limits, const sim::Model& model, const sim::State& state, double dt, Incidents& out);

 private:
  using Parts = std::array<interactions::ToolShape, sim::kMaxTools>;
  Parts m_before{};
  std::array<std::array<bool, sim::kMaxTools>, sim::kMaxTools> m_touching{};
  bool m_begun = false;
};

}  // namespace trocar::training
