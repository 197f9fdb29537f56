// Gmsh versions 1 and 2: one node, one element a line; binary elements of version 2 in blocks of one type.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/gmsh_parts.hpp>

namespace trocar::geometry {
namespace {

bool read_tags(GmshParts& g, std::int64_t tags, std::int64_t& region) {
  for (std::int64_t i = 0; i < tags; ++i) {
    std::int64_t tag = 0;
    if (!g.in.integer(tag, 4, "a tag")) return false;
    if (i == 0) region = tag;
  }
  return true;
}

/// Behind a node's place, where nodes have parameters: dimension and number of its entity, and as many parameters as
/// curves and surfaces have.
bool read_parameters(GmshParts& g) {
  std::int64_t dim = 0, entity = 0;
  if (!g.in.integer(dim, 4, "the dimension of the node's entity") || !g.in.integer(entity, 4, "the node's entity"))
    return false;
  double ignored = 0;
  const std::int64_t parameters = dim == 1 || dim == 2 ? dim : 0;
  for (std::int64_t i = 0; i < parameters; ++i)
    if (!g.in.real(ignored, 8, "a node's parameter") && !g.binary()) return false;
  return true;
}

/// number type physical elementary nodes node ...: the first two are read.
bool old_element(GmshParts& g, std::int64_t type) {
  const GmshType* t = gmsh_type(type);
  if (!is_tet(t)) return g.other(type);
  std::int64_t physical = 0, elementary = 0, nodes = 0;
  if (!g.in.integer(physical, 4, "a physical region") || !g.in.integer(elementary, 4, "an elementary region"))
    return false;
  g.in.begin_value();
  const std::size_t at = g.in.at();
  if (!g.in.integer(nodes, 4, "the number of nodes")) return false;
  if (nodes == t->nodes) return g.tet(*t, 4, physical);
  g.in.fault(at, tr("expected {} nodes of an element of type {}, got {}", t->nodes, type, nodes));
  return false;
}

/// number type tags tag ... node ...: the first two are read.
bool tagged_element(GmshParts& g, std::int64_t type) {
  const GmshType* t = gmsh_type(type);
  if (!is_tet(t)) return g.other(type);
  g.in.begin_value();
  const std::size_t at = g.in.at();
  std::int64_t tags = 0;
  if (!g.in.integer(tags, 4, "the number of tags")) return false;
  if (tags < 0) {
    g.in.fault(at, tr("expected the number of tags, got {}", tags));
    return false;
  }
  std::int64_t region = 0;
  return read_tags(g, tags, region) && g.tet(*t, 4, region);
}

void packed_element(GmshParts& g, const GmshType& type, std::int64_t tags, std::size_t bytes) {
  if (!is_tet(&type)) {
    g.other(type.type);
    return g.in.skip_bytes(bytes, "an element");
  }
  std::int64_t number = 0, region = 0;
  g.in.integer(number, 4, "an element's number");
  read_tags(g, tags, region);
  g.tet(type, 4, region);
}

/// Version 2, binary: blocks of elements of one type with the same number of tags.
void packed_elements(GmshParts& g, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const std::size_t at = g.in.at();
    std::int64_t type = 0, follow = 0, tags = 0;
    g.in.integer(type, 4, "an element type");
    g.in.integer(follow, 4, "the number of elements of this type");
    g.in.integer(tags, 4, "the number of tags");
    const GmshType& t = g.known_type(at, type);
    if (tags < 0 || tags > std::int64_t(g.in.left() / 4))
      g.in.lose(at, tr("expected the number of tags, got {}", tags));
    const std::size_t bytes = 4 * (1 + std::size_t(tags) + std::size_t(t.nodes));
    const std::size_t most = std::min(count - done, g.in.left() / bytes);
    if (follow < 1 || std::uint64_t(follow) > most)
      g.in.lose(at, tr("expected 1 to {} elements of type {}, got {}", most, type, follow));
    for (std::int64_t i = 0; i < follow; ++i) packed_element(g, t, tags, bytes);
    done += std::size_t(follow);
  }
}

}  // namespace

void read_plain_nodes(GmshParts& g, bool parametric) {
  g.in.begin_record();
  const std::size_t count = g.in.count("nodes", g.binary() ? 28 : kLeastNodeText);
  g.in.skip_line();
  g.in.set_form(g.form);
  for (std::size_t i = 0; i < count && g.more("nodes", i, count); ++i) {
    const std::size_t at = g.in.at();
    std::int64_t tag = 0;
    Vec3d point;
    const bool known = g.in.integer(tag, 4, "a node's number");
    bool good = known && read_point(g.in, 8, g.scale, point);
    const bool tail = parametric || (g.version == 10 && good && g.in.word_on_line());  // version 1 does not say
    if (tail && (good || g.binary())) good = read_parameters(g);
    if (known) g.add_node(tag, at, point);
    good ? g.in.end_record() : g.in.skip_line();
  }
}

void read_plain_elements(GmshParts& g) {
  g.in.begin_record();
  const std::size_t count = g.in.count("elements", g.binary() ? 8 : kLeastElementText);
  g.in.skip_line();
  g.in.set_form(g.form);
  if (g.binary()) return packed_elements(g, count);
  for (std::size_t i = 0; i < count && g.more("elements", i, count); ++i) {
    std::int64_t number = 0, type = 0;
    const bool good = g.in.integer(number, 4, "an element's number") && g.in.integer(type, 4, "an element's type") &&
                      (g.version == 10 ? old_element(g, type) : tagged_element(g, type));
    good ? g.in.end_record() : g.in.skip_line();
  }
}

}  // namespace trocar::geometry
