// A hand that a haptic device leads, and that feels: between the simulation's ticks and the device's loop.
//
//   HapticHand hand(model, h, open_device(...), HapticHand::Pace::own_loop);
//   hand.lead(state, input);            // before a tick, on the simulation's thread: the device's place into the input
//   session.advance(input);
//   hand.after(state);                  // what it feels now
//
// What goes into the input is where the device is, as a mouse's way would; force never enters the step.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include <trocar/attempt/haptics/contact_modeller.hpp>
#include <trocar/core/json.hpp>
#include <trocar/devices/haptics/haptic_loop.hpp>

namespace trocar::attempt {

class HapticHand {
 public:
  /// own_loop: a thread at 1 kHz. with_ticks: one period a tick, however fast those are; for devices that are
  /// controlled.
  enum class Pace { own_loop, with_ticks };

  struct Feel {
    double scale = 1;           ///< of the instrument's way per the device's
    double seal_friction = -1;  ///< of the trocar [N]; below 0: what the scene says
  };

  /// @param device  open
  HapticHand(const sim::Model& model, int hand, std::unique_ptr<devices::HapticDevice> device, Pace pace,
             const Feel& feel);

  /// Before a tick: its hand's part of the input.
  void lead(const sim::State& state, sim::Input& input) noexcept;
  /// What the tick made of it.
  void after(const sim::State& state) noexcept;

  int hand() const noexcept { return m_hand; }
  double force() const noexcept { return m_force.load(std::memory_order_relaxed); }  ///< on the hand now [N]
  bool lost() const noexcept { return m_lost.load(std::memory_order_relaxed); }      ///< the device is silent
  /// "haptics" of a result: device, hand, forces, and of a loop its times.
  Json describe() const;

 private:
  bool hear(devices::HandReport& report) noexcept;
  void take_place(const sim::State& state, Vec3d tip) noexcept;
  void move_handle(std::uint32_t switches, bool grips) noexcept;
  void note(const devices::HandReport& report) noexcept;
  const devices::HapticCapabilities& can() const noexcept;
  Mat3d picture_axes(const sim::State& state) const noexcept;

  const sim::Model& m_model;
  int m_hand;
  Feel m_feel;
  ContactModeller m_modeller;
  std::unique_ptr<devices::HapticLoop> m_loop;      ///< own_loop
  std::unique_ptr<devices::HapticDevice> m_device;  ///< with_ticks
  std::unique_ptr<devices::ForceRenderer> m_renderer;

  // The simulation's thread's own.
  devices::HandReport m_report;
  devices::HandFrame m_frame;
  devices::LocalModel m_local;
  Vec3d m_wanted;  ///< place of the tip [m]
  double m_handle = 0, m_first_turn = 0, m_roll = 0;
  std::uint32_t m_switches = 0;
  int m_changes = 0;  ///< of instruments
  bool m_placed = false, m_locked = false;

  std::atomic<double> m_force{0}, m_most{0};
  std::atomic<bool> m_lost{false};
  double m_impulse = 0;  ///< [N s]
  std::uint64_t m_ticks = 0, m_damped = 0;
};

/// The hand of that name (a trocar's), or, where it is empty, that at the right.
/// @throws core::BadInput  under the name of `option`
int haptic_hand_of(const sim::Model& model, const std::string& name, const std::string& option);

}  // namespace trocar::attempt
