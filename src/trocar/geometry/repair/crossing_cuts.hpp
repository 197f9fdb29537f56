// Where triangles of a mesh cross: the points in which an edge goes through a triangle, or three triangles meet, each
// once however often it is found, and the segments between them in which two triangles meet. Used by resolved.cpp only.
//
//   CrossingCuts cuts;
//   if (cuts.find(mesh, pairs)) ...            // false: something only touches, or too many points
#pragma once

#include <array>
#include <map>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

class CrossingCuts {
 public:
  bool find(const TriMesh& mesh, const std::vector<std::array<int, 2>>& pairs);

  struct OfTriangle {
    std::vector<int> within;                   ///< points
    std::vector<std::array<int, 2>> segments;  ///< of two points, or of a corner and a point
    std::vector<int> lines;                    ///< of which segments are pieces
  };
  /// The mesh's places, then those of points.
  const std::vector<Vec3d>& places() const { return m_places; }
  /// By number of the triangle.
  const std::map<int, OfTriangle>& triangles() const { return m_triangles; }
  /// Points on an edge, from its lower vertex to its higher one.
  std::vector<int> on_edge(int low, int high) const;
  bool any_on_edge(int low, int high) const { return m_edges.count({low, high}) > 0; }

 private:
  /// In which two triangles meet.
  struct Line {
    std::array<int, 2> triangles;
    std::array<std::array<int, 2>, 2> ends;      ///< as each of them numbers them: a corner has a number in each
    std::vector<std::pair<double, int>> within;  ///< points of three triangles, by how far along the line
  };
  const TriMesh* m_mesh = nullptr;
  std::vector<Line> m_lines;
  std::map<std::array<int, 2>, int> m_line_of;  ///< by two triangles, ascending
  std::map<std::array<int, 3>, int> m_triples;  ///< by three
  std::vector<Vec3d> m_places;
  std::map<std::array<int, 3>, int> m_points;  ///< by edge (lower vertex first) and triangle
  std::map<int, OfTriangle> m_triangles;
  std::map<std::array<int, 2>, std::vector<std::pair<double, int>>> m_edges;

  enum class Meets : unsigned char { no, yes, touches };
  Meets meets(int low, int high, int triangle) const;
  int point(int low, int high, int triangle);
  bool add_pair(int s, int t);
  bool pierce(int s, int side, int t, std::vector<int>& points);
  bool meet_in_threes(int triangle);
  void add_triple(int line, int other);
  void add_segments();
};

}  // namespace trocar::geometry
