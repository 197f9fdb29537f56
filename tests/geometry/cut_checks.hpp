// What must hold for a body of tetrahedra after any cut.
#pragma once

#include <algorithm>
#include <map>

#include <trocar/geometry/tets/tet_cut.hpp>

namespace trocar::geometry {

struct Soundness {
  bool linked = true;           ///< cells that say they are joined share the corners of their face, both ways
  int odd_edges = 0;            ///< of the surface, with an odd number of faces: a hole
  int pinched_edges = 0;        ///< of the surface, with more than two: two sheets touch there
  double least_volume = 1e30;   ///< of a cell [m^3]
  double volume = 0;            ///< [m^3]
  double least_dihedral = 180;  ///< [degrees]
};

inline std::array<Vec3d, 4> drawn_corners(const CuttableTets& b, const Tet& c) {
  return {b.rest[size_t(c[0])], b.rest[size_t(c[1])], b.rest[size_t(c[2])], b.rest[size_t(c[3])]};
}
inline double drawn_volume(const CuttableTets& b, const Tet& c) {
  const auto x = drawn_corners(b, c);
  return dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6;
}

inline Soundness soundness(const CuttableTets& b) {
  Soundness s;
  std::map<std::array<std::int32_t, 2>, int> edges;
  for (size_t t = 0; t < b.cells.size(); ++t) {
    const Tet& c = b.cells[t];
    const double volume = drawn_volume(b, c);
    s.volume += volume;
    s.least_volume = std::min(s.least_volume, volume);
    s.least_dihedral = std::min(s.least_dihedral, least_dihedral(drawn_corners(b, c)));
    for (size_t f = 0; f < 4; ++f) {
      std::array<std::int32_t, 3> face{};
      for (size_t i = 0, k = 0; i < 4; ++i)
        if (i != f) face[k++] = c[i];
      std::sort(face.begin(), face.end());
      const std::int32_t u = b.across[t][f];
      if (u < 0) {
        ++edges[{face[0], face[1]}], ++edges[{face[0], face[2]}], ++edges[{face[1], face[2]}];
        continue;
      }
      const Tet& beyond = b.cells[size_t(u)];
      const Tet& back = b.across[size_t(u)];
      s.linked = s.linked && std::count(back.begin(), back.end(), std::int32_t(t)) == 1;
      for (const std::int32_t node : face) s.linked = s.linked && std::count(beyond.begin(), beyond.end(), node) == 1;
    }
  }
  for (const auto& [edge, count] : edges) {
    s.odd_edges += count % 2;
    s.pinched_edges += count > 2;
  }
  return s;
}

}  // namespace trocar::geometry
