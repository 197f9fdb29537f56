// What a tick costs, from counts alone: the same on every machine and however busy it is.
#pragma once

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

/// Of a body at rest, contacts and loads beside, on one quiet core of an Intel Xeon at 2.6 GHz [us].
double predicted_us(const BodyReport& body);
/// Of all tissue of a scene, likewise.
double predicted_us(const sim::Model& model);

}  // namespace trocar::scene
