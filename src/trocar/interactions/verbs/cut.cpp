#include <algorithm>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr double kOpenToCut = 0.5;      // aperture from which the blades can cut again ...
constexpr double kOpenAgain = 0.9;      // ... and from which they can in a closing that was broken off
constexpr double kBladesCrossed = 0.2;  // aperture at which the blades have crossed

}  // namespace

int update_scissors(const ToolModel& model, const ToolShape& shape, int tool_index, const Bodies& bodies,
                    std::span<tissue::StrandState> strand_states, int tips_visible, std::uint64_t tick, ToolState& tool,
                    CutBook book) noexcept {
  if (tool.aperture > (tool.armed < 0 ? kOpenAgain : kOpenToCut) && tool.armed <= 0) tool.armed = 1;
  if (!tool.armed || tool.aperture > kBladesCrossed) return 0;
  tool.armed = 0;
  int made = 0;
  for (size_t s = 0; s < bodies.strand_count(); ++s) {
    const StrandBody& body = bodies.strand(s);
    tissue::StrandState& state = strand_states[s];
    const auto [element, where, fraction] = between_blades(model, shape, body, state);
    if (element < 0) continue;
    if (book.count == kMaxCuts) {  // what cannot be recorded is not cut
      if (book.refused) *book.refused = true;
      continue;
    }
    Cut& cut = book.cuts[size_t(book.count++)];
    cut = {};
    cut.strand = std::int32_t(s);
    cut.tool = tool_index;
    cut.tips_visible = tips_visible;
    cut.tick = tick;
    cut.s = arc_at(body, {element, where.w});
    cut.fraction = fraction;
    cut.beyond = std::max(0.0, model.jaw_length - where.local.z - body.model.radius[size_t(element)]);
    if (cut.fraction >= kThrough)
      tissue::cut_element(state, element);
    else
      state.scale[size_t(element)] *= 1.0 - cut.fraction;
    ++made;
  }
  return made;
}

namespace {

constexpr double kInFlesh = 0.75;  // of the widest aperture: the blades are closing

/// Representative of a node's connected part; shortens the way for the next question.
std::int32_t part_of(std::span<std::int32_t> parent, std::int32_t node) noexcept {
  while (parent[size_t(node)] != node) node = parent[size_t(node)] = parent[size_t(parent[size_t(node)])];
  return node;
}
/// Joins the parts of a and b; false where they are one already.
bool join(std::span<std::int32_t> parent, std::int32_t a, std::int32_t b) noexcept {
  const std::int32_t pa = part_of(parent, a), pb = part_of(parent, b);
  parent[size_t(std::max(pa, pb))] = std::min(pa, pb);
  return pa != pb;
}

/// Severs the springs that cross the blade, as long as all hangs together without them.
/// @param parent  which nodes are joined to begin with
int sever(const geometry::BladePlane& plane, const tissue::NetworkModel& network, tissue::NetworkState& state,
          std::span<std::int32_t> parent) noexcept {
  const auto end = [&](int s, size_t side) { return network.spring_nodes[size_t(2 * s) + side]; };
  bool any = false;
  for (int s = 0; s < network.springs; ++s) {
    if (crosses(plane, network, state, s))
      any = true;
    else if (tissue::spring_scale(network, state, s) > 0)
      join(parent, end(s, 0), end(s, 1));
  }
  int severed = 0;
  for (int s = 0; any && s < network.springs; ++s) {
    if (!crosses(plane, network, state, s) || join(parent, end(s, 0), end(s, 1))) continue;
    tissue::cut_spring(network, state, s);
    ++severed;
  }
  return severed;
}

}  // namespace

int cut_organ(const geometry::Blade& blade, const tissue::NetworkModel& network, const tissue::Skin& fine,
              tissue::NetworkState& state, std::span<std::uint8_t> parted, std::span<std::int32_t> scratch) noexcept {
  const geometry::BladePlane plane(blade);
  if (!plane.flat) return 0;
  const std::span<std::int32_t> parent = scratch.first(size_t(network.nodes));
  for (std::int32_t n = 0; n < network.nodes; ++n) parent[size_t(n)] = n;
  const int severed = sever(plane, network, state, parent);
  if (severed == 0) return 0;
  const tissue::NodeView nodes = view_of(network, state);
  for (size_t t = 0; t < fine.triangles.size(); ++t) {
    Vec3d corner[3];
    for (size_t k = 0; k < 3; ++k) corner[k] = skin_point(nodes, fine, fine.triangles[t][k]);
    for (int k = 0; k < 3; ++k)
      if (plane.crosses(corner[k], corner[(k + 1) % 3])) parted[t] = 1;
  }
  return severed;
}

std::optional<geometry::Blade> sweep_of_blades(const ToolModel& model, const ToolShape& shape,
                                               ToolState& tool) noexcept {
  if (tool.armed <= 0) return {};
  tool.armed = std::max(tool.armed, std::int16_t(1000 * tool.aperture));
  const double widest = tool.armed / 1000.0;
  if (tool.aperture > kInFlesh * widest) return {};
  tool.armed = -1;
  const double angle = 0.5 * model.opening * widest, at_hinge = 0.5 * model.parallel_gap * widest + kBesideBlades;
  return strip_of_blades(shape, at_hinge, at_hinge + model.jaw_length * portable::sin(angle) / portable::cos(angle),
                         model.jaw_length);
}

namespace {

/// A point of a fold, and how deep in the fold it lies.
struct FoldPoint {
  Vec3d at;
  double depth;
};

/// How deep the blade reaches into a triangle of the fold; 0 where it misses it. Its plane crosses the triangle in a
/// straight line; nine points of that line are asked whether the blade covers them.
double reach_into(const geometry::BladePlane& plane, const FoldPoint (&corner)[3]) noexcept {
  FoldPoint line[2];
  int ends = 0;
  for (int k = 0; k < 3 && ends < 2; ++k) {
    const FoldPoint &a = corner[k], &b = corner[(k + 1) % 3];
    const double ha = plane.height(a.at), hb = plane.height(b.at);
    if ((ha > 0) == (hb > 0)) continue;
    const double w = ha / (ha - hb);
    line[ends++] = {a.at + w * (b.at - a.at), a.depth + w * (b.depth - a.depth)};
  }
  double deepest = 0;
  constexpr int kPoints = 8;
  for (int i = 0; ends == 2 && i <= kPoints; ++i) {
    const double w = double(i) / kPoints;
    if (plane.covers(line[0].at + w * (line[1].at - line[0].at)))
      deepest = std::max(deepest, line[0].depth + w * (line[1].depth - line[0].depth));
  }
  return deepest;
}

}  // namespace

FoldCut cut_membrane(const geometry::Blade& blade, const tissue::MembraneModel& sheet, std::span<const float> depth,
                     tissue::MembraneState& state, std::span<std::uint8_t> parted,
                     std::span<std::int32_t> scratch) noexcept {
  const geometry::BladePlane plane(blade);
  FoldCut cut;
  if (!plane.flat) return cut;
  const tissue::NetworkModel& network = sheet.network;
  const std::span<std::int32_t> parent = scratch.first(size_t(network.nodes));
  for (std::int32_t n = 0; n < network.nodes; ++n) parent[size_t(n)] = n;
  for (size_t h = 1; h < sheet.held_nodes.size(); ++h) join(parent, sheet.held_nodes[0], sheet.held_nodes[h]);
  cut.severed = sever(plane, network, state.network, parent);
  if (cut.severed == 0) return cut;
  for (size_t t = 0; t < sheet.triangles.size(); ++t) {
    FoldPoint corner[3];
    for (size_t k = 0; k < 3; ++k) {
      const int node = sheet.triangles[t][k];
      corner[k] = {tissue::position(network, state.network, node), double(depth[size_t(node)])};
    }
    for (int k = 0; k < 3; ++k)
      if (plane.crosses(corner[k].at, corner[(k + 1) % 3].at)) parted[t] = 1;
    cut.depth = std::max(cut.depth, reach_into(plane, corner));
  }
  tear_bends(sheet, parted, state);
  return cut;
}

}  // namespace trocar::interactions
