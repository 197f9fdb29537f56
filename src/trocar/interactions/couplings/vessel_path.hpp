// Where vessels run: their middle lines as material points, so that a vessel turns with what carries it; points that
// nothing carries go along with their neighbours on the line.
//
//   pose_vessel(path, bodies, points);                      // where the line is now
//   VesselSpot spot = vessel_spot(path, points, cuts, s);   // a material place on it, on either side of what is cut
//
// A material place of a vessel is (segment, s), s from 0 to 1 along its line. What is cut through ends in stumps: each
// goes straight on from the line on its own side.
#pragma once

#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>

namespace trocar::interactions {

struct VesselPoint {
  Vec3d drawn;           ///< [m]
  double s = 0;          ///< 0 .. 1 along the vessel
  double radius = 0;     ///< outer, at rest [m]
  Vec3d along{1, 0, 0};  ///< unit, from the point before it to the one after it, in the drawn shape
  Vec3d turn{0, 0, 0};   ///< direction before it less direction after it, in the drawn shape: points out of the bend
  MaterialPoint rides;   ///< in space: as the next line says
  std::int32_t near[2]{-1, -1};  ///< in space: points of the line whose displacement it shares ...
  double share[2]{0, 0};         ///< ... and how much of each

  /// Nothing carries it, nor what lies behind it on one side: the vessel runs below the peritoneum there, where no
  /// instrument meets it and no eye sees it.
  bool covered() const noexcept { return rides.in_space() && near[1] < 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("drawn", s.drawn), v("s", s.s), v("radius", s.radius), v("turn", s.turn), v("rides", s.rides),
        v("near[0]", s.near[0]), v("share[0]", s.share[0]), v("near[1]", s.near[1]), v("share[1]", s.share[1]),
        v("along", s.along, core::kNotHashed);
  }
};

/// Const after compile.
struct VesselPath {
  double length = 0;                ///< of the drawn line [m]
  std::vector<VesselPoint> points;  ///< two or more, s ascending from 0 to 1

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("length", s.length), v("points", s.points);
  }
};

/// @param points  out: (path.points)
void pose_vessel(const VesselPath& path, const Bodies& bodies, std::span<Vec3d> points) noexcept;

/// A place of the line and which way the line leads there, towards s = 1.
struct VesselSpot {
  Vec3d place, along;
  int after = 0;  ///< the last point that is not beyond it
};
/// @param cuts  places of this vessel that are cut through, in any order
/// @param side  0: as seen from s = 0, 1: from the other end. Only where `s` is itself cut does this matter.
VesselSpot vessel_spot(const VesselPath& path, std::span<const Vec3d> points, std::span<const double> cuts, double s,
                       int side = 0) noexcept;

/// The drawn turn of an inner point, turned with the line.
Vec3d turn_at(const VesselPath& path, std::span<const Vec3d> points, int i) noexcept;

/// Radius at s [m].
double vessel_radius(const VesselPath& path, double s) noexcept;

/// Directions at a spot that turn with the line, for what sits on it.
StrandFrame vessel_frame(const VesselPath& path, const VesselSpot& spot) noexcept;

/// A straight piece of the line on which nothing is cut.
struct VesselPiece {
  Vec3d a, b;
  double s_a = 0, s_b = 0;
  int point = 0;  ///< between this point and the next
};
/// What hangs together between point i and the next: one piece, or the two stumps (what lies between two cuts of one
/// interval has fallen out).
/// @return how many
int pieces_of(const VesselPath& path, std::span<const Vec3d> points, std::span<const double> cuts, int i,
              VesselPiece (&out)[2]) noexcept;

void add_to_hash(core::Hasher& hasher, const VesselPath& path) noexcept;

}  // namespace trocar::interactions
