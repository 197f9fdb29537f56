// Whatever a mesh lacks to be a body is mended, in an order in which one repair does not undo another: what is broken
// goes, vertices are welded, what is there twice goes, surfaces that only touch come apart, triangles without area go,
// all face the same way, holes are closed, what crosses is eased, cut out or made again.
//
//   const MendedMesh organ = mend(file_mesh);
//   if (!organ.after.is_body()) say(organ.left);       // "a sheet of 12 cm2 is left open: it encloses nothing"
//
// A mesh that is a body already stays as it is, to the bit. What comes out is one (Diagnosis::is_body()), or `left`
// says what could not be done. Lengths in metres.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/repair/holes.hpp>
#include <trocar/geometry/repair/refilled.hpp>
#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

struct MendOptions {
  double tolerance = 1e-6;       ///< share of the box's diagonal within which vertices are one
  double crack = 1e-3;           ///< the same for borders, where no edge there is short
  double smallest_shell = 1e-3;  ///< open shells of less than this share of the largest one's area are left out
  HoleOptions holes;
  bool refill = true;  ///< make again what crosses, where nothing else helps
  RefillOptions refilling;
};

struct MendedMesh {
  TriMesh mesh;
  std::vector<Change> changes;    ///< in the order in which they were made
  std::vector<std::string> left;  ///< what could not be mended, in words
  Diagnosis before, after;
  bool was_refilled = false;
};
MendedMesh mend(const TriMesh& mesh, const MendOptions& options = {});

}  // namespace trocar::geometry
