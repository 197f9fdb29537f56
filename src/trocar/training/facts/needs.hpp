// What a scene lacks for facts and events, in words for people; empty: nothing.
#pragma once

#include <string_view>

#include <trocar/sim/model/model.hpp>

namespace trocar::training {

inline std::string_view needs_energy(const sim::Model& model) { return model.energy.there ? "" : "energy"; }
inline std::string_view needs_fluids(const sim::Model& model) { return model.wet.there ? "" : "fluids"; }

}  // namespace trocar::training
