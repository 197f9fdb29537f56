// glTF: nodes, primitives, buffers, and everything that can lie about them.
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/surface_files/base64.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>

#include "surface_bytes.hpp"

namespace trocar::geometry {
namespace {

std::string gltf_faults(const std::string& bytes) {
  try {
    read_surfaces(bytes, "a.gltf");
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}
std::string changed(std::string text, const std::string& what, const std::string& in_its_place) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), in_its_place);
}
/// The tetrahedron with other nodes.
SurfaceFile with_nodes(const std::string& nodes) {
  return read_surfaces(changed(axes_gltf_embedded(), R"({"name": "axes", "mesh": 0})", nodes), "a.gltf");
}
std::string faults_of_nodes(const std::string& nodes) {
  return gltf_faults(changed(axes_gltf_embedded(), R"({"name": "axes", "mesh": 0})", nodes));
}
void expect_near(Vec3d a, Vec3d b) { EXPECT_LT(length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; }

/// A square of four corners in the plane, as one primitive of a mode, with or without indices.
SurfaceFile square(int mode, std::vector<int> indices, int component_type) {
  MeshBytes f;
  f.all<float>(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0);
  for (const int i : indices) {
    if (component_type == 5121) f.number(std::uint8_t(i));
    if (component_type == 5123) f.number(std::uint16_t(i));
    if (component_type == 5125) f.number(std::uint32_t(i));
  }
  const std::size_t rest = f.bytes.size() - 48;
  std::string json = R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"name": "square",
    "primitives": [{"attributes": {"POSITION": 0}, "mode": )" +
                     std::to_string(mode) + (indices.empty() ? "" : R"(, "indices": 1)") + R"(}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
      {"bufferView": 1, "componentType": )" +
                     std::to_string(component_type) + R"(, "count": )" + std::to_string(indices.size()) +
                     R"(, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": )" +
                     std::to_string(rest) + R"(}], "buffers": [{"byteLength": )" + std::to_string(48 + rest) + "}]}";
  return read_surfaces(glb_of(json, f.bytes), "a.glb");
}

}  // namespace

TEST(Gltf, NodesCarryTheirMeshesOneIntoTheOther) {
  const SurfaceFile file = with_nodes(
      R"({"name": "moved", "translation": [10, 0, 0], "children": [1, 2]},
         {"name": "turned", "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752], "scale": [2, 2, 2], "mesh": 0},
         {"name": "by matrix", "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1], "mesh": 0})");
  ASSERT_EQ(file.parts.size(), 2u);
  EXPECT_EQ(file.parts[0].name, "turned");
  EXPECT_EQ(file.parts[1].name, "by matrix");
  expect_near(file.parts[0].mesh.positions[1], {10, 2, 0});  // (1, 0, 0) doubled, turned to y, moved
  expect_near(file.parts[0].mesh.positions[2], {6, 0, 0});
  expect_near(file.parts[1].mesh.positions[1], {10, 1, 5});
  EXPECT_NEAR(volume(file.parts[0].mesh), 8, 1e-12);
  EXPECT_EQ(file.metres, 1);
}

TEST(Gltf, AMirrorTurnsTheTrianglesSoThatTheyStillFaceOutwards) {
  EXPECT_NEAR(volume(with_nodes(R"({"scale": [-1, 1, 1], "mesh": 0})").parts[0].mesh), 1, 1e-12);
  EXPECT_NEAR(volume(with_nodes(R"({"scale": [-1, -1, 1], "mesh": 0})").parts[0].mesh), 1, 1e-12);
}

TEST(Gltf, TrianglesStripsAndFansWithEveryKindOfIndices) {
  for (const int type : {5121, 5123, 5125}) {
    const auto up = [&](const SurfaceFile& file) {
      double sum = 0;
      const TriMesh& mesh = file.parts.at(0).mesh;
      for (int t = 0; t < int(mesh.triangles.size()); ++t) {
        EXPECT_GT(area_vector(mesh, t).z, 0);
        sum += area_vector(mesh, t).z / 2;
      }
      return sum;
    };
    EXPECT_EQ(up(square(4, {0, 1, 2, 0, 2, 3}, type)), 1);
    EXPECT_EQ(up(square(5, {0, 1, 3, 2}, type)), 1);
    EXPECT_EQ(up(square(6, {0, 1, 2, 3}, type)), 1);
  }
  EXPECT_EQ(square(6, {}, 5121).parts[0].mesh.triangles.size(), 2u) << "without indices all vertices in their order";
  EXPECT_EQ(square(6, {}, 5121).parts[0].name, "square");
  EXPECT_THROW(square(1, {0, 1}, 5121), core::BadInput);
}

TEST(Gltf, SparseAccessorsHaveTheirValuesPutIn) {
  MeshBytes f;
  f.all<float>(0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0).all<std::uint16_t>(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3);
  f.all<float>(0, 0, 3).all<std::uint8_t>(3, 0, 0, 0);
  std::string json = axes_gltf("");
  json = changed(json, R"("count": 4,)", R"("count": 4, "sparse": {"count": 1, "indices": {"bufferView": 3,
    "componentType": 5121}, "values": {"bufferView": 2}},)");
  json = changed(json, R"("byteLength": 24})",
                 R"("byteLength": 24}, {"buffer": 0, "byteOffset": 72, "byteLength": 12},
    {"buffer": 0, "byteOffset": 84, "byteLength": 4})");
  json = changed(json, R"("byteLength": 72)", R"("byteLength": 88)");
  EXPECT_EQ(read_surfaces(glb_of(json, f.bytes), "a.glb").parts[0].mesh.positions, axes_mesh().positions);
  f.bytes[84] = 4;
  EXPECT_NE(gltf_faults(glb_of(json, f.bytes)).find("expected whole numbers below 4 as sparse indices"),
            std::string::npos);
}

TEST(Gltf, SparseAccessorsWithoutAViewBeginWithZeros) {
  MeshBytes f;
  f.all<float>(1, 0, 0, 0, 2, 0, 0, 0, 3).all<std::uint16_t>(1, 2, 3, 0);
  for (const auto& t : axes_mesh().triangles) f.all<std::uint16_t>(t[0], t[1], t[2]);
  const std::string json = R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 3,
      "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}},
      {"bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6},
      {"buffer": 0, "byteOffset": 44, "byteLength": 24}], "buffers": [{"byteLength": 68}]})";
  EXPECT_EQ(read_surfaces(glb_of(json, f.bytes), "a.glb").parts.at(0).mesh.positions, axes_mesh().positions);
}

TEST(Gltf, MatricesMayBeRounded) {
  const char* rounded = R"({"mesh": 0, "matrix": [1, 0, 0, 1e-7, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 0.9999999]})";
  EXPECT_NEAR(with_nodes(rounded).parts.at(0).mesh.positions[1].x, 6, 1e-12);
  EXPECT_NE(faults_of_nodes(R"({"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.99]})"), "");
}

TEST(Gltf, AMatrixCountsWhereANodeHasATranslationToo) {
  const SurfaceFile file = with_nodes(
      R"({"mesh": 0, "translation": [9, 0, 0], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]})");
  EXPECT_NEAR(file.parts.at(0).mesh.positions[1].x, 6, 1e-12);
  EXPECT_EQ(file.notes.front(), "1 translations, rotations or scales of nodes with a matrix left out");
}

TEST(Gltf, QuantizedPositionsAreRead) {
  MeshBytes f;
  for (const Vec3d& p : axes_mesh().positions) f.all<std::int16_t>(p.x * 10000, -p.y * 10000, p.z * 10000, 77);
  while (f.bytes.size() < 48) f.number(std::uint8_t(0));
  for (const auto& t : axes_mesh().triangles) f.all<std::uint16_t>(t[0], t[1], t[2]);
  std::string json = axes_gltf("");
  json = changed(json, R"("componentType": 5126)", R"("componentType": 5122, "normalized": true)");
  json = changed(json, R"("byteLength": 48})", R"("byteLength": 48, "byteStride": 8})");
  json = changed(json, R"("scene": 0,)", R"("scene": 0, "extensionsRequired": ["KHR_mesh_quantization"],)");
  const TriMesh mesh = read_surfaces(glb_of(json, f.bytes), "a.glb").parts[0].mesh;
  EXPECT_DOUBLE_EQ(mesh.positions[2].y, -20000.0 / 32767);
}

TEST(Gltf, WhatIsPackedOrUnknownIsRefusedAndWhatMovesIsLeftOut) {
  const auto required = [](const std::string& name) {
    return gltf_faults(
        changed(axes_gltf_embedded(), R"("scene": 0,)", R"("scene": 0, "extensionsRequired": [")" + name + "\"],"));
  };
  EXPECT_NE(required("KHR_draco_mesh_compression")
                .find("expected a mesh that is not compressed, got one packed by 'KHR_draco_mesh_compression'"),
            std::string::npos);
  EXPECT_NE(required("EXT_meshopt_compression").find("packed by 'EXT_meshopt_compression'"), std::string::npos);
  EXPECT_NE(required("X_odd").find("expected extensions that are known, got \"X_odd\" required"), std::string::npos);
  EXPECT_EQ(required("KHR_materials_unlit"), "");
  const std::string moving =
      changed(axes_gltf_embedded(), R"("scene": 0,)", R"("scene": 0, "skins": [{}], "animations": [{}, {}],)");
  EXPECT_EQ(
      read_surfaces(moving, "a").notes,
      (std::vector<std::string>{"1 skins (the shape is the one without them) left out", "2 animations left out"}));
  EXPECT_NE(gltf_faults(changed(axes_gltf_embedded(), "\"2.0\"", "\"1.0\""))
                .find("expected an asset of version 2, got \"1.0\""),
            std::string::npos);
}

TEST(Gltf, CirclesAndNodesWithTwoParentsAreFaults) {
  EXPECT_NE(faults_of_nodes(R"({"children": [0]})").find("got node 0 again"), std::string::npos);
  EXPECT_NE(faults_of_nodes(R"({"children": [1]}, {"children": [2]}, {"children": [1]})").find("got node 1 again"),
            std::string::npos);
  EXPECT_NE(faults_of_nodes(R"({"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0})")
                .find("got node 3 again"),
            std::string::npos);
  EXPECT_NE(faults_of_nodes(R"({"children": [7]})").find("expected one of 1 nodes, got 7"), std::string::npos);
}

TEST(Gltf, ALongChainOfNodesIsNoDeepRecursion) {
  std::string nodes;
  for (int n = 0; n < 100'000; ++n)
    nodes += R"({"translation": [0.001, 0, 0], "children": [)" + std::to_string(n + 1) + "]},";
  const SurfaceFile file = with_nodes(nodes + R"({"mesh": 0})");
  EXPECT_NEAR(file.parts.at(0).mesh.positions[0].x, 100, 1e-6);
}

TEST(Gltf, AShortFileThatNamesOneMeshManyTimesIsBounded) {
  std::string nodes = R"({"children": [)", leaves;
  for (int n = 1; n <= 400; ++n) {
    nodes += (n > 1 ? "," : "") + std::to_string(n);
    leaves += R"(,{"mesh": 0})";
  }
  EXPECT_EQ(with_nodes(nodes + "]}" + leaves).parts.size(), 400u);
  std::string many;
  for (int p = 0; p < 30'000; ++p) many += R"({"attributes": {"POSITION": 0}, "indices": 1},)";
  const std::string bytes =
      changed(changed(axes_gltf_embedded(), R"({"name": "axes", "mesh": 0})", nodes + "]}" + leaves),
              R"("primitives": [)", R"("primitives": [)" + many);
  EXPECT_NE(gltf_faults(bytes).find("expected at most 8388608 "), std::string::npos);
}

TEST(Gltf, NumbersThatLieAboutBuffersAreFaults) {
  const std::pair<const char*, const char*> lies[] = {
      {R"("count": 4,)", R"("count": 4000000000,)"},
      {R"("count": 4,)", R"("count": 5,)"},
      {R"("count": 4,)", R"("count": -4,)"},
      {R"("count": 4,)", R"("count": 3,)"},
      {R"("count": 12,)", R"("count": 13,)"},
      {R"("count": 12,)", R"("count": 11,)"},
      {R"("byteLength": 48})", R"("byteLength": 47})"},
      {R"("byteLength": 48})", R"("byteLength": 48, "byteStride": 3})"},
      {R"("byteLength": 48})", R"("byteLength": 48, "byteStride": 0})"},
      {R"("byteOffset": 48, "byteLength": 24})", R"("byteOffset": 48, "byteLength": 9007199254740991})"},
      {R"("byteOffset": 48, "byteLength": 24})", R"("byteOffset": 9007199254740991, "byteLength": 24})"},
      {R"("buffer": 0, "byteOffset": 0)", R"("buffer": 1, "byteOffset": 0)"},
      {R"("bufferView": 0,)", R"("bufferView": 2,)"},
      {R"("bufferView": 0, "componentType")", R"("componentType")"},
      {R"("componentType": 5126)", R"("componentType": 5125.5)"},
      {R"("componentType": 5126)", R"("componentType": 5127)"},
      {R"("type": "VEC3")", R"("type": "VEC4")"},
      {R"("POSITION": 0)", R"("POSITION": 2)"},
      {R"("POSITION": 0)", R"("PLACE": 0)"},
      {R"("byteLength": 72)", R"("byteLength": 73)"},
      {R"("mesh": 0)", R"("mesh": 1)"},
      {R"("nodes": [0])", R"("nodes": [1])"},
      {R"("meshes": [)", R"("meshes": 7, "x": [)"},
  };
  for (const auto& [good, lie] : lies) EXPECT_NE(gltf_faults(changed(axes_gltf_embedded(), good, lie)), "") << lie;
  EXPECT_NE(
      gltf_faults(axes_gltf(R"(, "uri": "beside.bin")")).find("expected data in the file itself, got \"beside.bin\""),
      std::string::npos);
  EXPECT_NE(gltf_faults(axes_gltf(R"(, "uri": "data:,hello")")).find("expected data in base64"), std::string::npos);
}

TEST(Gltf, ChunksOfBinaryFilesThatLieAreFaults) {
  const std::string good = axes_glb();
  const auto with_byte = [&](std::size_t at, char value) {
    std::string bytes = good;
    bytes[at] = value;
    return gltf_faults(bytes);
  };
  EXPECT_NE(with_byte(4, 1).find("at byte 4: expected glTF of version 2, got 1"), std::string::npos);
  EXPECT_NE(with_byte(10, 1).find("expected at most the file's length, "), std::string::npos);
  EXPECT_NE(with_byte(15, '\x7f').find("at byte 12: expected a chunk of at most "), std::string::npos);
  EXPECT_NE(with_byte(16, 'B').find("at byte 16: expected JSON in the first chunk"), std::string::npos);
}

TEST(Gltf, JsonIsReadStrictlyAndNotTooDeep) {
  const std::pair<const char*, const char*> bad[] = {
      {"{", "a.gltf:1:2: expected '}' to close the object that began at 1:1, got the end of the file"},
      {"{\"a\" 1}", "a.gltf:1:6: expected ':' after the key \"a\", got 1"},
      {"{\"a\": 01}", "a.gltf:1:7: expected a number as JSON writes it (like -0.5 or 2e-3), got 01"},
      {"{\"a\": 1e999}", "a.gltf:1:7: expected a finite number, got 1e999"},
      {"{\"a\": nul}", "a.gltf:1:7: expected a value, got nul"},
      {"{\"a\": [1,]}", "a.gltf:1:9: expected another item after ',', got ']'"},
      {"{\"a\": \"x", "a.gltf:1:9: expected '\"' to close the string that began at 1:7, got the end of the file"},
      {"{} x", "a.gltf:1:4: expected the end of the file, got x"},
  };
  for (const auto& [text, told] : bad) EXPECT_EQ(gltf_faults(text), told);
  EXPECT_EQ(gltf_faults("{\"a\": " + std::string(100'000, '[')),
            "a.gltf:1:70: expected at most 64 levels of nesting, got more");
  std::string many = "{\"a\": [";
  for (int i = 0; i < 1000; ++i) many += "x,";
  EXPECT_LT(gltf_faults(many).size(), 4000u) << "faults are bounded";
}

TEST(Gltf, NamesHaveTheirEscapesResolved) {
  EXPECT_EQ(with_nodes(R"({"name": "L\u00e4ngs \"1\" \ud83e\udec0", "mesh": 0})").parts[0].name,
            "L\xc3\xa4ngs \"1\" \xf0\x9f\xab\x80");
}

TEST(Gltf, Base64IsReadWithAndWithoutPadding) {
  for (const char* text : {"", "f", "fo", "foo", "foob", "fooba", "foobar"}) {
    std::string packed = to_base64(text);
    EXPECT_EQ(from_base64(packed), text);
    while (!packed.empty() && packed.back() == '=') packed.pop_back();
    EXPECT_EQ(from_base64(packed), text);
  }
  for (const char* bad : {"A", "Zm9v!", "Zm=v", "Zm9vY"}) EXPECT_FALSE(from_base64(bad).has_value()) << bad;
}

}  // namespace trocar::geometry
