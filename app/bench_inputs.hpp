// What benchmarks do to a scene: the hands' inputs, made once, so that every measurement does the same work.
#pragma once

#include <vector>

#include <trocar/sim/step.hpp>

namespace trocar::app {

struct Lesson;

/// Of a scripted operation, if the lesson is an exercise; else every hand goes to the tissue nearest to it, closes,
/// draws back, opens, and the next time 4 mm deeper.
/// @param seconds  of simulated time at most
std::vector<sim::Input> bench_inputs(const Lesson& lesson, double seconds);

}  // namespace trocar::app
