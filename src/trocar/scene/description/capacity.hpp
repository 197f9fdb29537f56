// What a scene asks of the machine, guessed before anything is built, and how much of it a scene may ask for: a file of
// a few lines must not become a model of gigabytes. The limits are some twenty times the gynaecology scene's.
#pragma once

#include <vector>

#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// Estimates, mostly within a factor of two.
struct Extent {
  double nodes = 0;         ///< of all lattices
  double places = 0;        ///< lattice places in the boxes around the bodies
  double triangles = 0;     ///< of all skins, drawn and touched, and walls
  double strand_nodes = 0;  ///< of all strands
};
Extent extent_of(const Solid& solid);
Extent extent_of(const Strand& strand);
Extent extent_of(const Wall& wall);
Extent extent_of(const Membrane& membrane);
Extent extent_of(const Pouch& pouch);
Extent extent_of(const Description& description);

inline constexpr Extent kMostExtent{150'000, 4e6, 2e6, 10'000};
inline constexpr std::size_t kMostBodies = 256;  ///< of one kind: solids, strands, instruments ...

/// Appends a fault where there are more bodies of a kind than kMostBodies; false then.
bool check_counts(const Description& description, std::vector<core::Fault>& faults);
/// Appends a fault, at the body that goes beyond it, for each limit that the description exceeds.
void check_capacity(const Description& description, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
