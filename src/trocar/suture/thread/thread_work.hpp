// Scratch of a thread's tick: filling it with rubbish between ticks changes nothing.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/suture/thread/block_system.hpp>
#include <trocar/suture/thread/rub.hpp>

namespace trocar::suture {

/// Two elements a < b, or an element a and the obstacle b, that are near enough to be looked at.
struct NearPair {
  std::int32_t a = 0, b = 0;
};

/// Two of them that touch, as a solve sees it.
struct Touch {
  std::int32_t a = 0, b = 0;
  double s = 0, t = 0;       ///< places on both, 0..1
  Vec3d normal{0, 0, 0};     ///< unit, from the second to the first
  double press = 0;          ///< [N]
  double stiffness = 0;      ///< of the press [N/m]
  double rub_stiffness = 0;  ///< of friction in this solve [N/m]
  double bound = 0;          ///< that friction's strain does not exceed [m]
  Vec3d strain{0, 0, 0};     ///< of friction: when the solve begins, then when it ends [m]
  double reached = 0;        ///< [m]
  Vec3d force{0, 0, 0};      ///< on the first, as the solve has it [N]
  Vec3d moved{0, 0, 0};      ///< what the obstacle's point moves in this solve [m]
};

struct ThreadWork {
  BlockSystem system;
  std::vector<Vec3d> delta;                      ///< (n) what nodes move in a solve
  std::vector<double> length;                    ///< (n - 1) of elements [m]
  std::vector<Vec3d> along;                      ///< (n - 1) their directions
  std::vector<Vec3d> node_along, node_director;  ///< (n) direction and material's director at inner nodes
  std::vector<Vec3d> bend_now, bend_rest;        ///< (n) difference of directions there, and the one at rest
  std::vector<Vec3d> box;                        ///< (groups x 2) corners of groups of elements
  std::vector<NearPair> near;                    ///< thread on thread, in no order, then by (a, b)
  std::vector<std::int64_t> keys;
  std::vector<std::int32_t> close;                    ///< (obstacles) near a group of elements
  std::vector<Touch> self, touch;                     ///< (contacts)
  std::vector<ElementRub> rubs;                       ///< (contacts)
  std::vector<double> spin_diagonal, spin_off, spin;  ///< (n - 1)
  std::vector<Vec3d> obstacle_moves;                  ///< (obstacles x 2) what their ends move in this solve
  std::vector<Vec3d> pull;                            ///< (obstacles x 2) force and moment

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("system", s.system), v("delta", s.delta), v("length", s.length), v("along", s.along),
        v("node_along", s.node_along), v("node_director", s.node_director), v("bend_now", s.bend_now),
        v("bend_rest", s.bend_rest), v("box", s.box), v("near", s.near), v("keys", s.keys), v("close", s.close),
        v("self", s.self), v("touch", s.touch), v("rubs", s.rubs), v("spin_diagonal", s.spin_diagonal),
        v("spin_off", s.spin_off), v("spin", s.spin), v("obstacle_moves", s.obstacle_moves), v("pull", s.pull);
  }
};

}  // namespace trocar::suture
