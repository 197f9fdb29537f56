// Organs whose file says "solver": "static": they answer at once (tissue/elastostatic/elastostatic.hpp) and not step by
// step, until they are handed over to their own network, for good. Everything else about them is as of any organ: the
// solver writes the rows of its nodes, which is all that others see of it.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/elastostatic/elastostatic.hpp>

namespace trocar::sim {

inline constexpr std::uint32_t kFadeTicks = 100;  ///< in which the difference between both solvers comes in

/// What the elastostatic solver is, of an organ.
struct StaticOrgan {
  std::int32_t organ = -1;
  tissue::ElastostaticModel solver;
  double beyond = 0;        ///< ElastostaticState::turn that is too much for it [rad]
  bool hands_over = false;  ///< then; else it is only told

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("organ", s.organ), v("solver", s.solver), v("beyond", s.beyond), v("hands_over", s.hands_over);
  }
};

struct StaticOrganState {
  tissue::ElastostaticState body;
  std::uint32_t handed_over = 0;  ///< ticks since, at most kFadeTicks + 1; 0: it has not been

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

}  // namespace trocar::sim
