// A wound that bleeds, as drawn: a small dark pit that blood wells up in, smears beside it, and a rivulet that runs
// down from it over the tissue until it hangs below.
#pragma once

#include <array>
#include <functional>

#include <trocar/render/frame/liquid.hpp>

namespace trocar::view {

/// Where a place of film is now.
struct FilmPlace {
  Vec3f position, normal{0, 0, 1};  ///< normal: unit
  float area = 4e-6f;               ///< [m^2]
  bool sheer = false;               ///< it lies on something that is drawn translucent
};

/// The tissue's surface next to a place; the place itself where there is none near.
using SurfaceNear = std::function<FilmPlace(const FilmPlace&)>;

struct Wound {
  Vec3f down{0, 0, -1};  ///< unit
  std::array<float, render::kLiquidKinds> share{1, 0, 0};
  float dark = 0;
};

/// Adds films to liquid.splats.
/// @param hole     on the tissue
/// @param surface  may be empty: then all of it lies in the hole's plane
void list_wound(const Wound& wound, const FilmPlace& hole, const SurfaceNear& surface, render::Liquid& liquid);

/// What is cut through oozes: patches around its end, and runs that start there.
/// @param end     middle of the cut face; its normal points out of the stump
/// @param radius  of the stump [m]
void list_stump(const Wound& wound, const FilmPlace& end, float radius, render::Liquid& liquid);

}  // namespace trocar::view
