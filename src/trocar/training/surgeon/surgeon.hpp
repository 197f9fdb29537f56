// The automatic surgeon of a scene without a window: arms, a hand at the camera, and eyes that read the State as a
// surgeon would (where does the strand lie, how hard do I pull, do I see my jaws). Skills share one and write only its
// hands; it makes an Input of them.
//
//   op.begin_tick(model, state);
//   skill.tick(op);
//   sim::Input input = op.end_tick();
#pragma once

#include <array>
#include <optional>
#include <string>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/suture/knots/knots.hpp>
#include <trocar/training/surgeon/arms.hpp>
#include <trocar/training/surgeon/camera_hand.hpp>
#include <trocar/training/surgeon/posture.hpp>

namespace trocar::training {

namespace pace {
inline constexpr double kTravel = 0.045, kCareful = 0.018, kTrack = 0.004;  ///< [m/s] in the open, at tissue, after it
}
namespace reach {
inline constexpr double kIdle = 0.042;       ///< [m] depth of an instrument that waits under its trocar
inline constexpr double kBroughtIn = 0.085;  ///< [m] of one that was brought in
inline constexpr double kBefore = 0.022;     ///< [m] in front of tissue
}  // namespace reach

class Surgeon {
 public:
  Surgeon(const sim::Model& model, const Tremor& tremor);

  void begin_tick(const sim::Model& model, const sim::State& state);
  sim::Input end_tick();

  const sim::Model& model() const { return *m_model; }
  const sim::State& state() const { return *m_state; }
  Arms& arms() { return m_arms; }
  Arms::Arm& arm(int hand) { return m_arms[hand]; }
  const Arms::Arm& arm(int hand) const { return m_arms[hand]; }
  CameraHand& camera() { return m_camera; }

  // Eyes and fingers
  const interactions::ToolModel& tool(int hand) const { return m_model->tool(*m_state, size_t(hand)); }
  const interactions::ToolState& tool_state(int hand) const { return m_state->tools[size_t(hand)]; }
  bool sees_tip(int hand) const;            ///< one of the jaws' at least
  bool sees_jaws(int hand) const;           ///< both tips
  Vec3d point(int strand, double s) const;  ///< [m] at arc length s
  Vec3d tangent(int strand, double s) const;
  double radius(int strand, double s) const;
  bool severed(int strand) const { return cut_element(strand) >= 0; }
  int cut_element(int strand) const;  ///< the first that is parted; -1: none
  Vec3d sample_point(const sim::VisibilitySample& sample) const;
  Vec3d middle_of(int target) const;
  /// The place at `s` of a vessel, 0 to 1 along it, and which way it runs there.
  interactions::VesselSpot vessel_spot(int vessel, double s);
  /// Of the pool, where it is deepest and this hand's instrument can go straight to it.
  std::optional<Vec3d> deepest_pool(int hand) const;

  // What the camera shall show in this tick
  void want(Vec3d p);
  void want_all_of(int target);
  void from(double distance) { m_distance = distance; }  ///< of the lens to the nearest of it [m]
  /// With an oblique scope from the side to which this hand's instrument points, so that its tip is on the near side of
  /// what it works at; otherwise from above.
  void across(int hand) { m_facing = m_arms[hand].tip - m_arms[hand].port; }
  void want_nothing() { m_point_count = 0; }

  /// In this tick, aloud: what was to be shown is shown.
  void declare() { m_declares = true; }

  // What hands do
  /// Moves so that `at` would lie `inside` from the jaws' hinge, less `back` along the shaft, and turns the jaws across
  /// `along`. True when they are there.
  bool aim(int hand, Vec3d at, Vec3d along, double inside, double back, double speed);
  /// How the instrument would stand there, its jaws open as they are and its wrist straight.
  interactions::ToolShape shape_at(int hand, Vec3d at, Vec3d along, double inside) const;
  bool aim_at(int hand, int strand, double s, double inside, double back, double speed);
  /// The same to before the tissue: first the camera shows the tip, then it moves.
  /// @param waited  since it began to approach [s]
  bool approach(int hand, int strand, double s, double inside, double waited);
  /// An instrument goes back to under its trocar.
  void draw_back(int hand);
  /// All that hold nothing do, but for this one.
  void make_room(int but_hand);

  /// Where a hand was sent to last, for skills that continue there.
  struct Target {
    int strand = -1;
    double s = 0, inside = 0;  ///< [m]
  };
  Target& target(int hand) { return m_target[size_t(hand)]; }

  /// What thread is tied in, for skills that watch it.
  suture::KnownKnot& known_knot() { return m_knot; }

  /// What this hand holds up while others work. Not `up`: nothing.
  Posture& posture(int hand) { return m_posture[size_t(hand)]; }
  /// The hand that holds this strand up; -1: none does.
  int who_presents(int strand) const;
  /// One tick of keeping all that is held up as it should lie for work at `s`.
  void keep_postures(int strand, double s);
  /// Is it still held by its presenter? True without one.
  bool still_presented(int strand) const;

 private:
  const sim::Model* m_model = nullptr;
  const sim::State* m_state = nullptr;
  Arms m_arms;
  CameraHand m_camera;
  std::array<std::array<int, 2>, sim::kMaxTools> m_jaws{};  ///< (hands) targets of their tips
  std::array<Target, sim::kMaxTools> m_target{};
  std::array<Posture, sim::kMaxTools> m_posture{};
  suture::KnownKnot m_knot;
  std::array<Vec3d, 8> m_points{};
  int m_point_count = 0;
  double m_distance = 0;
  bool m_declares = false;
  std::optional<Vec3d> m_facing;
  std::vector<Vec3d> m_line;  ///< of the vessel that was asked for last, as it lies in this tick
  int m_posed_vessel = -1;
};

}  // namespace trocar::training
