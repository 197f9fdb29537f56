#include <algorithm>
#include <cstddef>

#include <trocar/tissue/elastostatic/dissection.hpp>

namespace trocar::tissue {
namespace {

constexpr int kLeafNodes = 32;       // fewer are eliminated at once
constexpr int kCuts = 6;             // places to cut that are tried
constexpr double kCutWithin = 0.12;  // of the middle, as a share of the nodes

class Dissector {
 public:
  Dissector(const Stiffness& k, std::span<const int> kept) : m_k(k), m_kept(kept), m_side(k.points.size(), 0) {
    find_neighbours();
    m_out.place.assign(k.points.size(), -1);
    m_inner.assign(k.points.size(), true);
    for (const int node : kept) m_inner[std::size_t(node)] = false;
  }
  Dissection run() {
    std::vector<int> inner;
    for (int i = 0; i < m_k.nodes(); ++i)
      if (m_inner[std::size_t(i)] && m_k.held[std::size_t(i)] != kHeld) inner.push_back(i);
    m_places = int(inner.size());
    for (std::size_t i = 0; i < m_kept.size(); ++i) m_out.place[std::size_t(m_kept[i])] = m_places + int(i);
    m_places = 0;
    Cut cut = inner.size() > kLeafNodes ? best_cut(inner) : Cut{{}, {}, inner};
    std::vector<int> children = split(cut.below);
    for (const int child : split(cut.above)) children.push_back(child);
    add_front(cut.between, children);
    m_out.fronts.back().border.assign(m_kept.begin(), m_kept.end());
    return std::move(m_out);
  }

 private:
  struct Cut {
    std::vector<int> below, above, between;
  };

  void find_neighbours() {
    std::vector<int> count(m_k.points.size() + 1, 0);
    const auto pairs = [this](auto&& see) {
      for (int row = 0; row < m_k.nodes(); ++row)
        for (int e = m_k.first[std::size_t(row)]; e + 1 < m_k.first[std::size_t(row) + 1]; ++e)
          see(row, m_k.column[std::size_t(e)]), see(m_k.column[std::size_t(e)], row);
    };
    pairs([&](int a, int) { ++count[std::size_t(a) + 1]; });
    for (std::size_t i = 1; i < count.size(); ++i) count[i] += count[i - 1];
    m_near_begin = count;
    m_near.resize(std::size_t(count.back()));
    pairs([&](int a, int b) { m_near[std::size_t(count[std::size_t(a)]++)] = b; });
  }
  std::span<const int> near(int node) const {
    const int begin = m_near_begin[std::size_t(node)], end = m_near_begin[std::size_t(node) + 1];
    return std::span(m_near).subspan(std::size_t(begin), std::size_t(end - begin));
  }

  int longest_axis(const std::vector<int>& nodes) const {
    Vec3d low = m_k.points[std::size_t(nodes[0])], high = low;
    for (const int node : nodes)
      for (int axis = 0; axis < 3; ++axis) {
        const double x = m_k.points[std::size_t(node)][axis];
        low[axis] = std::min(low[axis], x), high[axis] = std::max(high[axis], x);
      }
    const Vec3d size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  }
  /// Of some neighbouring places about the middle, where the step from node to node is largest.
  std::vector<int> places_to_cut(const std::vector<int>& sorted, int axis) const {
    const int n = int(sorted.size()), from = std::max(1, int((0.5 - kCutWithin) * n));
    const int to = std::min(n, int((0.5 + kCutWithin) * n) + 1), step = std::max(1, (to - from) / kCuts);
    std::vector<int> places;
    for (int begin = from; begin < to; begin += step) {
      int best = begin;
      double widest = -1;
      for (int i = begin; i < std::min(begin + step, to); ++i) {
        const auto x = [&](int p) { return m_k.points[std::size_t(sorted[std::size_t(p)])][axis]; };
        if (x(i) - x(i - 1) > widest) widest = x(i) - x(i - 1), best = i;
      }
      places.push_back(best);
    }
    return places;
  }
  /// Nodes of [begin, end) that have a neighbour on the other side.
  std::vector<int> facing(std::span<const int> nodes, int other) const {
    std::vector<int> out;
    for (const int node : nodes)
      for (const int b : near(node))
        if (m_side[std::size_t(b)] == other) {
          out.push_back(node);
          break;
        }
    return out;
  }
  Cut best_cut(std::vector<int> nodes) {
    const int axis = longest_axis(nodes);
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) {
      const double x = m_k.points[std::size_t(a)][axis], y = m_k.points[std::size_t(b)][axis];
      return x != y ? x < y : a < b;
    });
    std::vector<int> best;
    int best_place = 0;
    for (const int place : places_to_cut(nodes, axis)) {
      const std::span<const int> all(nodes), low = all.first(std::size_t(place)),
                                             high = all.subspan(std::size_t(place));
      for (const int node : low) m_side[std::size_t(node)] = 1;
      for (const int node : high) m_side[std::size_t(node)] = 2;
      for (const bool of_low : {true, false}) {
        std::vector<int> tried = of_low ? facing(low, 2) : facing(high, 1);
        if (best_place == 0 || tried.size() < best.size()) best = std::move(tried), best_place = place;
      }
    }
    for (const int node : best) m_side[std::size_t(node)] = 3;
    Cut cut{{}, {}, best};
    for (int i = 0; i < int(nodes.size()); ++i) {
      const int node = nodes[std::size_t(i)];
      if (m_side[std::size_t(node)] != 3) (i < best_place ? cut.below : cut.above).push_back(node);
    }
    for (const int node : nodes) m_side[std::size_t(node)] = 0;
    return cut;
  }

  /// @return the fronts that stand for these nodes towards what comes later
  std::vector<int> split(const std::vector<int>& nodes) {
    if (nodes.empty()) return {};
    if (nodes.size() <= kLeafNodes) return {add_front(nodes, {})};
    const Cut cut = best_cut(nodes);
    std::vector<int> children = split(cut.below);
    for (const int child : split(cut.above)) children.push_back(child);
    if (cut.between.empty()) return children;
    return {add_front(cut.between, std::move(children))};
  }

  int add_front(std::vector<int> own, std::vector<int> children) {
    for (const int node : own) m_out.place[std::size_t(node)] = m_places++;
    FrontNodes front{std::move(own), {}, std::move(children)};
    const int done = m_places;
    std::vector<int>& border = front.border;
    for (const int child : front.children)
      for (const int node : m_out.fronts[std::size_t(child)].border) border.push_back(node);
    for (const int node : front.own)
      for (const int b : near(node))
        if (!m_inner[std::size_t(b)] || m_k.held[std::size_t(b)] != kHeld) border.push_back(b);
    // What is eliminated later has no place yet.
    const auto gone = [&](int node) {
      const int place = m_out.place[std::size_t(node)];
      return m_inner[std::size_t(node)] && place >= 0 && place < done;
    };
    border.erase(std::remove_if(border.begin(), border.end(), gone), border.end());
    std::sort(border.begin(), border.end());
    border.erase(std::unique(border.begin(), border.end()), border.end());
    m_out.fronts.push_back(std::move(front));
    return int(m_out.fronts.size()) - 1;
  }

  const Stiffness& m_k;
  std::span<const int> m_kept;
  std::vector<int> m_near_begin, m_near;
  std::vector<std::uint8_t> m_side;
  std::vector<bool> m_inner;
  int m_places = 0;
  Dissection m_out;
};

}  // namespace

Dissection dissect(const Stiffness& k, std::span<const int> kept) {
  Dissection out = Dissector(k, kept).run();
  for (FrontNodes& front : out.fronts)
    std::sort(front.border.begin(), front.border.end(),
              [&](int a, int b) { return out.place[std::size_t(a)] < out.place[std::size_t(b)]; });
  return out;
}

}  // namespace trocar::tissue
