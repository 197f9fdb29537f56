// Whether the inside of a tube, a duct or a vessel tree still leads from one place to another: lumen segments between
// nodes, closed by clips that enclose the whole of it and parted by cuts. That nothing passes a closed clip follows
// from connectivity, not from a small number.
//
//   std::vector<std::int32_t> scratch(lumen_scratch_size(graph));  // once; the question itself allocates nothing
//   const bool fertile = open_path(graph, ostium, fimbria, scratch);
//
// A clip that leaves a part of the lumen open does not close it: below `closing_cover` the path stays open.
#pragma once

#include <cstdint>
#include <span>

namespace trocar::vessels {

/// A piece of lumen between two nodes; both directions alike.
struct LumenSegment {
  std::int32_t a = 0, b = 0;
};

/// A clip around a segment. `cover`: the enclosed share of the lumen's width, 0 .. 1.
struct LumenClosure {
  std::int32_t segment = 0;
  float cover = 0;
};

/// Views of arrays that the caller keeps. An index that names nothing (no such node or segment) has no effect.
struct LumenGraph {
  std::int32_t nodes = 0;
  std::span<const LumenSegment> segments;
  std::span<const LumenClosure> closures;
  std::span<const std::int32_t> cuts;  ///< segments whose lumen is parted
  float closing_cover = 0.98f;         ///< a clip of at least this cover closes.  Our choice
};

/// Numbers that open_path() needs to work in.
std::size_t lumen_scratch_size(const LumenGraph& graph) noexcept;

/// True when a path of open segments leads from node `from` to node `to`; a node leads to itself. False for a node
/// that is not there.  @param scratch at least lumen_scratch_size(graph) numbers, contents before and after of no use
bool open_path(const LumenGraph& graph, std::int32_t from, std::int32_t to, std::span<std::int32_t> scratch) noexcept;

}  // namespace trocar::vessels
