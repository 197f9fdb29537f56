// What benchmarks do to a scene: the hands' inputs, made once, so that every measurement does the same work.
#pragma once

#include <vector>

#include <trocar/sim/stages/step.hpp>

namespace trocar::attempt {
struct Lesson;
}
namespace trocar::app {

/// Of a scripted operation, if the lesson is an exercise; else every hand goes to the tissue nearest to it, closes,
/// draws back, opens, and the next time 4 mm deeper.
/// @param seconds  of simulated time at most
std::vector<sim::Input> bench_inputs(const attempt::Lesson& lesson, double seconds);

}  // namespace trocar::app
