// glTF 2.0: the meshes of the scene that is shown, each at its nodes' places, as a part with the node's name.
#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/gltf_accessors.hpp>
#include <trocar/geometry/surface_files/gltf_nodes.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::geometry {
namespace {

/// Extensions without which a shape is not what it should be.
constexpr std::string_view kPacked[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                        "KHR_meshopt_compression"};
/// What may be required and does not concern the shape, or is read.
bool is_harmless(std::string_view extension) {
  return extension.substr(0, 14) == "KHR_materials_" || extension == "KHR_texture_transform" ||
         extension == "KHR_texture_basisu" || extension == "EXT_texture_webp" || extension == "KHR_lights_punctual" ||
         extension == "KHR_mesh_quantization";
}

class GltfReader {
 public:
  GltfReader(MeshSource& in, const std::string& name, const FilesBeside& beside) : m_gltf(in, beside), m_name(name) {}

  SurfaceFile read() {
    m_file.format = m_gltf.in_one_file() ? "glTF 2.0, binary" : "glTF 2.0, text";
    m_file.metres = 1;
    check_version();
    check_extensions();
    m_gltf.in().finish();
    for (const GltfPlaced& placed : gltf_placed(m_gltf)) add_part(placed);
    m_left_out.add("translations, rotations or scales of nodes with a matrix", beside_matrices());
    m_left_out.add("skins (the shape is the one without them)", std::int64_t(m_gltf.list("skins").size()));
    m_left_out.add("animations", std::int64_t(m_gltf.list("animations").size()));
    m_left_out.add("bytes behind the file's end", std::int64_t(m_gltf.bytes_behind()));
    m_left_out.tell(m_file.notes);
    return std::move(m_file);
  }

 private:
  GltfDocument m_gltf;
  std::string m_name;
  SurfaceFile m_file;
  SurfaceLeftOut m_left_out;
  std::size_t m_vertices = 0, m_triangles = 0, m_primitives = 0;  ///< of all parts

  /// The matrix counts where a node has both, which the format forbids.
  std::int64_t beside_matrices() {
    std::int64_t count = 0;
    for (const core::JsonValue& node : m_gltf.list("nodes"))
      for (const char* key : {"translation", "rotation", "scale"}) count += node.find("matrix") && node.find(key);
    return count;
  }

  void check_version() {
    const GltfItem asset = m_gltf.member(m_gltf.root(), "asset"), version = m_gltf.member(asset, "version");
    const GltfItem least = m_gltf.member(asset, "minVersion");
    const bool good = version && version->text.starts_with("2.") && (!least || least->text.starts_with("2."));
    if (!good)
      m_gltf.fault(version ? version : m_gltf.root(),
                   tr("expected an asset of version 2, got {}", m_gltf.shown(version)));
  }

  void check_extensions() {
    for (const core::JsonValue& item : m_gltf.items(m_gltf.member(m_gltf.root(), "extensionsRequired"))) {
      const std::string_view name = item.text;
      if (std::find(std::begin(kPacked), std::end(kPacked), name) != std::end(kPacked))
        m_gltf.fault(&item, tr("expected a mesh that is not compressed, got one packed by {}: save it without",
                               in_quotes(name)));
      else if (!is_harmless(name))
        m_gltf.fault(&item, tr("expected extensions that are known, got {} required", m_gltf.shown(&item)));
    }
  }

  std::string name_of(const GltfPlaced& placed) const {
    for (const GltfItem item : {m_gltf.member(placed.node, "name"), m_gltf.member(placed.mesh, "name")})
      if (item && !item->text.empty()) return item->text.substr(0, 200);
    return m_name;
  }

  void add_part(const GltfPlaced& placed) {
    SurfacePart part{name_of(placed), {}};
    for (const core::JsonValue& primitive : m_gltf.items(m_gltf.member(placed.mesh, "primitives")))
      add(&primitive, part.mesh);
    for (Vec3d& p : part.mesh.positions) {
      p = placed.place(p);
      for (int k = 0; k < 3; ++k) p[k] = checked_coordinate(m_gltf.in(), m_gltf.place(placed.node), p[k]);
    }
    m_left_out.take_flat(part.mesh.triangles);
    if (determinant(placed.place.linear) < 0)  // a mirror turns every triangle
      for (auto& t : part.mesh.triangles) std::swap(t[1], t[2]);
    m_vertices += part.mesh.positions.size();
    m_triangles += part.mesh.triangles.size();
    bound_items(m_gltf.in(), std::max(m_vertices, m_triangles), "vertices and triangles");
    m_file.parts.push_back(std::move(part));
  }

  void add(GltfItem primitive, TriMesh& mesh) {
    bound_items(m_gltf.in(), ++m_primitives, "primitives");
    const std::size_t mode = m_gltf.whole(primitive, "mode").value_or(4);
    m_file.points += mode == 0;
    if (mode < 4) return m_left_out.add(mode == 0 ? "primitives of points" : "primitives of lines");
    if (mode > 6) return m_gltf.fault(primitive, tr("expected a mode from 0 to 6, got {}", mode));
    if (m_gltf.member(primitive, "targets")) m_left_out.add("lists of morph targets");
    const GltfItem positions = m_gltf.named(m_gltf.member(primitive, "attributes"), "POSITION", "accessors");
    if (!positions) return m_gltf.fault(primitive, "expected POSITION of a primitive, got none that is there");
    const auto points = gltf_points(m_gltf, positions);
    if (!points) return;
    std::vector<int> indices(points->size());
    std::iota(indices.begin(), indices.end(), 0);
    if (m_gltf.member(primitive, "indices")) {
      const GltfItem accessor = m_gltf.named(primitive, "indices", "accessors");
      auto given = !accessor ? std::nullopt : gltf_indices(m_gltf, accessor, points->size());
      if (!given) return;
      indices = std::move(*given);
    }
    if (mode == 4 && indices.size() % 3 != 0)
      return m_gltf.fault(primitive, tr("expected three corners a triangle, got {} indices", indices.size()));
    bound_items(m_gltf.in(), mesh.positions.size() + points->size(), "vertices");
    bound_items(m_gltf.in(), mesh.triangles.size() + indices.size() / (mode == 4 ? 3 : 1), "triangles");
    const int shift = int(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), points->begin(), points->end());
    for (int& i : indices) i += shift;
    add_triangles(mode, indices, mesh.triangles);
  }

  static void add_triangles(std::size_t mode, const std::vector<int>& v, std::vector<std::array<int, 3>>& triangles) {
    if (mode == 5) return add_strip(v, triangles);
    if (mode == 4)
      for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.push_back({v[i], v[i + 1], v[i + 2]});
    if (mode == 6)
      for (std::size_t i = 2; i < v.size(); ++i) triangles.push_back({v[0], v[i - 1], v[i]});
  }
};

}  // namespace

SurfaceFile read_gltf(MeshSource& in, const std::string& name, const FilesBeside& beside) {
  return GltfReader(in, name, beside).read();
}

}  // namespace trocar::geometry
