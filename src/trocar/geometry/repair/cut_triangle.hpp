// A triangle that others pass through is cut along the lines in which they do: triangles over its corners, points on
// its sides and within, of which given segments are edges. Decided without rounding (orientation.hpp), so that what
// comes out is a triangulation or nothing.
//
//   CutTriangle cut(places, {a, b, c});        // numbers of places
//   cut.add_on_side(0, {d, e});                // between a and b, in this order
//   cut.add_within(f);
//   if (cut.constrain(d, f)) use(cut.triangles());
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

class CutTriangle {
 public:
  /// @param places  must stay as long as this
  CutTriangle(std::span<const Vec3d> places, const std::array<int, 3>& corners);

  bool good() const { return m_good; }  ///< false after anything that could not be done
  void add_on_side(int side, const std::vector<int>& points);
  void add_within(int point);
  /// Makes an edge of two points that are there.
  void constrain(int from, int to);
  /// Flips edges that are no segments where that widens the smallest angle.
  void widen();
  /// Facing as the given one.
  std::vector<std::array<int, 3>> triangles() const;

 private:
  std::span<const Vec3d> m_places;
  std::array<int, 3> m_corners;
  int m_first = 0, m_second = 1;  ///< axes along which it is seen, counter-clockwise
  bool m_good = true;
  std::vector<std::array<int, 3>> m_triangles;       ///< dead ones have -1
  std::map<std::array<int, 2>, int> m_at;            ///< the triangle to the left of each edge that runs so
  std::map<std::array<int, 2>, bool> m_constrained;  ///< lower point first

  int side(int a, int b, int c) const;
  void put(const std::array<int, 3>& corners);
  void take(int triangle);
  int opposite(int a, int b) const;
  bool is_constrained(int a, int b) const;
  bool flip(int a, int b);
  bool split_edge(int a, int b, int point);
  bool crossed_edges(int from, int to, std::vector<std::array<int, 2>>& out);
};

}  // namespace trocar::geometry
