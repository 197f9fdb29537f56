// The readers of surfaces, the writers, and what is found and mended in what they read. One target a format, so that
// each has a corpus of its own; all of them run the same.
#include <algorithm>
#include <cmath>

#include <trocar/core/error.hpp>
#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>

#include "../geometry/surface_bytes.hpp"
#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace geometry;

void check_parts(const SurfaceFile& file) {
  require(!file.parts.empty(), "a surface that was read has parts");
  for (const SurfacePart& part : file.parts) {
    require(!part.mesh.triangles.empty(), "parts have triangles");
    for (const auto& t : part.mesh.triangles)
      for (const int v : t)
        require(v >= 0 && v < int(part.mesh.positions.size()), "corners are vertices that are there");
    for (const Vec3d& p : part.mesh.positions)
      for (int k = 0; k < 3; ++k) require(std::fabs(p[k]) <= kMostSurfaceCoordinate, "coordinates are bounded");
  }
}

/// Those that have three corners at different places in its floats.
std::size_t triangles_in_stl(const TriMesh& mesh) {
  const auto same = [&](int a, int b) {
    const Vec3d p = mesh.positions[std::size_t(a)], q = mesh.positions[std::size_t(b)];
    return float(p.x) == float(q.x) && float(p.y) == float(q.y) && float(p.z) == float(q.z);
  };
  return std::size_t(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    return !same(t[0], t[1]) && !same(t[1], t[2]) && !same(t[2], t[0]);
  }));
}

void check_written(const TriMesh& mesh) {
  for (const std::string& bytes : {to_obj(mesh), to_ply(mesh), to_polydata(mesh)}) {
    const SurfaceFile back = read_surfaces(bytes, "again");
    require(back.parts.size() == 1, "one mesh is one part");
    require(back.parts[0].mesh.positions == mesh.positions && back.parts[0].mesh.triangles == mesh.triangles,
            "what was read can be written and read again");
  }
  const std::size_t solid = triangles_in_stl(mesh);
  require(solid == 0 || read_surfaces(to_stl(mesh), "again").parts[0].mesh.triangles.size() == solid,
          "as many triangles come back from STL");
}

void check_mended(const TriMesh& mesh) {
  const Diagnosis before = examine(mesh);
  require(std::isfinite(before.area) && std::isfinite(before.volume), "area and volume are finite");
  MendOptions options;
  options.refilling.most_cells = 2000;
  const MendedMesh mended = mend(mesh, options);
  require(examine(mended.mesh, {options.tolerance}).is_body() == mended.after.is_body(), "what is told of it is true");
  require(mended.after.is_body() || mended.mesh.triangles.empty() || !mended.left.empty(),
          "what could not be mended is told");
  if (before.is_body() && before.unused.empty()) require(mended.changes.empty(), "a body is left alone");
}

}  // namespace

void surface_file(Bytes bytes) {
  SurfaceFile file;
  try {
    file = read_surfaces(text_of(bytes), "memory.stl");
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty() && bad.faults().size() <= kMaxMeshFaults + 1, "faults are bounded");
    for (const core::Fault& f : bad.faults()) require(!f.message.empty(), "a fault says what was expected");
    return;
  }
  check_parts(file);
  const TriMesh all = joined(file);
  const UnitChoice unit = choose_unit(extent_of(all), file.metres, "unit");
  require(unit.metres > 0 && (unit.note.empty() || unit.question.empty()), "a unit is taken, told or asked for");
  if (all.triangles.size() > 10'000 || all.positions.size() > 10'000) return;
  check_written(all);
  if (all.triangles.size() <= 200) check_mended(merged_equal(all));
}

std::vector<Seed> surface_obj_seeds() {
  return {
      {"axes", bytes_of(kAxesObj)},
      {"marked",
       bytes_of("\xef\xbb\xbf# 3D Slicer output. SPACE=LPS\rv 0 0 0 # one\rv 1 0 0\rv 0 1 0\rf 1 2 3 # f\rf 1 2\r")},
      {"polygons", bytes_of("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\nf -6//1 -1/2 3\n")},
      {"boxes", bytes_of(to_obj(TriMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, -1}, {0.3, 0.2, 2}},
                                        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {1, 4, 5}}}))}};
}
std::vector<Seed> surface_stl_seeds() {
  return {{"text", bytes_of(kAxesStl)},
          {"binary", bytes_of(axes_stl_binary())},
          {"behind", bytes_of(axes_stl_binary() + std::string(9, '\0'))},
          {"odd", bytes_of("solid a\r solid b SPACE=RAS\rfacet normal 0 0 1\router loop\rvertex 0 0 0\rvertex 1 0 0\r"
                           "vertex 0 1 0\rend loop\rend facet\rend solid b\rendsolid a\rjunk")},
          {"written", bytes_of(to_stl(axes_mesh()))}};
}
std::vector<Seed> surface_ply_seeds() {
  return {{"text", bytes_of(kAxesPly)},
          {"little", bytes_of(axes_ply_binary(false))},
          {"big", bytes_of(axes_ply_binary(true))},
          {"written", bytes_of(to_ply(axes_mesh()))}};
}
std::vector<Seed> surface_vtk_seeds() {
  return {
      {"text", bytes_of(kAxesVtk)},
      {"binary", bytes_of(axes_vtk_binary())},
      {"written", bytes_of(to_polydata(axes_mesh()))},
      {"strings", bytes_of("# vtk DataFile Version 4.2\nSPACE=LPS\nASCII\nDATASET POLYDATA\nFIELD FieldData 2\n"
                           "SPACE 1 1 string\nRAS\nflags 1 9 bit\n1 0 1 0 1 0 1 0 1\nPOINTS 3 int\n0 0 0 1 0 0 0 1 0\n"
                           "POLYGONS 1 4\n3 0 1 2\n")},
      {"grid", bytes_of("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
                        "0 0 0 1 0 0 0 1 0 1 1 0\nCELLS 4 18\n4 0 1 2 3\n3 0 1 2\n4 0 1 3 2\n3 0 1 2\n"
                        "CELL_TYPES 4\n8 5 9 6\n")}};
}
std::vector<Seed> surface_gltf_seeds() {
  return {{"embedded", bytes_of(axes_gltf_embedded())},
          {"binary", bytes_of(axes_glb())},
          {"behind", bytes_of(axes_glb() + "behind")},
          {"sparse",
           bytes_of(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0,
   1, 0, 0, 0, 0, 0.999999]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors":
  [{"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 0,
  "componentType": 5121}, "values": {"bufferView": 1}}}], "bufferViews": [{"buffer": 0, "byteLength": 1},
  {"buffer": 0, "byteOffset": 4, "byteLength": 12}], "buffers": [{"byteLength": 16, "uri":
  "data:;base64,AQAAAAAAgD8AAAAAAAAAAA=="}]})")},
          {"beside", bytes_of(axes_gltf(R"(, "uri": "beside.bin")"))}};
}

std::vector<std::string> surface_words() {
  return {"v ",
          "f ",
          "o ",
          "g ",
          "\\\n",
          "-1",
          "//",
          "solid ",
          "facet normal 0 0 1\n",
          "outer loop\n",
          "vertex ",
          "endloop\n",
          "endfacet\n",
          "endsolid\n",
          "ply\n",
          "format ascii 1.0\n",
          "format binary_little_endian 1.0\n",
          "format binary_big_endian 1.0\n",
          "element vertex ",
          "element face ",
          "element tristrips ",
          "property float x\n",
          "property double y\n",
          "property uchar z\n",
          "property list uchar int vertex_indices\n",
          "end_header\n",
          "POINTS ",
          " float\n",
          "POLYGONS ",
          "TRIANGLE_STRIPS ",
          "OFFSETS vtktypeint64\n",
          "CONNECTIVITY vtktypeint64\n",
          "POINT_DATA ",
          "CELL_DATA ",
          "\"asset\"",
          "\"version\"",
          "\"2.0\"",
          "\"scenes\"",
          "\"scene\"",
          "\"nodes\"",
          "\"children\"",
          "\"mesh\"",
          "\"meshes\"",
          "\"primitives\"",
          "\"attributes\"",
          "\"POSITION\"",
          "\"indices\"",
          "\"mode\"",
          "\"accessors\"",
          "\"bufferView\"",
          "\"bufferViews\"",
          "\"byteOffset\"",
          "\"byteLength\"",
          "\"byteStride\"",
          "\"componentType\"",
          "5120",
          "5121",
          "5123",
          "5125",
          "5126",
          "\"count\"",
          "\"type\"",
          "\"VEC3\"",
          "\"SCALAR\"",
          "\"normalized\"",
          "\"sparse\"",
          "\"values\"",
          "\"buffers\"",
          "\"buffer\"",
          "\"uri\"",
          "data:;base64,",
          "\"matrix\"",
          "\"rotation\"",
          "\"scale\"",
          "\"translation\"",
          "\"extensionsRequired\"",
          "\"KHR_mesh_quantization\"",
          "glTF",
          "JSON",
          "BIN",
          "nan",
          "1e9",
          "-1e9",
          "1e-308",
          "4294967295",
          "9007199254740991",
          "\r\n",
          "\r",
          "#",
          "SPACE=LPS",
          "SPACE=RAS",
          "end loop",
          "FIELD FieldData 1\n",
          "SPACE 1 1 string\n",
          "UNSTRUCTURED_GRID\n",
          "CELLS ",
          "CELL_TYPES ",
          "\xef\xbb\xbf",
          "\\u0041"};
}

}  // namespace trocar::fuzz
