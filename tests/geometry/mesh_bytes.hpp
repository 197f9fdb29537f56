// Mesh files for tests, written by hand: text, and numbers as binary files hold them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace trocar::geometry {

/// Text and numbers one after the other; `swapped`: in the byte order that this machine does not have.
struct MeshBytes {
  bool swapped = false;
  std::string bytes{};

  MeshBytes& text(const std::string& t) {
    bytes += t;
    return *this;
  }
  template <class T>
  MeshBytes& number(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (swapped) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
    return *this;
  }
  template <class T, class... Values>
  MeshBytes& all(Values... values) {
    (number(static_cast<T>(values)), ...);
    return *this;
  }
};

/// Two cells on both sides of a triangle, with node numbers that have gaps and come in no order, and regions 5 and 6.
inline const std::string kGmsh1 =
    "$NOD\n5\n10 0 0 0\n3 1 0 0\n77 0 1 0\n4 0 0 1\n12 0 0 -1\n$ENDNOD\n"
    "$ELM\n4\n1 15 1 1 1 10\n2 2 1 1 3 10 3 77\n3 4 5 1 4 10 3 77 4\n9 4 6 1 4 10 77 3 12\n$ENDELM\n";
inline const std::string kGmsh2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"tissue\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n10 0 0 0\n3 1 0 0\n77 0 1 0\n4 0 0 1\n12 0 0 -1\n$EndNodes\n"
    "$Elements\n4\n1 15 2 1 1 10\n2 2 3 1 1 0 10 3 77\n3 4 2 5 1 10 3 77 4\n9 4 1 6 10 77 3 12\n$EndElements\n";
inline const std::string kGmsh40 =
    "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n$Entities\n1 0 0 2\n1 0 0 0 0 0 0 0\n1 0 0 0 1 1 1 1 5 0\n"
    "2 0 0 0 1 1 1 2 6 5 1 -3\n$EndEntities\n"
    "$Nodes\n2 5\n1 0 0 1\n10 0 0 0\n1 3 1 4\n3 1 0 0 0.1 0.2 0.3\n77 0 1 0 0 0 0\n4 0 0 1 0 0 0\n12 0 0 -1 0 0 "
    "0\n$EndNodes\n"
    "$Elements\n3 3\n1 2 2 1\n2 10 3 77\n1 3 4 1\n3 10 3 77 4\n2 3 4 1\n9 10 77 3 12\n$EndElements\n"
    "$NodeData\nwhatever\n$EndNodeData\n";
inline const std::string kGmsh41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 2\n1 0 0 0 0\n1 0 0 0 1 1 1 1 5 0\n"
    "2 0 0 0 1 1 1 1 6 1 -3\n$EndEntities\n"
    "$Nodes\n2 5 3 77\n0 1 0 1\n10\n0 0 0\n3 1 1 4\n3\n77\n4\n12\n1 0 0 0.1 0.2 0.3\n0 1 0 0 0 0\n0 0 1 0 0 0\n0 0 -1 "
    "0 0 0\n$EndNodes\n"
    "$Elements\n3 3 2 9\n2 1 2 1\n2 10 3 77\n3 1 4 1\n3 10 3 77 4\n3 2 4 1\n9 10 77 3 12\n$EndElements\n";

/// The same in binary.
inline std::string gmsh2_binary(bool swapped) {
  MeshBytes f{swapped};
  f.text("$MeshFormat\n2.2 1 8\n").all<std::int32_t>(1).text("\n$EndMeshFormat\n$Nodes\n5\n");
  f.all<std::int32_t>(10).all<double>(0, 0, 0).all<std::int32_t>(3).all<double>(1, 0, 0);
  f.all<std::int32_t>(77).all<double>(0, 1, 0).all<std::int32_t>(4).all<double>(0, 0, 1);
  f.all<std::int32_t>(12).all<double>(0, 0, -1).text("\n$EndNodes\n$Elements\n3\n");
  f.all<std::int32_t>(2, 1, 2, 2, 1, 1, 10, 3, 77);
  f.all<std::int32_t>(4, 2, 2, 3, 5, 1, 10, 3, 77, 4, 9, 6, 1, 10, 77, 3, 12);
  return f.text("\n$EndElements\n").bytes;
}
inline std::string gmsh40_binary(bool swapped) {
  MeshBytes f{swapped};
  f.text("$MeshFormat\n4.0 1 8\n").all<std::int32_t>(1).text("\n$EndMeshFormat\n$Entities\n");
  f.all<std::uint64_t>(0, 0, 0, 2);
  f.all<std::int32_t>(1).all<double>(0, 0, 0, 1, 1, 1).all<std::uint64_t>(1).all<std::int32_t>(5).all<std::uint64_t>(0);
  f.all<std::int32_t>(2).all<double>(0, 0, 0, 1, 1, 1).all<std::uint64_t>(1).all<std::int32_t>(6);
  f.all<std::uint64_t>(1).all<std::int32_t>(-3).text("\n$EndEntities\n$Nodes\n");
  f.all<std::uint64_t>(1, 5).all<std::int32_t>(1, 2, 1).all<std::uint64_t>(5);
  f.all<std::int32_t>(10).all<double>(0, 0, 0, .1, .2).all<std::int32_t>(3).all<double>(1, 0, 0, .1, .2);
  f.all<std::int32_t>(77).all<double>(0, 1, 0, .1, .2).all<std::int32_t>(4).all<double>(0, 0, 1, .1, .2);
  f.all<std::int32_t>(12).all<double>(0, 0, -1, .1, .2).text("\n$EndNodes\n$Elements\n");
  f.all<std::uint64_t>(3, 3).all<std::int32_t>(1, 2, 2).all<std::uint64_t>(1).all<std::int32_t>(2, 10, 3, 77);
  f.all<std::int32_t>(1, 3, 4).all<std::uint64_t>(1).all<std::int32_t>(3, 10, 3, 77, 4);
  f.all<std::int32_t>(2, 3, 4).all<std::uint64_t>(1).all<std::int32_t>(9, 10, 77, 3, 12);
  return f.text("\n$EndElements\n").bytes;
}
/// @param empty_blocks  of nodes, in front of the full one
inline std::string gmsh41_binary(bool swapped, int empty_blocks = 0) {
  MeshBytes f{swapped};
  f.text("$MeshFormat\n4.1 1 8\n").all<std::int32_t>(1).text("\n$EndMeshFormat\n$Entities\n");
  f.all<std::uint64_t>(1, 0, 0, 2).all<std::int32_t>(1).all<double>(0, 0, 0).all<std::uint64_t>(0);
  f.all<std::int32_t>(1).all<double>(0, 0, 0, 1, 1, 1).all<std::uint64_t>(1).all<std::int32_t>(5).all<std::uint64_t>(0);
  f.all<std::int32_t>(2).all<double>(0, 0, 0, 1, 1, 1).all<std::uint64_t>(1).all<std::int32_t>(6);
  f.all<std::uint64_t>(1).all<std::int32_t>(-3).text("\n$EndEntities\n$Nodes\n");
  f.all<std::uint64_t>(1 + empty_blocks, 5, 3, 77);
  for (int i = 0; i < empty_blocks; ++i) f.all<std::int32_t>(2, 1, 0).all<std::uint64_t>(0);
  f.all<std::int32_t>(3, 1, 0).all<std::uint64_t>(5, 10, 3, 77, 4, 12);
  f.all<double>(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1).text("\n$EndNodes\n$Elements\n");
  f.all<std::uint64_t>(3, 3, 2, 9).all<std::int32_t>(2, 1, 2).all<std::uint64_t>(1, 2, 10, 3, 77);
  f.all<std::int32_t>(3, 1, 4).all<std::uint64_t>(1, 3, 10, 3, 77, 4);
  f.all<std::int32_t>(3, 2, 4).all<std::uint64_t>(1, 9, 10, 77, 3, 12);
  return f.text("\n$EndElements\n").bytes;
}

inline const std::string kVtk =
    "# vtk DataFile Version 3.0\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 "
    "0 0 -1\nCELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 0 2 1 4\n\nCELL_TYPES 3\n5 10 10\nPOINT_DATA 5\nVECTORS v float\n0 0 0 "
    "0 0 "
    "0 0 0 0 0 0 0 0 0 0\nCELL_DATA 3\nFIELD FieldData 2\nquality 1 3 double\n0.5 nan 1\nregion 1 3 int\n4 5 6\n";
inline const std::string kVtk5 =
    "# vtk DataFile Version 5.1\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0 0 1 0 0 0 1 "
    "0 0 "
    "-1\nMETADATA\nINFORMATION 0\n\nCELLS 4 11\nOFFSETS vtktypeint64\n0 3 7 11\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 2 "
    "3 0 "
    "2 1 4\nCELL_TYPES 3\n5\n10\n10\n\nCELL_DATA 3\nSCALARS region int\nLOOKUP_TABLE default\n4 5 6\n";

inline std::string vtk_binary() {
  MeshBytes f{true};
  f.text("# vtk DataFile Version 3.0\nany title\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n");
  f.all<float>(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1).text("\nCELLS 3 14\n");
  f.all<std::int32_t>(3, 0, 1, 2, 4, 0, 1, 2, 3, 4, 0, 2, 1, 4).text("\nCELL_TYPES 3\n").all<std::int32_t>(5, 10, 10);
  f.text("\nPOINT_DATA 5\nSCALARS s unsigned_char 1\nLOOKUP_TABLE default\n").all<std::uint8_t>(10, 32, 10, 7, 255);
  f.text("\nCELL_DATA 3\nFIELD FieldData 1\nmedit:ref 1 3 long\n").all<std::int64_t>(4, 5, 6);
  return f.text("\n").bytes;
}
inline std::string vtk5_binary() {
  MeshBytes f{true};
  f.text("# vtk DataFile Version 5.1\nany title\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n");
  f.all<double>(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1).text("\nCELLS 4 11\nOFFSETS vtktypeint64\n");
  f.all<std::int64_t>(0, 3, 7, 11)
      .text("\nCONNECTIVITY vtktypeint64\n")
      .all<std::int64_t>(0, 1, 2, 0, 1, 2, 3, 0, 2, 1, 4);
  f.text("\nCELL_TYPES 3\n").all<std::int32_t>(5, 10, 10);
  f.text("\nCELL_DATA 3\nSCALARS region int\nLOOKUP_TABLE default\n").all<std::int32_t>(4, 5, 6);
  return f.text("\n").bytes;
}

}  // namespace trocar::geometry
