// Which of a room's arms carries which instrument of a scene, and where instruments are that hands hold: by their
// ports.
//
//   const RoomHands hands(room_model, scene_model);
//   room_model.lead(pose, link.arm, hands.goal(link, input));      // for (link : hands.links())
//   pose.tips = hands.tips(input);
#pragma once

#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/studies/operating_room/room_model.hpp>

namespace trocar::app {

class RoomHands {
 public:
  RoomHands(const studies::RoomModel& room, const sim::Model& scene);

  /// An arm at the port of one of the scene's hands, or of its endoscope.
  struct Link {
    int arm = -1, hand = -1;  ///< hand -1: the endoscope
  };
  const std::vector<Link>& links() const { return m_links; }

  /// Tip and turn of the jaws as the hands want them, and as they are: a bent instrument's where it is.
  studies::ArmGoal goal(const Link& link, const sim::Input& input) const;
  studies::ArmGoal goal(const Link& link, const sim::State& state) const;
  /// Tips of the room's instruments: of those at the port of a hand or the endoscope where these are, others as the
  /// room has them [m].
  std::vector<Vec3d> tips(const sim::Input& input) const;
  std::vector<Vec3d> tips(const sim::State& state) const;

  /// "left (-80, 75, -10); ...": the scene's hands and their ports [mm].
  std::string known() const;

 private:
  template <class Where>
  std::vector<Vec3d> tips_of(Where where) const;

  const studies::RoomModel& m_room;
  const sim::Model& m_scene;
  std::vector<Link> m_links;
  std::vector<int> m_held;  ///< (instruments of the room) hand, -1: the endoscope, kNobody
};

}  // namespace trocar::app
