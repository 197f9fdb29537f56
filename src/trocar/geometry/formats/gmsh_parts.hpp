// What the generations of Gmsh files share: nodes by number, tetrahedra by their nodes' numbers, and what is left out.
// Used by the gmsh_*.cpp only.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <trocar/geometry/formats/tet_reader.hpp>

namespace trocar::geometry {

/// Nodes of an element of each type, and what such elements are called.
struct GmshType {
  int type, nodes;
  const char* name;
};
const GmshType* gmsh_type(std::int64_t type);  ///< null where we know none
bool is_tet(const GmshType* type);

/// Fewest bytes of a node or an element in text: "1 0 0 0", "1 15 0 1" less what version 4 says once a block.
inline constexpr std::size_t kLeastNodeText = 7, kLeastElementText = 3;

struct GmshParts {
  MeshSource& in;
  double scale;
  int version = 0;  ///< times ten: 10, 20 .. 22, 40, 41; 0: not told yet
  MeshSource::Form form = MeshSource::Form::text;

  struct Node {
    std::int64_t tag;
    std::size_t at;
    int index;
  };
  struct Cell {
    std::array<std::int64_t, 4> tags;
    std::size_t at;
  };
  std::vector<Node> nodes{};
  std::vector<Cell> cells{};
  std::map<std::int64_t, std::int64_t> group{};  ///< of volumes, their first physical one
  TetMesh mesh{};                                ///< points and regions; cells once resolved
  LeftOut left_out{};

  bool binary() const { return form != MeshSource::Form::text; }
  /// Is there another record? Text only: a section that ends too early is a fault.
  bool more(const char* things, std::size_t done, std::size_t announced);
  void add_node(std::int64_t tag, std::size_t at, Vec3d point);
  /// Reads the nodes of a tetrahedron, each `width` bytes where binary. False: a fault, told already.
  bool tet(const GmshType& type, int width, std::int64_t region);
  /// An element that is no tetrahedron; false, as nothing more is read of it.
  bool other(std::int64_t type);
  /// Binary elements of other types cannot be stepped over: a fault of the block at `at`.
  const GmshType& known_type(std::size_t at, std::int64_t type);
  /// Numbers of nodes, which may have gaps and come in any order, become places in the mesh.
  void resolve();

 private:
  int index_of(std::int64_t tag, std::size_t at);
};

void read_plain_nodes(GmshParts& g, bool parametric);  ///< versions 1 and 2
void read_plain_elements(GmshParts& g);
void read_entities(GmshParts& g);  ///< version 4
void read_node_blocks(GmshParts& g);
void read_element_blocks(GmshParts& g);

}  // namespace trocar::geometry
