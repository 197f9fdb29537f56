// What a hand feels of the State, as a device can render it between ticks: planes through where the tissue holds the
// instrument back, a spring to what it holds, other instruments that are near. Reads the State and changes nothing: the
// step knows of no device, and a recording holds where the hand was.
//
// An instrument turns about its trocar, so that a force at `s` along its shaft is felt at the tip, at `d`, as s/d of it
// across the shaft and all of it along (interactions/instrument/lever.hpp has the same law for the handle).
#pragma once

#include <array>

#include <trocar/devices/haptics/local_model.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::attempt {

/// Of the tissue on the instrument, all at the tip [N].
struct TipForces {
  Vec3d contact;  ///< of what it touches
  Vec3d pull;     ///< of what it holds
};
TipForces forces_at_tip(const sim::Model& model, const sim::State& state, int hand) noexcept;

/// How stiff what pushes is: force against way over the last ticks, where the way says anything.
class StiffnessEstimate {
 public:
  explicit StiffnessEstimate(double usual) : m_usual(usual), m_stiffness(usual) {}

  /// @param place, force  along the same direction, the force against growing places [m], [N]
  void add(double place, double force) noexcept;
  void forget() noexcept { *this = StiffnessEstimate(m_usual); }
  double stiffness() const noexcept { return m_stiffness; }  ///< [N/m]

 private:
  static constexpr int kTicks = 16;
  double m_usual, m_stiffness;
  std::array<double, kTicks> m_place{}, m_force{};
  int m_count = 0;
};

class ContactModeller {
 public:
  ContactModeller(const sim::Model& model, int hand) : m_model(model), m_hand(hand) {}

  /// After a tick. @param wanted  where the hand wants the tip: the place that forces are reported for [m]
  /// @param seal  friction of the trocar's seal [N]
  devices::LocalModel of(const sim::State& state, Vec3d wanted, double seal) noexcept;

 private:
  void touch(const sim::State& state, Vec3d wanted, Vec3d force, devices::LocalModel& out) noexcept;
  void hold(Vec3d wanted, Vec3d pull, devices::LocalModel& out) noexcept;
  void meet_instruments(const sim::State& state, devices::LocalModel& out) const noexcept;

  const sim::Model& m_model;
  int m_hand;
  Vec3d averaged(Vec3d contact) noexcept;

  StiffnessEstimate m_touched{200}, m_held{150};
  std::array<Vec3d, 4> m_last{};  ///< contact forces of the last ticks
  int m_ticks = 0;
  Vec3d m_normal, m_along;  ///< of the last tick's contact, of the last tick's pull
};

}  // namespace trocar::attempt
