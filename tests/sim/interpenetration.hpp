// How deep the bodies of a scene pass through each other, measured from their shapes alone. It shares no code with
// contact (interactions/contact, caches in the State, boxes of posed skins), so tests can check contact with it.
//
//   const Interpenetration start = measure(model, sim::initial_state(model));
//   ... steps ...
//   const Interpenetration now = measure(model, state);
//   for (const Growth& g : deeper_than(now, start, 0.001)) ADD_FAILURE() << text_of(now, g);
//   print(std::cout, now, 0.001);
//
// Kinds of surfaces, and the depth of a pair [m]. h: half the thickness of both, added.
//   closed   triangles around a volume: skins of organs, closed membranes. A place is inside where the generalised
//            winding number [Jacobson et al. 2013] is at least 1/2, so holes that cuts leave do no harm. Its depth:
//            distance to the nearest point of the surface, plus h. Tested places: all vertices of the other surface,
//            and three places of each stretch of an edge between two crossings
//   sheet    open triangles with two sides: membranes, bags. It may divide a body: without the edges that cross the
//            sheet the body has several pieces. Depth then: the greatest distance of a piece to the sheet, of the
//            piece that reaches less, plus h. A body that is not divided contains the sheet's border. If the body is
//            closed, depth: that of the sheet in it. If not: the greatest distance of a
//            crossing to the border of either, of both the smaller one, plus h. Where two sheets divide each other: the
//            smaller depth
//   wall     open triangles with one side: environment surfaces. As a sheet, but of a divided body the piece behind
//            the wall counts. An environment surface that is nearly closed (a peg, a shaft) is closed
//   tube     capsules: rods, threads, needles, beads, lobules, instruments. Depth of a place of a surface: distance to
//            the surface of the capsule, plus h. Of two tubes: by how much their radii overlap, at most the larger
//            radius. Sheets and walls divide tubes, too
// Surfaces with a thickness also overlap where they do not cross, but are nearer to each other than h.
//
// A body with itself. Closed: right outside of its surface the winding number is 0. A piece between crossings where it
// is not 0 is folded into another part, or has passed through the opposite side. Depth: distance to the part that it
// has passed. Sheet: as two sheets. Tube: as two tubes. Neighbours do not count: triangles that share a vertex, and
// places of a tube that are less than twice the sum of radii apart along it.
//
// Limits. Depth is that of now: a body that has passed a sheet entirely is not found, and beyond a body's middle its
// depth falls again. Left out: endoscope, vessels, drawn folds (no mechanics), bags in their sleeve, instruments
// against open walls (shafts pass these), environment surfaces against each other.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar {

/// What of a body can pass through others, as it is now.
struct BodySurface {
  enum Kind { closed, sheet, wall, tube };  ///< as above
  struct Capsule {
    int a = 0, b = 0;   ///< ends, of `points`; the same: a ball
    double radius = 0;  ///< [m]
  };

  BodyId body;  ///< none: an instrument
  std::string name;
  Kind kind = closed;
  std::vector<Vec3d> points;                  ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside; of a wall from its free side
  std::vector<Capsule> capsules;              ///< of a tube
  double half_thickness = 0;                  ///< [m]
  bool folds = true;                          ///< it is measured against itself
  std::vector<int> attached;                  ///< surfaces that a coupling joins with it
  std::vector<int> ignored;                   ///< surfaces that it is not measured against
  int inside = -1;                            ///< the closed membrane that it is in: that is a sheet to it

  bool empty() const { return triangles.empty() && capsules.empty(); }
};

/// All bodies of a scene, in an order that depends on the Model alone.
std::vector<BodySurface> surfaces_of(const sim::Model& model, const sim::State& state);

struct Overlap {
  int a = 0, b = 0;       ///< surfaces, a <= b; the same: a body with itself
  double depth = 0;       ///< greatest [m]
  Vec3d place{0, 0, 0};   ///< where that is
  int crossings = 0;      ///< edges through triangles; of tubes: axes through triangles
  bool attached = false;  ///< by a coupling: hosting, border, bond, stitch, grasp
};

struct Interpenetration {
  std::vector<std::string> names;  ///< (surfaces)
  std::vector<Overlap> overlaps;   ///< of depth above 0, the deepest first

  /// [m]; 0 where they do not overlap, or where a name is unknown.
  double depth(int a, int b) const;
  double depth(const std::string& a, const std::string& b) const;
};

Interpenetration measure(std::span<const BodySurface> surfaces);
Interpenetration measure(const sim::Model& model, const sim::State& state);

struct Growth {
  Overlap now;
  double before = 0;  ///< depth of the same pair at the start [m]
};
/// Pairs that are deeper than at the start by more than `by` [m], the greatest growth first.
/// @param start  of the same Model
std::vector<Growth> deeper_than(const Interpenetration& now, const Interpenetration& start, double by);

/// "uterus - bladder: 2.31 mm at (10.0, -3.2, 55.1) mm, 12 crossings, attached"
std::string text_of(const Interpenetration& measured, const Overlap& overlap);
/// The same with the depth at the start.
std::string text_of(const Interpenetration& measured, const Growth& growth);
/// A line for each pair deeper than `over` [m].
void print(std::ostream& out, const Interpenetration& measured, double over = 0);

}  // namespace trocar
