// The tables of vessel files. Units are those of the clinic: mmHg, mL, litres. Private to the folder.
#pragma once

#include <trocar/scene/description/vessel_tree.hpp>
#include <trocar/scene/files/rows.hpp>

namespace trocar::scene {

/// As they stand in a file: nodes have names.
struct VesselLine : Vessel, vessels::VesselSegment {
  std::string from_node, to_node;
};
struct EndLine : vessels::VesselEnd {
  std::string name_of_node;
  double flow = 0;                                      ///< mean [m^3/s]
  double flow_pressure = 90 * vessels::kPascalPerMmHg;  ///< with which it comes [Pa]
  double time = 1;                                      ///< [s]
};
struct SourceLine : vessels::VesselSource {
  std::string name_of_node;
};

const Table<vessels::Heart>& heart();
const Table<VesselLine>& vessel();
const Table<EndLine>& vessel_end();
const Table<SourceLine>& vessel_source();
/// Without what is in its lists.
const Table<VesselTree>& vessel_file_keys();

}  // namespace trocar::scene
