// The expert who demonstrates bleeding control: waits, sees where it bleeds, brings the clip applier, sets a clip on
// the heart's side of the place and one beyond it, draws the applier back, sucks away what has gathered and looks
// whether the place stays dry.
//
//   BleedingSurgeon surgeon(exercise, model);
//   while (!surgeon.done()) step(model, surgeon.next(model, state), state, work);
#pragma once

#include <array>
#include <optional>

#include <trocar/sim/model/host_views.hpp>
#include <trocar/training/expert/camera_hand.hpp>
#include <trocar/training/expert/expert.hpp>

namespace trocar::training {

class BleedingSurgeon final : public Expert {
 public:
  /// Throws core::BadInput when no hand begins with the clip applier, or nothing in the scene opens by itself.
  BleedingSurgeon(const Exercise& exercise, const sim::Model& model, const Manner& manner = {});

  sim::Input next(const sim::Model& model, const sim::State& state) override;
  bool done() const override { return m_phase == Phase::finished; }
  bool gave_up() const override { return m_gave_up; }
  const char* doing() const override;

 private:
  enum class Phase {
    watch,
    blunder,
    find,
    reach,
    enter,
    inspect,
    close,
    open,
    leave,
    change,
    fetch,
    bring,
    suck,
    check,
    finished
  };

  // Phases
  void watch();
  void blunder();
  void find();
  void reach();
  void enter();
  void inspect();
  void close();
  void open();
  void leave();
  void change();
  void fetch();
  void bring();
  void suck();
  void check();

  void go(Phase next);
  /// The next clip: on which side of the place; false: both are there.
  bool choose_side();
  bool has_clip(bool upstream) const;
  const interactions::VesselPath& path() const;
  /// Where the artery is at `s`, 0 to 1 along it, and which way it runs there.
  interactions::VesselSpot spot(double s) const;
  Vec3d point(double s) const { return spot(s).place; }
  double clip_at() const;  ///< place of the clip that is being set, likewise
  Vec3d place() const;     ///< that bleeds
  /// To where m_carrier lies `inside` the legs, less `back` along the shaft, and across it.
  bool aim(double back, double speed);
  double inside() const;
  bool sees_jaw() const;
  void look_at_clip();
  void draw_back_others();
  bool free_way(Vec3d to) const;
  std::optional<Vec3d> deepest() const;  ///< in the pool, where it is deepest and can be reached
  bool flawed(const char* code) const { return m_manner.flaw == code; }
  bool errs(const char* code) const { return flawed(code) && !m_blundered; }  ///< this mistake is still to be made
  double lost() const;                                                        ///< blood [m^3]
  bool waits() const;                                                         ///< longer than an expert would: a flaw
  bool burns() const { return flawed("E6") || flawed("E7") || flawed("E7.1") || flawed("E7.2") || flawed("E8"); }
  Vec3d burnt() const;  ///< what a hook is held to, as a flaw
  /// What the legs shall take: middle, direction, radius.
  struct Carrier {
    Vec3d place, along;
    double radius = 0;
  };
  Carrier clipped() const;  ///< what carries the artery there, but for a flaw
  Carrier elsewhere() const;
  Carrier on_strand(int strand, interactions::StrandPlace place) const;
  bool between_legs() const;
  void learn_from_a_miss();
  void want(Vec3d p) { m_points[size_t(m_point_count < 7 ? m_point_count++ : 7)] = p; }

  const BleedingControl& m_goal;
  Manner m_manner;
  const sim::Model* m_model = nullptr;
  const sim::State* m_state = nullptr;
  int m_applier = -1, m_sucker = -1, m_bore = -1;  ///< hands, and the suction-irrigator's number in its rack; -1: none
  int m_hook = -1;                                 ///< in the same rack, for flaws
  int m_stage = 0;                                 ///< of a blunder
  bool m_blundered = false;
  int m_jaws[2] = {-1, -1};  ///< targets of visibility
  sim::HostViews m_hosts;
  std::vector<Vec3d> m_artery;  ///< where its line is in this tick
  Phase m_phase = Phase::watch;
  bool m_upstream = true, m_gave_up = false;
  int m_tries = 0, m_clips_before = 0;
  Carrier m_carrier;       ///< as it lay before the legs touched it: who follows tissue that they push drags it along
  Vec3d m_aside{0, 0, 0};  ///< learnt from misses: where the legs must go instead [m]
  double m_in_phase = 0, m_steady = 0, m_unseen = 0;  ///< [s]
  Arms m_arms;
  CameraHand m_camera;
  std::array<Vec3d, 8> m_points{};
  int m_point_count = 0;
  double m_distance = 0.06;   ///< of the lens from what it shows [m]
  double m_seen_from = 0.06;  ///< [m] where the camera saw the legs
};

}  // namespace trocar::training
