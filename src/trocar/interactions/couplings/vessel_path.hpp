// Where vessels run: their middle lines as points that ride on tissue. A point keeps its place in its host's own frame,
// so a vessel turns with what carries it; points that nothing carries go along with their neighbours on the line.
//
//   pose_vessel(path, hosts, points);                       // where the line is now
//   VesselSpot spot = vessel_spot(path, points, cuts, s);   // a material place on it, on either side of what is cut
//
// A material place of a vessel is (segment, s), s from 0 to 1 along its line. What is cut through ends in stumps: each
// goes straight on from the line on its own side.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions {

/// What a point of a vessel's line rides on.
struct VesselHold {
  enum Kind : std::int32_t { space, strand, organ, cell, membrane } kind = space;
  std::int32_t index = -1;    ///< strand, organ (as sim numbers them) or membrane
  std::int32_t element = -1;  ///< of the strand; triangle of the skin or the fold; cell of an organ that can be cut
  double w = 0;               ///< place within the strand's element
  std::array<std::int32_t, 3> vertex{-1, -1, -1};  ///< of the triangle
  std::array<double, 4> share{0, 0, 0, 0};         ///< of these, or of the cell's corners
  Vec3d offset{0, 0, 0};                           ///< from there; triangle: along edge, across, normal [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kind", s.kind), v("index", s.index), v("element", s.element), v("w", s.w), v("vertex", s.vertex),
        v("share", s.share), v("offset", s.offset);
  }

  BodyId carrier() const noexcept {  ///< none: space
    if (kind == space) return {};
    const BodyKind body = kind == strand ? BodyKind::strand : kind == membrane ? BodyKind::membrane : BodyKind::organ;
    return BodyId::maybe(body, index);
  }
};

struct VesselPoint {
  Vec3d drawn;             ///< [m]
  double s = 0;            ///< 0 .. 1 along the vessel
  double radius = 0;       ///< outer, at rest [m]
  Vec3d along{1, 0, 0};    ///< unit, from the point before it to the one after it, in the drawn shape
  Vec3d turn{0, 0, 0};     ///< direction before it less direction after it, in the drawn shape: points out of the bend
  VesselHold hold;         ///< space: as the next line says
  std::int32_t node = -1;  ///< of an organ or a fold: the one that bears what the vessel does to it
  std::int32_t near[2]{-1, -1};  ///< in space: points of the line whose displacement it shares ...
  double share[2]{0, 0};         ///< ... and how much of each

  /// Nothing carries it, nor what lies behind it on one side: the vessel runs below the peritoneum there, where no
  /// instrument meets it and no eye sees it.
  bool covered() const noexcept { return hold.kind == VesselHold::space && near[1] < 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("drawn", s.drawn), v("s", s.s), v("radius", s.radius), v("node", s.node), v("turn", s.turn), v("hold", s.hold),
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

/// (organs)(skin vertices) where vertices that carry vessels are now; empty: each is worked out when it is asked for.
using VertexPlaces = std::span<const std::vector<Vec3d>>;

/// Where a point that something carries is now.
Vec3d held_point(const VesselHold& hold, const Bodies& bodies, VertexPlaces corners = {}) noexcept;

/// @param points  out: (path.points)
void pose_vessel(const VesselPath& path, const Bodies& bodies, std::span<Vec3d> points,
                 VertexPlaces corners = {}) noexcept;

/// The same place in the drawn shape, in the frame of its host: for compile. `hold` names the host and the place on it.
void anchor_point(VesselHold& hold, Vec3d drawn, const Bodies& bodies) noexcept;

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
