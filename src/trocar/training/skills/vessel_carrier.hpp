// What jaws take when they shall close a vessel: the strand that carries it there, or the vessel itself.
#pragma once

#include <trocar/training/surgeon/surgeon.hpp>

namespace trocar::training {

struct VesselCarrier {
  Vec3d place, along;  ///< its middle, and which way it runs there
  double radius = 0;   ///< [m]
};

/// @param s  place of the vessel, 0 to 1 along it
VesselCarrier carrier_at(Surgeon& op, int vessel, double s);

}  // namespace trocar::training
