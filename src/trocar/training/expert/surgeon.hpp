// The expert who demonstrates an exercise: closed-loop, it looks at the State as an eye would (where is the tube, how
// does it lie, how hard do I pull, has the clip closed, can I see my instruments) and writes only Input, as hands do.
//
//   Surgeon surgeon(exercise, model);
//   while (!surgeon.done()) step(model, surgeon.next(model, state), state, work);
//
// It surveys, and then does one side after the other: whichever instrument is missing is fetched, the tube is followed
// from its fimbriae, grasped, lifted until a clip can stand across it; two clips, a cut, a look at the stumps. What has
// been reached is read from the State, so that a grip that slips or an approach that fails is simply tried again.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/exercise/following.hpp>
#include <trocar/training/expert/camera_hand.hpp>
#include <trocar/training/expert/expert.hpp>

namespace trocar::training {

class Surgeon final : public Expert {
 public:
  /// Throws core::BadInput when the scene lacks what the exercise names, or a hand the instrument it needs.
  Surgeon(const Exercise& exercise, const sim::Model& model, const Manner& manner = {});

  sim::Input next(const sim::Model& model, const sim::State& state) override;

  bool done() const override { return m_phase == Phase::finished; }
  bool gave_up() const override { return m_gave_up; }
  bool blundered() const { return m_blundered; }  ///< the flaw has been shown
  const char* doing() const override;

 private:
  enum class Phase {
    survey,
    decide,
    put_down,
    fetch,
    bring_in,
    identify,
    reach_ampulla,
    enter_ampulla,
    grasp,
    lift,
    reach_clip,
    enter_clip,
    inspect_clip,
    close_clip,
    open_clip,
    leave_clip,
    reach_cut,
    enter_cut,
    close_cut,
    open_cut,
    leave_cut,
    check,
    lower,
    let_go,
    withdraw,
    blunder,
    finished
  };
  struct Row {
    Phase phase;
    const char* doing;
    void (Surgeon::*run)();
    double patience;  ///< [s]
    Phase otherwise;  ///< where to go when it is lost
  };
  static const Row kRows[];
  static const Row& row(Phase phase);

  /// What belongs to one side, as indices.
  struct SideWork {
    int tube = -1, grasper = -1, scissors = -1;  ///< strand; hands
    int fimbria_target = -1, trace_target = -1;
    double ampulla_from = 0, ampulla_to = 0;
    Following following;
    bool looked_at_stumps = false;
    bool given_up = false;
  };
  struct LookedFor {
    int target = -1;
    double share = 0.5, seen_for = 0;
  };

  // Phases: surgeon_phases.cpp
  void survey();
  void decide();
  void put_down();
  void fetch();
  void bring_in();
  void identify();
  void reach_ampulla();
  void enter_ampulla();
  void grasp();
  void lift();
  void reach_clip();
  void enter_clip();
  void inspect_clip();
  void close_clip();
  void open_clip();
  void leave_clip();
  void reach_cut();
  void enter_cut();
  void close_cut();
  void open_cut();
  void leave_cut();
  void check();
  void lower();
  void let_go();
  void withdraw();
  void blunder();
  void pinch_bowel();
  void finish() {}

  // What the eye and the fingers tell: surgeon.cpp
  SideWork& side() { return m_sides[size_t(m_side)]; }
  const SideWork& side() const { return m_sides[size_t(m_side)]; }
  const interactions::ToolModel& tool(int hand) const { return m_model->tool(*m_state, size_t(hand)); }
  const interactions::ToolState& tool_state(int hand) const { return m_state->tools[size_t(hand)]; }
  Vec3d tube_point(double s) const;
  Vec3d tube_tangent(double s) const;
  double pull() const;   ///< of the grasper of this side [N]
  bool holding() const;  ///< the tube, beyond the isthmus
  bool severed() const;
  int cut_element() const;
  bool sees_tip(int hand) const;
  bool sees_jaws(int hand) const;          ///< both tips
  double slant(int hand, double s) const;  ///< of the shaft along the tube: sine of the angle, + when it dips outwards
  double wanted_slant() const;             ///< 0 but for a flaw
  double next_clip_at() const;             ///< where the next clip belongs; -1 when both are there
  double cut_at() const;
  double outermost_clip() const;
  Vec3d sample_point(const sim::VisibilitySample& sample) const;
  Vec3d centre_of(int target) const;
  void want_all_of(int target);  ///< in the picture
  Vec3d work_place() const;
  Vec3d other_side() const;             ///< where the eye sees nothing of this side's tube
  double from_strands(Vec3d at) const;  ///< [m]

  bool clip_fits() const;  ///< whole tube between the legs, across, in view
  double clip_inside() const;
  double cut_inside() const;

  // What hands do: surgeon.cpp
  void go(Phase next);
  /// Moves so that the tube at s would lie `inside` from the hinge, less `back` along the shaft. True when there.
  bool aim(int hand, double s, double inside, double back, double speed);
  /// The same through the open: first the camera shows the tip, then it moves.
  bool approach(int hand, double s, double inside, double speed);
  void clear_the_way(int hand);  ///< an idle instrument goes back to its trocar
  void keep_presented();         ///< pull and angle of the held tube
  void hold_askew();             ///< a flaw
  void keep_across();            ///< the same, for the applier
  void look_at_clip();
  void show();
  bool flawed(const char* code) const { return !m_blundered && m_manner.flaw == code; }

  Exercise m_exercise;
  Manner m_manner;
  const sim::Model* m_model = nullptr;  ///< set while next() runs
  const sim::State* m_state = nullptr;
  Phase m_phase = Phase::survey;
  double m_in_phase = 0, m_on_side = 0, m_steady = 0;  ///< [s]
  bool m_gave_up = false, m_blundered = false;
  std::vector<SideWork> m_sides;
  std::vector<LookedFor> m_survey;
  int m_side = 0, m_applier = -1, m_uterus_target = -1;
  std::array<std::array<int, 3>, sim::kMaxTools> m_eyes{};  ///< (hands) targets of both jaws and the shaft
  int m_strand = -1;                                        ///< that is worked on in this tick
  int m_target_strand = -1;                                 ///< a wrong one, when that is the flaw
  int m_stage = 0;                                          ///< of a blunder
  Vec3d m_bowel_at, m_bowel_along;
  int m_clips_before = -1, m_clip_tries = 0, m_failed_clips = 0;
  int m_fetching = -1;  ///< hand that changes its instrument
  int m_wanted = 0;     ///< number in its rack
  int m_attempts = 0;   ///< at the present task
  double m_clip_place = 0, m_cut_place = 0, m_grasp_at = 0;
  Vec3d m_lift_from, m_lift_up, m_outwards, m_left_from;
  double m_lifted = 0, m_drawn = 0;  ///< how far the tube was raised and drawn outwards [m]
  double m_spare = 0.001;            ///< between the tube and the clip's bend [m]
  double m_unseen = 0;               ///< for how long the clip's tips have not been seen at this try [s]
  Arms m_arms;
  CameraHand m_camera;
  std::array<Vec3d, 8> m_points{};  ///< what the camera shall show
  int m_point_count = 0;
  double m_distance = 0.06;
  double m_seen_from = 0.06;  ///< [m] where the camera saw the legs
  void want(Vec3d p) {
    if (m_point_count < int(m_points.size())) m_points[size_t(m_point_count++)] = p;
  }
};

}  // namespace trocar::training
