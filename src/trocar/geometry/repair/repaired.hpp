// What every repair gives back: another mesh, and what it has changed.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct Change {
  const char* remedy;  ///< the function that did it, as findings() name it
  int count;           ///< of what it changed
  std::string words;   ///< "14 vertices welded"
};

struct Repaired {
  TriMesh mesh;
  std::vector<Change> changes;    ///< only what was needed
  std::vector<std::string> left;  ///< what it could not do, in words
  bool changed() const { return !changes.empty(); }

  /// Adds "14 vertices welded", where there were any.
  void tell(const char* remedy, int count, const char* one, const char* many);
};

}  // namespace trocar::geometry
