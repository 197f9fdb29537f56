// Quasi-static organs, whose file says "solver": "static": their surface is solved once per tick
// (tissue/elastostatic/elastostatic.hpp), not integrated in time, until they switch to their own network permanently.
// Everything else is as for any organ: the solver writes the rows of its nodes, which is all that other code reads.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/elastostatic/elastostatic.hpp>

namespace trocar::interactions {

inline constexpr std::uint32_t kFadeTicks = 100;  ///< over which the difference between both solvers is added

/// The elastostatic solver of an organ.
struct StaticOrgan {
  std::int32_t organ = -1;
  tissue::ElastostaticModel solver;
  double beyond = 0;        ///< ElastostaticState::turn that is too much for it [rad]
  bool hands_over = false;  ///< then it switches to the network; else it only warns

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("organ", s.organ), v("solver", s.solver), v("beyond", s.beyond), v("hands_over", s.hands_over);
  }
};

struct StaticOrganState {
  tissue::ElastostaticState body;
  std::uint32_t handed_over = 0;  ///< ticks since the switch, at most kFadeTicks + 1; 0: no switch yet

  bool at_once() const noexcept { return handed_over == 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("handed_over", s.handed_over);
  }
};

struct StaticOrganWork {
  tissue::ElastostaticWork solver;
  std::vector<tissue::NodeState> before;  ///< (rows) at the beginning of a tick of the fade

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("solver", s.solver), v("before", s.before);
  }
};

}  // namespace trocar::interactions
