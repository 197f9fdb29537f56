// Is a scene in equilibrium when nobody touches it? Drawn shapes are equilibria, but one that its springs do not hold
// falls over: organs sag while the hands are still on their way.
//
//   const EquilibriumCheck equilibrium = check_equilibrium(model, 1000);
//   for (const EquilibriumCheck::Organ& o : equilibrium.organs)
//     if (o.is_unstable()) say(in_words(equilibrium, o));
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::scene {

inline constexpr double kMaxSag = 5e-4;  ///< an organ that sags more does not hold its drawn shape [m]
inline constexpr double kMostPredicted = 8, kMostBeforeTraining = 1;  ///< [s] that a check may take, as predicted

struct EquilibriumCheck {
  struct Organ {
    std::string name;
    double off = 0;  ///< of its farthest node from where it was drawn [m]
    Vec3d at;        ///< where that was drawn [m]

    bool is_unstable() const { return !(off <= kMaxSag); }
  };
  std::vector<Organ> organs;  ///< (organs of the Model)
  sim::State state;           ///< at the end
  double seconds = 0;         ///< simulated

  bool is_stable() const;
};

/// Simulates a scene at rest, with instruments drawn back, without breathing, peristalsis and bleeding. For how long
/// follows from the scene alone, never from a clock, so that the answer is the same on every machine and run.
/// @param ticks  at most; a shape that its springs do not hold falls over within a second
/// @param most   [s] at most, as predicted_us() has it: fewer ticks of a heavy scene, at least 20
EquilibriumCheck check_equilibrium(const sim::Model& model, std::uint64_t ticks, double most = kMostPredicted);

/// "uterus is not in equilibrium: it sagged 32.5 mm at (0.0, -150.0, -60.0) mm after 1.0 s at rest (a stiffer or
/// lighter tissue, larger cells or more anchors may hold it)"
std::string in_words(const EquilibriumCheck& equilibrium, const EquilibriumCheck::Organ& organ);

/// Simulates half a second, of a heavy scene less, and warns on stderr of organs that sag: a trainee would take that
/// for the exercise.
void warn_if_unstable(const sim::Model& model);

}  // namespace trocar::scene
