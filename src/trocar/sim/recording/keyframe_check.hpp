// Does what a keyframe says name things that are there? A file may hold anything.
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::sim::keyframe {

/// Does every number in it name something that is there, have all cells a volume, and know neighbours each other?
bool sound(const geometry::CuttableTets& body);

/// Do instruments, endoscope, clips and cuts have finite places, and name tissue of this scene?
bool sound(const Model& model, const State& state);

}  // namespace trocar::sim::keyframe
