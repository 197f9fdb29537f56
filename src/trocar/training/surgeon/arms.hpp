// The demonstration's hands: tips that move at a hand's pace towards where they are wanted, wrists that turn,
// handles that close, and the tremor that all hands have.
#pragma once

#include <array>
#include <optional>

#include <trocar/core/random.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// Physiological tremor of a hand at rest or at slow work: 8 to 12 Hz; its size at the tip is our choice.
struct Tremor {
  double rms = 0;  ///< at the tip along each axis [m]
  std::uint64_t seed = 0;
};

class Arms {
 public:
  Arms(const sim::Model& model, const Tremor& tremor);

  /// A hand's intention: where the tip is wanted, how the jaws are turned, how far the handle is closed.
  struct Arm {
    Vec3d tip, port;
    double roll = 0, handle = 0;
    sim::WristInput wrist;  ///< of an instrument that bends; `tip` is then the straight one's
    std::int32_t instrument = 0;
    bool moving = false;                       ///< in this tick
    bool irrigating = false, sucking = false;  ///< valves of a suction-irrigator
    bool coagulating = false;                  ///< the blue pedal
  };
  Arm& operator[](int hand) { return m_arm[size_t(hand)]; }
  const Arm& operator[](int hand) const { return m_arm[size_t(hand)]; }
  int count() const { return m_count; }

  void begin_tick();
  /// From now on the hands tremble so; it fades in after the old tremor has faded out.
  void tremble(const Tremor& tremor) { m_next = tremor; }
  /// One tick towards `goal`, slower near it. True when it is there.
  bool move(int hand, Vec3d goal, double speed);
  /// One tick along the shaft towards `depth` [m from the trocar].
  bool move_to_depth(int hand, double depth, double speed);
  /// One tick of turning the jaws so that their plane stands across `direction`. True when they do.
  bool turn_across(int hand, Vec3d direction);
  /// One tick of bending a wrist. True when it is bent so.
  bool bend(int hand, const sim::WristInput& to);
  /// One tick of closing or opening the handle, all the way in `seconds`.
  bool grip(int hand, double to, double seconds);

  void fill(std::uint64_t tick, sim::Input& input) const;

 private:
  Vec3d tremor(int hand, std::uint64_t tick) const;
  void draw_waves(const Tremor& tremor);

  static constexpr int kWaves = 4;
  struct Wave {
    double rate = 0, phase = 0;  ///< [rad/s] [rad]
  };
  std::array<Arm, sim::kMaxTools> m_arm{};
  std::array<std::array<std::array<Wave, kWaves>, 3>, sim::kMaxTools> m_wave{};
  double m_amplitude = 0, m_wanted = 0;  ///< now, and after it has faded in [m]
  std::optional<Tremor> m_next;
  int m_count = 0;
};

}  // namespace trocar::training
