// A spring that heat has made shorter and stiffer: beside it, which stays as it is, a second one pulls its ends
// together or apart, so that both are as one of q times the stiffness k and s times the rest length l:
//   pull of the second = (q - 1) k |r| - (q s - 1) k l
// It is a load: the pull F as the ends stand, and against what it changes by within the tick T implicit dampers that
// hold each end to the mean velocity of both, 4 (q - 1) k T along the spring and 4 F T / |r| in all directions. So no
// body needs a shorter step, however large q: an end goes in a tick no further than half the way to the middle of what
// the pull wants from both. (All the way, with 2 for 4, is stable in a bar of such springs, but a curved wall in which
// burnt and raw ones lie side by side then shook for ever: nodes at 0.9 m/s.) What moves as a whole is not held back
// (it is no drag against space), but speeds up as if it were heavier by 4 (q - 1) k T^2 an end.
#pragma once

#include <trocar/interactions/couplings/loads.hpp>
#include <trocar/tissue/network/node_view.hpp>

namespace trocar::interactions {

struct ScarredSpring {
  int a = 0, b = 0;  ///< nodes
  double k = 0;      ///< as it was [N/m]
  double l = 0;      ///< rest length as it was [m]
  double share = 1;  ///< s
  double stiff = 1;  ///< q >= 1
};

/// Adds what the second spring does to both ends. A spring shorter than a quarter of l has no direction: nothing.
/// @param tick  T [s]
void pull_scarred(const tissue::NodeView& nodes, const ScarredSpring& spring, double tick,
                  NetworkLoads& loads) noexcept;

}  // namespace trocar::interactions
