// Parts that instruments are made of, as meshes: turned bodies, bent bars, and plates with a window. Hard edges are
// rows that lie in the same place and are not joined. All in metres.
#pragma once

#include <functional>
#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// A point of a turned body's outline, going along +z; two equal points in a row make a hard edge.
struct TurnPoint {
  double z = 0, radius = 0;
  Paint paint;
};
/// Turned about the z axis; closed where the outline ends at radius 0.
MeshBuffer turned(const std::vector<TurnPoint>& outline, int sides);

/// A cross-section of a bar: centre and half-extents along two directions.
struct BarSection {
  Vec3d centre, wide, deep;  ///< half axes; (wide, deep, direction) right-handed
  Paint paint;
};
/// A bar through the sections with rounded edges, closed flat at both ends.
/// @param roundness 0 = box with hard edges .. 1 = ellipse
MeshBuffer bar(const std::vector<BarSection>& sections, double roundness);

/// Closed curve in the (y, z) plane by its parameter 0..1, counter-clockwise seen from +x.
using Outline = std::function<Vec3d(double)>;
/// Height over the (y, z) plane [m].
using Height = std::function<double(double y, double z)>;
/// A plate between an outer and an inner outline (a window), from `low` to `high` along x. With equal parameters the
/// outlines face each other. Its edges are broken: worn steel shows a bright line there. @param around points along
/// each outline
MeshBuffer plate(const Outline& outer, const Outline& inner, const Height& low, const Height& high, int around,
                 int across, const std::function<Paint(bool inside, double y, double z)>& paint);

}  // namespace trocar::view
