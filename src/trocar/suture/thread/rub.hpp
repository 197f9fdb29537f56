// What friction remembers from one solve to the next: the strain of a tangential spring, which yields at the friction's
// bound. So what sticks does not creep.
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::suture {

/// What friction remembers of two things that touch: the strain of their tangential spring.
struct Rub {
  Vec3d strain{0, 0, 0};  ///< across the normal [m]
  double reached = 0;     ///< size of strain and slip together in the last solve [m]
  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("strain", s.strain), v("reached", s.reached);
  }
};
/// Of two elements of the thread. Elements a < b, or an element a and the obstacle b.
struct ElementRub {
  std::int32_t a = 0, b = 0;
  Rub rub;
  double press = 0;  ///< [N] in the last solve
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("a", s.a), v("b", s.b), v("rub", s.rub), v("press", s.press);
  }
};

}  // namespace trocar::suture
