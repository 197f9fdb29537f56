// Where to put ports: pairs for the left and the right hand about a given port of the endoscope, out of a grid on the
// abdomen's skin, as [Cannon et al. 2003] choose triads from a grid by a measure of angles. What is asked of a pair,
// and by what source:
//
//   manipulation angle   between the shafts at the target: 60 degrees are best, 45 to 75 good
//                        [Hanna, Shimi & Cuschieri 1997]
//   azimuths             of each shaft from the optical axis, seen from in front: equal ones, to both sides [ibid.]
//   elevation            of each shaft out of the patient's plane: 60 degrees with that angle [ibid.]
//   lean                 of each shaft from the skin's normal: at most 60 degrees (our estimate)
//   lever                length in the body to length out of it: 1 is best, its half and double are halved
//                        (our estimate)
//   reach                share of the target's points within depth and lean (our estimate)
//   clearance            of handles to each other, to the endoscope and to the patient: 40 mm are enough (our estimate)
//   ways in              of the straight ways from a port to the target's points, those through organs that are not the
//                        target: where all are, a tenth is left (our choice; organs can be held aside)
//
// How wide each criterion is (kManipulationWidth, ...) is our choice. A score is the product, 0 to 1.
#pragma once

#include <string>
#include <vector>

#include <trocar/studies/operating_room/room_model.hpp>
#include <trocar/studies/operating_room/ways_in.hpp>

namespace trocar::studies {

struct PortPlanOptions {
  Vec3d low, high;                 ///< of the target box [m]
  std::string scope;               ///< port of the endoscope
  double spacing = 0.02;           ///< of the grid [m]
  double half_width = 0.14;        ///< of the field that is looked at, about the midline [m]
  double from = -0.14, to = 0.19;  ///< along y [m]
  double length = 0.310;           ///< of instruments, tip to handle [m]
  double apart = 0.05;             ///< least distance of ports [m]
  int sets = 5;                    ///< told, each of them with other ports
  std::vector<InTheWay> organs;    ///< that are not the target
  bool set_up = true;              ///< arms' bases are turned about their ports, as set-up joints let them
};

struct PortCandidate {
  Vec3d place, normal;
  double reach = 0, lean = 0, elevation = 0, azimuth = 0;  ///< at the target's middle [rad]
  double depth = 0, lever = 0;                             ///< [m]; in to out
  WaysIn ways;                                             ///< to the target's points
  double alone = 0;                                        ///< 0..1: reach, lever, elevation, ways in
  double best = 0;                                         ///< score of the best pair with it
};

struct PortPair {
  int left = 0, right = 0;  ///< candidates
  double score = 0;
  double manipulation = 0;                      ///< [rad]
  double clearance = 0, patient_clearance = 0;  ///< of handles [m]
  // where the room has two arms and they are docked there
  bool with_arms = false;
  double arms_reach = 0, arms_clearance = 0;  ///< share of corners and middle; least at those [m]
  double turned[2] = {0, 0};                  ///< of their bases about their ports, from where the room has them [rad]
  double rank = 0;                            ///< score, with arms times their reach and clearance
};

struct PortPlan {
  Vec3d scope, target;
  WaysIn sight;  ///< of the endoscope
  std::vector<Vec3d> points;
  std::vector<PortCandidate> candidates;
  std::vector<PortPair> pairs;  ///< the highest rank first
  int looked_at = 0;
};

/// What a pair is worth at a target; for tests and for ports that somebody has chosen.
PortPair judge_pair(const RoomModel& model, const PortPlanOptions& options, Vec3d scope, const PortCandidate& left,
                    const PortCandidate& right);
PortCandidate judge_port(const RoomModel& model, const PortPlanOptions& options, Vec3d scope, Vec3d place);

/// @throws std::invalid_argument where there is no such port
PortPlan plan_ports(const RoomModel& model, const PortPlanOptions& options);

}  // namespace trocar::studies
