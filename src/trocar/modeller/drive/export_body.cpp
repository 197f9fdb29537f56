#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/drive/export_body.hpp>
#include <trocar/modeller/drive/line_tube.hpp>
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

/// A body for a file: what bounds it, and what it is made of.
struct Body {
  geometry::TriMesh surface;
  std::vector<Vec3d> nodes;  ///< [m]
  std::vector<std::array<int, 2>> springs;
  std::vector<std::array<int, 3>> faces;  ///< of what is but a surface
  std::vector<std::array<int, 4>> cells;
  const geometry::CuttableTets* drawn = nullptr;  ///< of what can be cut: its springs are their edges
};

Body body_of_network(geometry::TriMesh surface, const tissue::NetworkModel& n) {
  Body body{std::move(surface), n.rest, {}, {}, {}};
  for (std::size_t i = 0; i + 1 < n.spring_nodes.size(); i += 2)
    body.springs.push_back({int(n.spring_nodes[i]), int(n.spring_nodes[i + 1])});
  for (const auto& tet : n.tets) {
    const auto node = [&](std::size_t corner) { return int(n.node_of_row[std::size_t(tet.row[corner])]); };
    body.cells.push_back({node(0), node(1), node(2), node(3)});
  }
  return body;
}

/// A strand or a vessel: a tube of its outer radius, its middle line as springs from node to node.
Body body_of_line(std::vector<Vec3d> nodes, std::span<const double> radius) {
  Body body{tube_around(nodes, radius), std::move(nodes), {}, {}, {}};
  for (int i = 0; i + 1 < int(body.nodes.size()); ++i) body.springs.push_back({i, i + 1});
  return body;
}

Body body_of_vessel(const sim::Vessel& vessel) {
  std::vector<Vec3d> line;
  std::vector<double> radius;
  for (const interactions::VesselPoint& p : vessel.path.points) line.push_back(p.drawn), radius.push_back(p.radius);
  return body_of_line(std::move(line), radius);
}

Body body_of(const sim::Model& model, sim::SolidRef r) {
  return body_of_network(skin_mesh(sim::model_of(model, r).fine), sim::model_of(model, r).network);
}
Body body_of(const sim::Model& model, sim::CuttableRef r) {
  Body body{skin_mesh(model.skin(int(r.number))), {}, {}, {}, {}};
  body.drawn = &sim::model_of(model, r).body.drawn;
  return body;
}
Body body_of(const sim::Model& model, sim::StrandRef r) {
  return body_of_line(model.strand_bodies[r.index].model.rest, sim::model_of(model, r).outer);
}
Body body_of(const sim::Model& model, sim::MembraneRef r) {
  const tissue::MembraneModel& sheet = sim::model_of(model, r).sheet;
  geometry::TriMesh mesh;
  mesh.positions = sheet.network.rest;
  mesh.triangles = sheet.triangles;
  return body_of_network(std::move(mesh), sheet.network);
}

Body body_named(const sim::Model& model, const std::string& name) {
  std::optional<Body> found;
  sim::visit_bodies(model, [&](auto ref) {
    if (!found && sim::model_of(model, ref).name == name) found = body_of(model, ref);
  });
  if (found) return std::move(*found);
  for (const sim::Vessel& vessel : model.vessels.list)
    if (vessel.name == name) return body_of_vessel(vessel);
  for (const sim::WallModel& wall : model.walls)
    if (wall.name == name) {
      geometry::TriMesh mesh = skin_mesh(wall.skin);
      return {mesh, mesh.positions, {}, mesh.triangles, {}};
    }
  refuse_export(tr("expected an organ, a strand, a fold, a pouch, a vessel or a wall to export, got \"{}\"", name));
}

/// Gmsh's format 2.2: nodes, springs as lines of two nodes, faces as triangles, cells as tetrahedra.
std::string network_text(const Body& body) {
  std::string out = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", body.nodes.size());
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    out += fmt::format("{} {} {} {}\n", i + 1, body.nodes[i].x / kMillimetre, body.nodes[i].y / kMillimetre,
                       body.nodes[i].z / kMillimetre);
  out += fmt::format("$EndNodes\n$Elements\n{}\n", body.springs.size() + body.faces.size() + body.cells.size());
  std::size_t number = 0;
  const auto write = [&](const auto& elements, const char* type_and_tags) {
    for (const auto& element : elements) {
      out += fmt::format("{} {}", ++number, type_and_tags);
      for (const int node : element) out += fmt::format(" {}", node + 1);
      out += '\n';
    }
  };
  write(body.springs, "1 2 1 1");
  write(body.faces, "2 2 3 3");
  write(body.cells, "4 2 2 2");
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
  if (ending == ".msh" && !body.drawn) return network_text(body);
  if (ending == ".msh") return geometry::to_gmsh(cells_of_body(*body.drawn), kMillimetre);
  refuse_export(tr("expected a file that ends in .obj, .stl, .ply, .vtk or .msh, got \"{}\"", ending));
}

}  // namespace trocar::modeller
