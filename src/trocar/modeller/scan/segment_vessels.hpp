// A tree of vessels of a document made of a segment of a scan: its centre lines become vessels from branching to
// branching, with the radii that the scan shows.
#pragma once

#include <optional>
#include <string>

#include <trocar/modeller/document/document.hpp>
#include <trocar/modeller/scan/scan.hpp>

namespace trocar::modeller {

struct VesselWish {
  std::string segment, file, name;  ///< file: relative to the document, new
  std::optional<Vec3d> root_mm;  ///< where blood comes from, in the scan as scenes have it; none: the thicker far end
  std::optional<Vec3d> move_mm;  ///< by how much it lies elsewhere than in the scan
  double flow_mL_min = 100;      ///< of the whole tree
  double least_branch_mm = 8;
};
/// One entry of the document's history. @return how many vessels  @throws core::BadInput
std::size_t make_vessels(Document& document, const Scan& scan, const VesselWish& wish);

}  // namespace trocar::modeller
