// What is wrong with a triangle mesh that others made, and where: each fault with the vertices, edges or triangles that
// have it, so that a window can show them, and with the repair that mends it.
//
//   const Diagnosis d = examine(mesh);
//   if (d.is_body()) ...                                           // closed, one inside, nothing crosses
//   for (const Finding& f : findings(d)) say(f.words, f.remedy);  // "2 holes, the longest 84 mm around", "close_holes"
//
// Corners must be vertices that are there. Coordinates may be anything; what has one that is no number is left out of
// all else. Lengths in metres, angles in degrees. The same answer from every compiler.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <trocar/geometry/repair/rims.hpp>
#include <trocar/geometry/repair/shells.hpp>

namespace trocar::geometry {

struct ExamineOptions {
  /// Vertices nearer to each other than this share of the box's diagonal are at one place.
  double tolerance = 1e-6;
  double sliver_deg = 1;  ///< triangles with a smaller angle
  bool crossings = true;  ///< look for them: most of the time that examine() takes
};

/// A coordinate beyond this is no place, as one that is no number is not [m].
inline constexpr double kMostCoordinate = 1e9;
/// A triangle is degenerate where a corner is there twice, or where it is lower than this share of its longest side.
inline constexpr double kNoHeight = 1e-9;

/// A surface whose volume is below this share of its area times its diagonal is a sheet.
inline constexpr double kNoInside = 1e-6;

struct Diagnosis {
  int vertices = 0, triangles = 0;
  Bounds box;               ///< of the vertices that triangles use; low > high where there are none
  double area = 0;          ///< [m^2]
  double volume = 0;        ///< [m^3] of all shells, cavities taken off; of open ones as if closed by fans
  double least_angle = 60;  ///< of a triangle that is not degenerate

  std::vector<int> not_finite;  ///< vertices with a coordinate that is no number, or beyond all bounds
  std::vector<int> unused;      ///< vertices of no triangle
  std::vector<std::array<int, 2>> duplicate_vertices;   ///< at the place of an earlier one, and that; one on a border
  std::vector<int> degenerate, slivers;                 ///< triangles
  std::vector<std::array<int, 2>> duplicate_triangles;  ///< with the corners of an earlier one, and that
  std::vector<std::array<int, 2>> crowded_edges;        ///< with more than two triangles
  std::vector<int> pinched_vertices;                    ///< at which more than one fan of triangles meets
  std::vector<std::array<int, 2>> turned_edges;         ///< whose two triangles do not face the same way
  std::vector<Rim> holes;
  Shells shells;
  std::vector<int> inward;                    ///< closed shells that face inwards and are no cavities
  std::vector<std::array<int, 2>> crossings;  ///< triangles
  bool all_crossings = true;  ///< or there are more than were looked for, as where most triangles are there twice

  int open_edges() const;
  /// Closed, each edge with two triangles that face the same way, outwards, nothing crosses or is degenerate. Several
  /// shells are allowed, as are vertices without triangles.
  bool is_body() const;
  /// Is there an inside? A sheet has none, however often it is folded.
  bool encloses() const;
};
Diagnosis examine(const TriMesh& mesh, const ExamineOptions& options = {});

enum class MeshFault : unsigned char {
  not_finite,
  duplicate_vertices,
  degenerate,
  duplicate_triangles,
  unused,
  crowded_edges,
  pinched_vertices,
  turned_edges,
  inward,
  holes,
  crossings,
  several_shells,
  slivers,
};
struct Finding {
  MeshFault fault;
  int count;
  std::string words;   ///< "2 holes, 31 open edges, the longest 84 mm around"
  const char* remedy;  ///< the function that mends it: "close_holes"
};
/// In the order in which they are best mended.
std::vector<Finding> findings(const Diagnosis& diagnosis);
/// What it is, then one finding a line.
std::string in_words(const Diagnosis& diagnosis);

/// Fans of triangles around every vertex that hang together by edges with two triangles: 0 of an unused one.
std::vector<int> fans_of(const TriMesh& mesh, const EdgeTable& edges);
/// Is it a place that lengths and volumes can be taken of?
bool is_place(Vec3d p);
bool is_degenerate(const TriMesh& mesh, int triangle);

}  // namespace trocar::geometry
