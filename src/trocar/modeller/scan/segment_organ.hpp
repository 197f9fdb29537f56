// An organ of a document made of a segment of a scan: its smooth surface goes into a file beside the document, the body
// that names it into the document.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <trocar/modeller/document/document.hpp>
#include <trocar/modeller/scan/scan.hpp>

namespace trocar::modeller {

struct OrganWish {
  std::string segment, name, tissue, look;  ///< look may be empty
  double cell_mm = 0;                       ///< 0: such that about 700 cells fill it
  bool cuttable = false;
  std::optional<Vec3d> centre_mm;  ///< where its middle goes; none: where it is in the scan
  int most_triangles = 20000;
  double within = 0.02;                               ///< how much its volume may differ from the segment's, as a share
  std::function<Vec3d(Vec3d size_mm)> place_mm = {};  ///< where its middle goes, by its size; without centre_mm
  bool attach = false;                                ///< in its middle
};
struct SegmentOrgan {
  double segment_mL = 0, mL = 0;  ///< of the segment's voxels, of the surface
  std::size_t triangles = 0;
  Vec3d middle_mm, size_mm;  ///< in the scan, as scenes have it
};
/// One entry of the document's history; the surface's file is written at once.
/// @throws core::BadInput for a segment that is no body, a volume beyond `within`, a file that cannot be written
SegmentOrgan make_organ(Document& document, const Scan& scan, const OrganWish& wish);

}  // namespace trocar::modeller
