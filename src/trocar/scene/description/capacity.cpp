#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/description/capacity.hpp>
#include <trocar/tissue/tets/face_skin.hpp>

namespace trocar::scene {
namespace {

constexpr double kDrawnOfWall = 9;         // triangles drawn for one of a pouch's wall
constexpr double kTrianglesPerArea = 2.3;  // of edge 1 in a unit of area

Extent operator+(Extent a, const Extent& b) {
  return {a.nodes + b.nodes, a.places + b.places, a.triangles + b.triangles, a.strand_nodes + b.strand_nodes};
}

double half_axis(const Section& s, int k) { return std::fabs(s.across[k]) + std::fabs(s.deep[k]); }

double triangles_of(double area, double edge) { return kTrianglesPerArea * area / (edge * edge); }

/// Of a body filled from its closed surface.
Extent extent_of(const Solid& solid, const ShapeSize& size) {
  const double touched = solid.cuttable ? solid.cell : solid.skin_edge;
  const double drawn = solid.cuttable ? solid.cell / 3 : solid.fine_edge;
  Extent e;
  e.triangles = triangles_of(size.area, touched) + triangles_of(size.area, drawn);
  e.places = 1;
  for (int k = 0; k < 3; ++k) e.places *= std::max(1.0, (size.box.high[k] - size.box.low[k]) / solid.cell);
  // Where walls are thinner than a cell, cells at the surface are most of them.
  const double cell = solid.cell;
  e.nodes = (solid.cuttable ? 2 : 1) * std::max(size.volume / cell, 0.5 * size.area) / (cell * cell);
  if (solid.at_control_points() && solid.shape.nurbs) e.nodes = 3 * double(solid.shape.nurbs->net.size());
  return e;
}

/// Rings of triangles between two sections: at least five vertices around, however thin the body.
double ring_triangles(double height, double around, double edge) {
  const double rings = height / (0.866 * edge);
  return std::max(kTrianglesPerArea * height * around / (edge * edge), 10 * rings);
}

void add_places(const Solid& solid, Extent& e) {
  double places = 1;
  for (int k = 0; k < 3; ++k) {
    double low = std::numeric_limits<double>::max(), high = -low;
    for (const Section& s : solid.sections) {
      const double cap = std::max(length(s.across), length(s.deep));
      low = std::min(low, s.centre[k] - std::max(half_axis(s, k), cap));
      high = std::max(high, s.centre[k] + std::max(half_axis(s, k), cap));
    }
    places *= std::max(1.0, (high - low) / solid.cell);
  }
  e.places = places;
}

template <class Body>
void check(const std::vector<Body>& bodies, const char* what, Extent& sum, std::vector<core::Fault>& faults) {
  for (const Body& body : bodies) {
    const Extent before = sum;
    sum = sum + extent_of(body);
    const auto limit = [&](double now, double then, double most, const char* unit) {
      if (then <= most && !(now <= most))
        faults.push_back({body.at, tr("expected bodies of at most {:g} {} in a scene, got about {:.3g} with "
                                      "the {} '{}'",
                                      most, unit, now, what, body.name)});
    };
    limit(sum.nodes, before.nodes, kMostExtent.nodes, "lattice nodes");
    limit(sum.places, before.places, kMostExtent.places, "cells in the boxes around them");
    limit(sum.triangles, before.triangles, kMostExtent.triangles, "triangles");
    limit(sum.strand_nodes, before.strand_nodes, kMostExtent.strand_nodes, "strand nodes");
  }
}

template <class Thing>
bool few(const std::vector<Thing>& things, const char* what, std::vector<core::Fault>& faults,
         const char* ending = "s") {
  if (things.size() <= kMostBodies) return true;
  faults.push_back({things[kMostBodies].at, tr("expected at most {} {}{}, got more", kMostBodies, what, ending)});
  return false;
}

}  // namespace

Extent extent_of(const Solid& solid) {
  Extent e;
  if (solid.tets) {
    e.nodes = double(solid.tets->mesh.points.size());
    e.triangles = (1 + tissue::kDrawnParts * tissue::kDrawnParts) * 2 * e.nodes;  // were all on its surface
    return e;
  }
  if (!(solid.cell > 0)) return e;
  if (solid.shape.any()) return extent_of(solid, size_of(solid.shape));
  if (solid.sections.empty()) return e;
  const double touched = solid.cuttable ? solid.cell : solid.skin_edge;
  const double drawn = solid.cuttable ? solid.cell / 3 : solid.fine_edge;
  double volume = 0;
  for (std::size_t i = 0; i + 1 < solid.sections.size(); ++i) {
    const Section &a = solid.sections[i], &b = solid.sections[i + 1];
    const double height = length(b.centre - a.centre);
    const double top = 4 * length(cross(a.across, a.deep)), bottom = 4 * length(cross(b.across, b.deep));
    const double around = 3 * std::max(length(a.across) + length(a.deep), length(b.across) + length(b.deep));
    volume += height / 3 * (top + bottom + std::sqrt(top * bottom));
    for (double edge : {touched, drawn})
      e.triangles += ring_triangles(height + 0.3 * around / double(solid.sections.size()), around, edge);
  }
  e.nodes = (solid.cuttable ? 2 : 1) * volume / (solid.cell * solid.cell * solid.cell);
  add_places(solid, e);
  return e;
}

Extent extent_of(const Strand& strand) {
  double chords = 0;
  for (std::size_t i = 1; i < strand.centreline.size(); ++i)
    chords += length(strand.centreline[i] - strand.centreline[i - 1]);
  Extent e;
  e.strand_nodes = 1 + 1.05 * chords / strand.spacing;
  return e;
}

Extent extent_of(const Wall& wall) {
  double rows = 0, columns = 0;  // ways along the net, all lines of it; compile samples at most 400 times 400
  for (int r = 0; r < wall.rows; ++r)
    for (int c = 0; c < wall.columns; ++c) {
      const Vec3d* p = wall.net.data() + std::size_t(r) * std::size_t(wall.columns) + std::size_t(c);
      if (c > 0) columns += length(p[0] - p[-1]);
      if (r > 0) rows += length(p[0] - p[-wall.columns]);
    }
  const auto pieces = [&](double way, int lines) {
    return std::clamp(way / std::max(1, lines) / wall.edge + 1, 2.0, 400.0);
  };
  Extent e;
  e.triangles = 2 * pieces(columns, wall.rows) * pieces(rows, wall.columns);
  return e;
}

Extent extent_of(const Membrane& m) {
  double base = 0;
  for (std::size_t i = 1; i < m.base.size(); ++i) base += length(m.base[i] - m.base[i - 1]);
  const double columns = 2 + (m.to - m.from) / m.spacing;
  // Its width is not known before its strand is: no fold is wider than it is long.
  const double rows = 3 + std::max(base, m.to - m.from) / m.spacing;
  Extent e;
  e.nodes = columns * rows;
  e.triangles = 2 * columns * rows;
  return e;
}

Extent extent_of(const Pouch& p) {
  Extent e;
  if (p.shape.any()) e.triangles = triangles_of(size_of(p.shape).area, p.spacing);
  for (std::size_t i = 0; i + 1 < p.sections.size(); ++i) {
    const Section &a = p.sections[i], &b = p.sections[i + 1];
    const double around = 3.2 * std::max(length(a.across) + length(a.deep), length(b.across) + length(b.deep));
    e.triangles +=
        ring_triangles(length(b.centre - a.centre) + 0.3 * around / double(p.sections.size()), around, p.spacing);
  }
  e.nodes = 0.5 * e.triangles;
  e.triangles *= 1 + kDrawnOfWall;
  return e;
}

Extent extent_of(const Description& d) {
  Extent sum;
  for (const Solid& solid : d.solids) sum = sum + extent_of(solid);
  for (const Strand& strand : d.strands) sum = sum + extent_of(strand);
  for (const Wall& wall : d.walls) sum = sum + extent_of(wall);
  for (const Membrane& membrane : d.membranes) sum = sum + extent_of(membrane);
  for (const Pouch& pouch : d.pouches) sum = sum + extent_of(pouch);
  return sum;
}

bool check_counts(const Description& d, std::vector<core::Fault>& faults) {
  bool good = few(d.solids, "solid", faults);
  good = few(d.strands, "strand", faults) && good;
  good = few(d.walls, "wall", faults) && good;
  good = few(d.sheets, "sheet", faults) && good;
  good = few(d.membranes, "membrane", faults) && good;
  good = few(d.pouches, "pouch", faults, "es") && good;
  good = few(d.tissues, "tissue", faults) && good;
  good = few(d.instruments, "instrument", faults) && good;
  good = few(d.placements, "tool", faults) && good;
  return few(d.ports, "port", faults) && good;
}

void check_capacity(const Description& d, std::vector<core::Fault>& faults) {
  if (!check_counts(d, faults)) return;
  Extent sum;
  check(d.solids, "solid", sum, faults);
  check(d.strands, "strand", sum, faults);
  check(d.walls, "wall", sum, faults);
  check(d.membranes, "membrane", sum, faults);
  check(d.pouches, "pouch", sum, faults);
}

}  // namespace trocar::scene
