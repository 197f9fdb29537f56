#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/gmsh_parts.hpp>

namespace trocar::geometry {
namespace {

constexpr GmshType kGmshTypes[] = {
    {1, 2, "lines"},        {2, 3, "triangles"},    {3, 4, "quadrangles"},  {4, 4, "tetrahedra"},
    {5, 8, "hexahedra"},    {6, 6, "prisms"},       {7, 5, "pyramids"},     {8, 3, "lines"},
    {9, 6, "triangles"},    {10, 9, "quadrangles"}, {11, 10, "tetrahedra"}, {12, 27, "hexahedra"},
    {13, 18, "prisms"},     {14, 14, "pyramids"},   {15, 1, "points"},      {16, 8, "quadrangles"},
    {17, 20, "hexahedra"},  {18, 15, "prisms"},     {19, 13, "pyramids"},   {20, 9, "triangles"},
    {21, 10, "triangles"},  {22, 12, "triangles"},  {23, 15, "triangles"},  {24, 15, "triangles"},
    {25, 21, "triangles"},  {26, 4, "lines"},       {27, 5, "lines"},       {28, 6, "lines"},
    {29, 20, "tetrahedra"}, {30, 35, "tetrahedra"}, {31, 56, "tetrahedra"}, {92, 64, "hexahedra"},
    {93, 125, "hexahedra"},
};

}  // namespace

const GmshType* gmsh_type(std::int64_t type) {
  for (const GmshType& t : kGmshTypes)
    if (t.type == type) return &t;
  return nullptr;
}

bool is_tet(const GmshType* t) { return t && t->name == std::string_view("tetrahedra"); }

bool GmshParts::more(const char* things, std::size_t done, std::size_t announced) {
  if (in.binary()) return true;
  in.begin_record();
  const std::string_view next = in.peek_word();
  if (!next.empty() && next[0] != '$') return true;
  in.fault(in.at(), tr("expected {} {}, got {} after {}", announced, things, in.shown(in.at()), done));
  return false;
}

void GmshParts::add_node(std::int64_t tag, std::size_t at, Vec3d point) {
  nodes.push_back({tag, at, int(mesh.points.size())});
  mesh.points.push_back(point);
}

bool GmshParts::tet(const GmshType& type, int width, std::int64_t region) {
  in.begin_value();
  Cell cell{{}, in.at()};
  for (int k = 0; k < type.nodes; ++k) {
    std::int64_t tag = 0;
    if (!in.integer(tag, width, "a node's number")) return false;
    if (k < 4) cell.tags[k] = tag;
  }
  if (type.nodes > 4) left_out.middle_nodes(type.nodes);
  if (region < std::numeric_limits<int>::min() || region > std::numeric_limits<int>::max()) {
    in.fault(cell.at, tr("expected a region of 32 bits, got {}", region));
    return true;
  }
  cells.push_back(cell);
  mesh.region.push_back(int(region));
  return true;
}

bool GmshParts::other(std::int64_t type) {
  const GmshType* t = gmsh_type(type);
  left_out.cell(t ? t->name : tr("elements of type {}", type));
  return false;
}

const GmshType& GmshParts::known_type(std::size_t at, std::int64_t type) {
  const GmshType* t = gmsh_type(type);
  if (!t) in.lose(at, tr("expected an element type from 1 to 31, 92 or 93, got {}", type));
  return *t;
}

void GmshParts::resolve() {
  in.set_form(form);
  if (version == 0 && in.faults() == 0) in.lose(0, "expected $MeshFormat or $NOD, got neither");
  std::stable_sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.tag < b.tag; });
  for (std::size_t i = 1; i < nodes.size(); ++i)
    if (nodes[i].tag == nodes[i - 1].tag)
      in.fault(nodes[i].at, tr("expected every node's number once, got {} again", nodes[i].tag));
  for (const Cell& cell : cells) {
    std::array<int, 4> corners{};
    for (int k = 0; k < 4; ++k) corners[k] = index_of(cell.tags[k], cell.at);
    mesh.cells.push_back(corners);
  }
  if (cells.empty() && in.faults() == 0)
    in.lose(0,
            tr("expected tetrahedra, got {}: mesh it in 3D (gmsh -3), or save a surface as STL", left_out.instead()));
}

int GmshParts::index_of(std::int64_t tag, std::size_t at) {
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), tag,
                                      [](const Node& node, std::int64_t wanted) { return node.tag < wanted; });
  if (found != nodes.end() && found->tag == tag) return found->index;
  in.fault(at, tr("expected the number of a node that is there, got {}", tag));
  return 0;
}

}  // namespace trocar::geometry
