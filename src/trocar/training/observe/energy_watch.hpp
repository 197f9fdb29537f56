// What current does where it should not: a pedal that is pressed beside nothing, current through tissue that was not to
// be treated or never may be, a tip still hot that touches such tissue, heat that has killed further from the electrode
// than it may. Reads State only. Silent in scenes without energy.
#pragma once

#include <array>
#include <vector>

#include <trocar/training/observe/watches.hpp>

namespace trocar::training {

/// What current may do, in SI.
struct EnergyLimits {
  double idle_time = 0;       ///< a pedal may be pressed beside nothing for this long [s]
  double hook_spread = 0;     ///< of dead tissue from a monopolar electrode's edge, at most [m]
  double bipolar_spread = 0;  ///< the same between jaws [m]
};

class EnergyWatch {
 public:
  /// @param targets  that may be treated  @param never  where it is critical
  EnergyWatch(std::vector<BodyId> targets, std::vector<BodyId> never);

  /// Every tick: pedals and current, each once an activation; hot tips, once a touch.
  void update(const EnergyLimits& limits, const sim::Model& model, const sim::State& state, Incidents& out);
  /// Now and then, as it takes up to a millisecond: spread, once a body.
  void look_at_spread(const sim::Model& model, const sim::State& state, Incidents& out);

 private:
  struct Activation {
    double idle_for = 0;  ///< [s]
    bool told_idle = false, told_place = false;
  };
  /// A tip that is hot: for how long it has touched, and since when it has not [s]. What current has just gone through
  /// is judged by that: not until the tip has left it is it touched again.
  struct HotTip {
    double touches_for = 0, away_for = 0;
    bool told = false;
    BodyId treated;
    double left_for = 0;  ///< that body [s]
  };
  /// A body that was treated: where, and how far from there it may die.
  struct Heated {
    BodyId body;
    int hand = -1;
    Vec3d where;         ///< the last place in the world [m]
    double allowed = 0;  ///< [m]
    bool told = false;
    std::vector<tissue::Treated> places;
  };
  void judge_touch(int hand, const sim::ElectrodeHand& electrode, Incidents& out);
  void judge_place(int hand, const sim::ElectrodeHand& electrode, Incidents& out);
  void note_place(int hand, const EnergyLimits& limits, const sim::Model& model, const sim::State& state);

  std::vector<BodyId> m_targets, m_never;
  std::array<Activation, sim::kMaxTools> m_activation{};
  std::array<HotTip, sim::kMaxTools> m_hot{};
  std::vector<Heated> m_heated;
};

}  // namespace trocar::training
