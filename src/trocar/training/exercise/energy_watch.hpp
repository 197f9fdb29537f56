// What current does where it should not: a pedal that is pressed beside nothing (E6), current through tissue that was
// not to be treated (E7) or never may be (E7.1), a tip still hot that touches such tissue (E7.2), heat that has killed
// farther from the electrode than it may (E8).
// Reads State only. Silent in scenes without energy.
#pragma once

#include <array>
#include <vector>

#include <trocar/training/exercise/watches.hpp>

namespace trocar::training {

class EnergyWatch {
 public:
  /// Bodies as holds number them. @param targets  that may be treated  @param never  where it is critical
  EnergyWatch(std::vector<std::int32_t> targets, std::vector<std::int32_t> never);

  /// Every tick: E6, E7, E7.1, each once an activation; E7.2 once a touch.
  void update(const EnergyLimits& limits, const sim::Model& model, const sim::State& state, Mishaps& out);
  /// Now and then, as it takes up to a millisecond: E8, once a body.
  void look_at_spread(const sim::Model& model, const sim::State& state, Mishaps& out);

 private:
  struct Activation {
    double idle_for = 0;  ///< [s]
    bool told_idle = false, told_place = false;
  };
  /// A body that was treated: where, and how far from there it may die.
  struct Heated {
    std::int32_t body = -1;
    int hand = -1;
    Vec3d where;         ///< the last place in the world [m]
    double allowed = 0;  ///< [m]
    bool told = false;
    std::vector<tissue::Treated> places;
  };
  void judge_touch(int hand, const sim::ElectrodeHand& electrode, Mishaps& out);
  void judge_place(int hand, const sim::ElectrodeHand& electrode, Mishaps& out);
  void note_place(int hand, const EnergyLimits& limits, const sim::Model& model, const sim::State& state);

  std::vector<std::int32_t> m_targets, m_never;
  std::array<Activation, sim::kMaxTools> m_activation{};
  std::array<double, sim::kMaxTools> m_hot_for{};  ///< that a hot tip has been touching [s]
  std::vector<Heated> m_heated;
};

}  // namespace trocar::training
