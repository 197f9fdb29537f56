// The same scene with another anatomy: longer or shorter tubes, adnexa that lie elsewhere, softer or stiffer tissue.
// Space itself is bent, smoothly and without folding, and everything that a scene draws is bent with it; so what hung
// together still does, and what lay apart still does.
//
//   scene::Description d = scene::read_scene(path);
//   scene::vary(d, 7);                    // seed 0 leaves everything as drawn
//   const sim::Model model = scene::compile(d);
#pragma once

#include <cstdint>

#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// How far a seed may go.  Our choice
struct Variation {
  double length = 0.20;     ///< of each side's adnexa, tube length above all, relative
  double shift = 0.003;     ///< of each side's adnexa along each axis [m]
  double stiffness = 0.20;  ///< of every tissue and every fold, relative
};

/// Deterministic to the bit: the same description and seed give the same result everywhere. Sides are those of the
/// patient's midline (x = 0); each side's field begins where its fimbriated strand begins.
void vary(Description& description, std::uint64_t seed, const Variation& most = {});

}  // namespace trocar::scene
