// Tissue that is stiffer in some places than in others: a factor by place, that the springs' middles are asked for.
#pragma once

#include <functional>

#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

/// Times the tissue's stiffness, > 0, at a drawn place [m]. Empty: 1 everywhere.
using StiffnessField = std::function<double(Vec3d place)>;

/// Every spring's stiffness and damping, by the factor at its middle in the drawn shape. The volume force stays as it
/// is.
inline void stiffen(NetworkDescription& network, const StiffnessField& field) {
  if (!field) return;
  for (SpringDescription& s : network.springs) {
    const Vec3d middle = 0.5 * (network.positions[std::size_t(s.a)] + network.positions[std::size_t(s.b)]);
    const double factor = field(middle);
    s.k *= factor;
    s.damping *= factor;
  }
}

}  // namespace trocar::tissue
