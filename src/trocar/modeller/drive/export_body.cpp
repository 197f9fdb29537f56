#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/drive/export_body.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::modeller {
namespace {

constexpr double kMillimetre = 1e-3;

[[noreturn]] void refuse_export(std::string message) { throw core::BadInput({{{"", 0, 0}, std::move(message)}}); }

geometry::TriMesh skin_mesh(const tissue::Skin& skin) {
  geometry::TriMesh mesh;
  for (const Vec3f& p : skin.rest) mesh.positions.push_back(vec_cast<double>(p));
  mesh.triangles = skin.triangles;
  return mesh;
}

struct Body {
  geometry::TriMesh surface;
  const tissue::NetworkModel* network = nullptr;
  const geometry::CuttableTets* cells = nullptr;  ///< of what can be cut: its springs are their edges
};

Body body_named(const sim::Model& model, const std::string& name) {
  for (const sim::SolidModel& solid : model.solids)
    if (solid.name == name) return {skin_mesh(solid.fine), &solid.network};
  for (std::size_t i = 0; i < model.cuttables.size(); ++i)
    if (model.cuttables[i].name == name)
      return {skin_mesh(model.skin(int(model.solids.size() + i))), nullptr, &model.cuttables[i].body.drawn};
  for (const auto& membrane : model.membranes)
    if (membrane.name == name) {
      geometry::TriMesh mesh;
      mesh.positions = membrane.sheet.network.rest;
      mesh.triangles = membrane.sheet.triangles;
      return {std::move(mesh), &membrane.sheet.network};
    }
  refuse_export(fmt::format("expected an organ, a fold or a pouch to export, got \"{}\"", name));
}

/// Gmsh's format 2.2: nodes, springs as lines of two nodes, cells as tetrahedra.
std::string network_text(const tissue::NetworkModel& n) {
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(n.rest.size()) + "\n";
  for (std::size_t i = 0; i < n.rest.size(); ++i)
    out += fmt::format("{} {} {} {}\n", i + 1, n.rest[i].x / kMillimetre, n.rest[i].y / kMillimetre,
                       n.rest[i].z / kMillimetre);
  const std::size_t springs = n.spring_nodes.size() / 2;
  out += "$EndNodes\n$Elements\n" + std::to_string(springs + n.tets.size()) + "\n";
  for (std::size_t i = 0; i < springs; ++i)
    out += fmt::format("{} 1 2 1 1 {} {}\n", i + 1, n.spring_nodes[2 * i] + 1, n.spring_nodes[2 * i + 1] + 1);
  for (std::size_t i = 0; i < n.tets.size(); ++i) {
    out += fmt::format("{} 4 2 2 2", springs + i + 1);
    for (const int row : n.tets[i].row) out += fmt::format(" {}", n.node_of_row[std::size_t(row)] + 1);
    out += '\n';
  }
  return out + "$EndElements\n";
}

geometry::TetMesh cells_of_body(const geometry::CuttableTets& drawn) {
  geometry::TetMesh mesh;
  mesh.points.assign(drawn.rest.begin(), drawn.rest.begin() + drawn.nodes);
  for (const auto& c : drawn.cells) mesh.cells.push_back({c[0], c[1], c[2], c[3]});
  return mesh;
}

}  // namespace

std::string exported(const sim::Model& model, const std::string& name, const std::string& ending) {
  const Body body = body_named(model, name);
  if (ending == ".obj") return geometry::to_obj(body.surface, kMillimetre);
  if (ending == ".stl") return geometry::to_stl(body.surface, kMillimetre);
  if (ending == ".ply") return geometry::to_ply(body.surface, kMillimetre);
  if (ending == ".vtk") return geometry::to_polydata(body.surface, kMillimetre);
  if (ending == ".msh" && body.network) return network_text(*body.network);
  if (ending == ".msh") return geometry::to_gmsh(cells_of_body(*body.cells), kMillimetre);
  refuse_export(fmt::format("expected a file that ends in .obj, .stl, .ply, .vtk or .msh, got \"{}\"", ending));
}

}  // namespace trocar::modeller
