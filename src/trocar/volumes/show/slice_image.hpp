// Slices through a volume as grey pictures with the labels over them, along the volume's axes or oblique. [feature 67]
//
//   SlicePlane plane = axial(volume.grid, middle_mm);      // the patient's left on the picture's right side
//   const Picture p = slice_image(volume, &labels, plane, {.centre = 40, .width = 400});
//   const Vec3d there = plane.at(x, y);                    // under the mouse [mm, L P S]
#pragma once

#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/volume.hpp>
#include <trocar/volumes/show/view.hpp>

namespace trocar::volumes {

struct SlicePlane {
  Vec3d corner;       ///< centre of the first pixel, at the top left [mm, L P S]
  Vec3d right, down;  ///< from a pixel to the next [mm]
  int width = 0, height = 0;

  Vec3d at(double x, double y) const { return corner + x * right + y * down; }
  Vec3d normal() const { return normalised(cross(right, down)); }
};
/// As radiologists look at them: axial from the feet, coronal from the front, sagittal from the patient's left; the
/// pixels are squares of the smallest distance of voxels, and the whole box is in the picture.
/// @param through  a place in the slice [mm]
SlicePlane axial(const Grid& grid, Vec3d through);
SlicePlane coronal(const Grid& grid, Vec3d through);
SlicePlane sagittal(const Grid& grid, Vec3d through);
/// Across an axis of the voxels, pixel by pixel where they are square.
SlicePlane across_axis(const Grid& grid, int axis, int slice);
/// Any plane.
/// @param normal  towards who looks
/// @param up      shown upwards; must not be along the normal
SlicePlane oblique(const Grid& grid, Vec3d through, Vec3d normal, Vec3d up);

struct SliceLook {
  double centre = 40, width = 400;  ///< of the window: values from centre - width/2, black, to centre + width/2, white
  bool smooth = true;               ///< trilinear between voxels, else the nearest
  bool inverted = false;            ///< small values bright
  double label_opacity = 0.35;      ///< of areas; outlines are twice as opaque
  bool outlines = true;
};
/// @param labels  may be null; may lie on another grid
Picture slice_image(const Volume& volume, const Labels* labels, const SlicePlane& plane, const SliceLook& look = {});

}  // namespace trocar::volumes
