// Gmsh version 4: blocks of nodes and elements that belong to an entity, whose physical groups stand in $Entities.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/gmsh_parts.hpp>

namespace trocar::geometry {
namespace {

/// A whole number without which nothing that follows can be read.
std::int64_t whole(GmshParts& g, int width, const char* what) {
  std::int64_t value = 0;
  if (!g.in.integer(value, width, what)) g.in.finish();
  return value;
}

void entity(GmshParts& g, int dim) {
  const std::int64_t tag = whole(g, 4, "an entity's number");
  const int places = dim == 0 && g.version == 41 ? 3 : 6;
  for (int i = 0; i < places; ++i) {
    double ignored = 0;
    if (!g.in.real(ignored, 8, "a coordinate of the entity's box")) g.in.finish();
  }
  const std::size_t groups = g.in.count("physical groups", g.binary() ? 4 : 1);
  for (std::size_t i = 0; i < groups; ++i) {
    const std::int64_t group = whole(g, 4, "a physical group");
    if (dim == 3 && i == 0) g.group[tag] = group;
  }
  if (dim > 0) {
    const std::size_t borders = g.in.count("bounding entities", g.binary() ? 4 : 1);
    for (std::size_t i = 0; i < borders; ++i) whole(g, 4, "a bounding entity");
  }
  g.in.end_record();
}

struct Block {
  std::int64_t dim, entity, detail;  ///< detail: are nodes parametric; the element's type
  std::size_t count, at;
};

Block block(GmshParts& g, const char* things, std::size_t least, const char* detail) {
  g.in.begin_record();
  Block b{0, 0, 0, 0, g.in.at()};
  if (g.version == 40) b.entity = whole(g, 4, "the block's entity");
  b.dim = whole(g, 4, "the entity's dimension");
  if (g.version == 41) b.entity = whole(g, 4, "the block's entity");
  b.detail = whole(g, 4, detail);
  b.count = g.in.count(things, least);
  g.in.end_record();
  return b;
}

/// Reads what stands in front of the blocks: their number, and the number of things in all of them.
std::array<std::size_t, 2> blocks_and(GmshParts& g, const char* things, std::size_t least) {
  const std::size_t blocks = g.in.count("blocks", g.binary() ? 20 : 7), all = g.in.count(things, least);
  if (g.version == 41)
    for (const char* end : {"the lowest number", "the highest number"}) whole(g, 8, end);
  g.in.end_record();
  return {blocks, all};
}

bool skip_parameters(GmshParts& g, int parameters) {
  double ignored = 0;
  if (g.binary()) g.in.skip_bytes(8 * std::uint64_t(parameters), "a node's parameters");
  for (int i = 0; i < parameters && !g.binary(); ++i)
    if (!g.in.real(ignored, 8, "a node's parameter")) return false;
  return true;
}

void nodes_one_by_one(GmshParts& g, std::size_t count, int parameters) {
  for (std::size_t i = 0; i < count && g.more("nodes", i, count); ++i) {
    const std::size_t at = g.in.at();
    std::int64_t tag = 0;
    Vec3d point;
    const bool known = g.in.integer(tag, 4, "a node's number");
    const bool placed = known && read_point(g.in, 8, g.scale, point);
    const bool good = (placed || g.binary()) && skip_parameters(g, parameters);
    if (known) g.add_node(tag, at, point);
    good ? g.in.end_record() : g.in.skip_line();
  }
}

void tags_then_points(GmshParts& g, std::size_t count, int parameters) {
  const std::size_t first = g.nodes.size();
  for (std::size_t i = 0; i < count && g.more("node numbers", i, count); ++i) {
    const std::size_t at = g.in.at();
    std::int64_t tag = 0;
    if (g.in.integer(tag, 8, "a node's number")) {
      g.add_node(tag, at, {});
      g.in.end_record();
    } else {
      g.in.skip_line();
    }
  }
  if (g.nodes.size() - first != count) g.in.finish();  // which place belongs to which number is lost
  for (std::size_t i = 0; i < count && g.more("places of nodes", i, count); ++i) {
    const bool placed = read_point(g.in, 8, g.scale, g.mesh.points[first + i]);
    const bool good = (placed || g.binary()) && skip_parameters(g, parameters);
    good ? g.in.end_record() : g.in.skip_line();
  }
}

void elements_of(GmshParts& g, const Block& b, int width) {
  const GmshType* t = g.binary() ? &g.known_type(b.at, b.detail) : gmsh_type(b.detail);
  const auto group = g.group.find(b.entity);
  const std::int64_t region = group == g.group.end() ? 0 : group->second;
  for (std::size_t i = 0; i < b.count && g.more("elements", i, b.count); ++i) {
    if (!is_tet(t)) {
      g.other(b.detail);
      g.binary() ? g.in.skip_bytes(std::uint64_t(width) * (1 + t->nodes), "an element") : g.in.skip_line();
      continue;
    }
    std::int64_t number = 0;
    const bool good = g.in.integer(number, width, "an element's number") && g.tet(*t, width, region);
    good ? g.in.end_record() : g.in.skip_line();
  }
}

}  // namespace

void read_entities(GmshParts& g) {
  g.in.set_form(g.form);
  g.in.begin_record();
  std::array<std::size_t, 4> counts{};
  constexpr const char* kNames[] = {"points", "curves", "surfaces", "volumes"};
  for (int dim = 0; dim < 4; ++dim) counts[dim] = g.in.count(kNames[dim], g.binary() ? 36 : 8);
  g.in.end_record();
  for (int dim = 0; dim < 4; ++dim)
    for (std::size_t i = 0; i < counts[dim] && g.more(kNames[dim], i, counts[dim]); ++i) {
      if (dim < 3 && !g.binary())
        g.in.skip_line();
      else
        entity(g, dim);
    }
}

void read_node_blocks(GmshParts& g) {
  g.in.set_form(g.form);  // first of all: in binary, blanks and line ends are numbers, too
  g.in.begin_record();
  const std::size_t at = g.in.at(), before = g.nodes.size();
  const std::size_t least = !g.binary() ? kLeastNodeText : g.version == 40 ? 28 : 32;
  const auto [blocks, all] = blocks_and(g, "nodes", least);
  for (std::size_t i = 0; i < blocks && g.more("blocks of nodes", i, blocks); ++i) {
    const Block b = block(g, "nodes", least, "whether nodes have parameters");
    const int parameters = b.detail != 0 ? int(std::clamp<std::int64_t>(b.dim, 0, 3)) : 0;
    g.version == 40 ? nodes_one_by_one(g, b.count, parameters) : tags_then_points(g, b.count, parameters);
  }
  if (g.nodes.size() - before != all && g.in.faults() == 0)
    g.in.fault(at, tr("expected {} nodes in the blocks, got {}", all, g.nodes.size() - before));
}

void read_element_blocks(GmshParts& g) {
  g.in.set_form(g.form);  // first of all: in binary, blanks and line ends are numbers, too
  g.in.begin_record();
  const std::size_t at = g.in.at();
  std::size_t done = 0;
  const std::size_t width = g.version == 40 ? 4 : 8, least = g.binary() ? 2 * width : 3;
  const auto [blocks, all] = blocks_and(g, "elements", least);
  for (std::size_t i = 0; i < blocks && g.more("blocks of elements", i, blocks); ++i) {
    const Block b = block(g, "elements", least, "an element type");
    done += b.count;
    elements_of(g, b, int(width));
  }
  if (done != all && g.in.faults() == 0) g.in.fault(at, tr("expected {} elements in the blocks, got {}", all, done));
}

}  // namespace trocar::geometry
