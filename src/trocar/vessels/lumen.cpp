#include <algorithm>
#include <cassert>
#include <cstddef>

#include <trocar/vessels/connected.hpp>
#include <trocar/vessels/lumen.hpp>

namespace trocar::vessels {
namespace {

bool names(std::int32_t index, std::size_t count) { return index >= 0 && std::size_t(index) < count; }

/// blocked[i] = 1 where nothing passes segment i.
void mark_blocked(const LumenGraph& graph, std::span<std::int32_t> blocked) {
  std::fill(blocked.begin(), blocked.end(), 0);
  for (const LumenClosure& clip : graph.closures)
    if (names(clip.segment, blocked.size()) && clip.cover >= graph.closing_cover) blocked[clip.segment] = 1;
  for (const std::int32_t cut : graph.cuts)
    if (names(cut, blocked.size())) blocked[cut] = 1;
}

}  // namespace

std::size_t lumen_scratch_size(const LumenGraph& graph) noexcept {
  return std::size_t(std::max(graph.nodes, 0)) + graph.segments.size();
}

bool open_path(const LumenGraph& graph, std::int32_t from, std::int32_t to, std::span<std::int32_t> scratch) noexcept {
  const std::size_t nodes = std::size_t(std::max(graph.nodes, 0));
  if (!names(from, nodes) || !names(to, nodes)) return false;
  assert(scratch.size() >= lumen_scratch_size(graph));
  const auto parent = scratch.first(nodes), blocked = scratch.subspan(nodes, graph.segments.size());
  mark_blocked(graph, blocked);
  for (std::size_t i = 0; i < nodes; ++i) parent[i] = std::int32_t(i);
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    const LumenSegment& segment = graph.segments[i];
    if (blocked[i] || !names(segment.a, nodes) || !names(segment.b, nodes)) continue;
    const std::int32_t a = root(parent, segment.a), b = root(parent, segment.b);
    parent[std::max(a, b)] = std::min(a, b);
  }
  return root(parent, from) == root(parent, to);
}

}  // namespace trocar::vessels
