// The same scene with another anatomy, as far as it declares one ("variation"): bodies that lie elsewhere, longer or
// shorter, turned, thicker, softer; another place that bleeds. Space itself is bent, smoothly and without folding, and
// everything that a scene draws is bent with it; so what hung together still does, and what lay apart still does.
//
//   scene::Description d = scene::read_scene(path);
//   scene::vary(d, 7);                    // seed 0 leaves everything as in the file
//   const sim::Model model = scene::compile(d);
#pragma once

#include <cstdint>

#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// Deterministic to the bit: the same description and seed give the same result everywhere. Figures are drawn in the
/// order of the declaration: each region's scale, shift along x, y, z, length and turn (as far as they are declared),
/// stiffness of the tissues, foundation of the strands, the bleeder, girths. Which findings are there is drawn apart
/// from these, and for seed 0, too: the first ones. So is which variant of the anatomy the patient has (variant.hpp);
/// one that the scene asks for by its name every seed has.
void vary(Description& description, std::uint64_t seed);

}  // namespace trocar::scene
