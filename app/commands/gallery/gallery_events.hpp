// Pictures of what takes time: what bleeds and gathers, what coagulates and fogs the lens; and of ways to look at a
// scene.
#pragma once

#include <trocar/pictures/pictures.hpp>

namespace trocar::app {

/// The endoscope's optics `distance` [m] before a point, on the side of where the scope is.
view::ViewOptions close_up(const sim::Model& model, Vec3d target, double distance);
/// The places of an organ's skin, as drawn.
std::vector<Vec3d> skin_of(const sim::Model& model, int organ);
Vec3d nearest(const std::vector<Vec3d>& places, Vec3d p);

/// A hook coagulates the first organ until the lens is fogged, which is wiped. Nothing without hook and current.
void burn(const sim::Model& model, const sim::State& start, pictures::Shots& shots);
/// The vessel that opens by itself: jet and film, half a minute later the pool. Nothing where none does.
void bleed(const sim::Model& model, const sim::State& start, pictures::Shots& shots);
/// A grasper pulls at the nearest strand or organ: every figure that the analysis view has, alone and together.
void analysis(const sim::Model& model, const sim::State& start, pictures::Shots& shots);
/// Every style of parts.
void styles(const sim::State& start, pictures::Pictures& pictures, pictures::Shots& shots);
/// Every way to show both eyes, in pictures of their own.
void eyes(const sim::Model& model, const sim::State& start, pictures::PictureSize size, pictures::Shots& shots);

}  // namespace trocar::app
