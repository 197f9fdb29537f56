#include <array>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/vessels/lumen.hpp>

using namespace trocar::vessels;

namespace {

enum class Pass { open, half_clipped, clipped, cut };

/// A graph with its arrays.
struct Lumen {
  std::int32_t nodes = 0;
  std::vector<LumenSegment> segments;
  std::vector<LumenClosure> closures;
  std::vector<std::int32_t> cuts;
  std::vector<std::int32_t> scratch = std::vector<std::int32_t>(64);

  LumenGraph graph() const { return {nodes, segments, closures, cuts, 0.98f}; }
  void set(std::int32_t segment, Pass pass) {
    if (pass == Pass::half_clipped) closures.push_back({segment, 0.97f});
    if (pass == Pass::clipped) closures.push_back({segment, 0.98f});
    if (pass == Pass::cut) cuts.push_back(segment);
  }
  bool open(std::int32_t from, std::int32_t to) { return open_path(graph(), from, to, scratch); }
};

/// n segments in a row: the tube.
Lumen tube(std::int32_t n) {
  Lumen lumen;
  lumen.nodes = n + 1;
  for (std::int32_t i = 0; i < n; ++i) lumen.segments.push_back({i, i + 1});
  return lumen;
}

/// By hand: reach[i][j] from the segments that let pass, closed under "and then" (Warshall).
using Reach = std::array<std::array<bool, 9>, 9>;
Reach reach(const std::vector<LumenSegment>& segments, const std::vector<Pass>& pass) {
  Reach r{};
  for (int i = 0; i < 9; ++i) r[i][i] = true;
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (pass[i] == Pass::open || pass[i] == Pass::half_clipped)
      r[segments[i].a][segments[i].b] = r[segments[i].b][segments[i].a] = true;
  for (int k = 0; k < 9; ++k)
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j) r[i][j] = r[i][j] || (r[i][k] && r[k][j]);
  return r;
}

/// Compares every pair of nodes; returns how many agree, or fails.
int agreeing_pairs(const std::vector<LumenSegment>& segments, const std::vector<Pass>& pass, std::int32_t nodes) {
  Lumen lumen;
  lumen.nodes = nodes;
  lumen.segments = segments;
  for (std::size_t i = 0; i < segments.size(); ++i) lumen.set(std::int32_t(i), pass[i]);
  const Reach expected = reach(segments, pass);
  int agree = 0;
  for (std::int32_t i = 0; i < nodes; ++i)
    for (std::int32_t j = 0; j < nodes; ++j) agree += lumen.open(i, j) == expected[i][j];
  return agree;
}

/// A rooted tree's shape, whatever the order of its children.
std::string shape(const std::vector<int>& parent, int node) {
  std::multiset<std::string> children;
  for (std::size_t i = 1; i < parent.size(); ++i)
    if (parent[i] == node) children.insert(shape(parent, int(i)));
  std::string text = "(";
  for (const std::string& child : children) text += child;
  return text + ')';
}

/// Every rooted tree of `nodes` nodes, once each: parent[i] < i.
std::vector<std::vector<int>> trees(int nodes) {
  std::vector<std::vector<int>> result;
  std::set<std::string> seen;
  std::vector<int> parent(nodes, -1);
  const std::function<void(int)> grow = [&](int at) {
    if (at == nodes) {
      if (seen.insert(shape(parent, 0)).second) result.push_back(parent);
      return;
    }
    for (parent[at] = 0; parent[at] < at; ++parent[at]) grow(at + 1);
  };
  grow(1);
  return result;
}

/// All combinations of `choices` over `count` segments.
template <class F>
void for_all_states(int count, const std::vector<Pass>& choices, F&& body) {
  std::vector<Pass> pass(count);
  std::vector<std::size_t> digit(count, 0);
  for (;;) {
    for (int i = 0; i < count; ++i) pass[i] = choices[digit[i]];
    body(pass);
    int i = 0;
    while (i < count && ++digit[i] == choices.size()) digit[i++] = 0;
    if (i == count) return;
  }
}

}  // namespace

TEST(Lumen, AnUntouchedTubeIsOpenFromEndToEnd) {
  Lumen lumen = tube(10);
  EXPECT_TRUE(lumen.open(0, 10));
  EXPECT_TRUE(lumen.open(10, 0));
}

TEST(Lumen, AClosedClipOcclusesTheTubeAndAHalfClosedOneDoesNot) {
  Lumen lumen = tube(10);
  lumen.set(4, Pass::half_clipped);
  EXPECT_TRUE(lumen.open(0, 10));
  lumen.set(4, Pass::clipped);
  EXPECT_FALSE(lumen.open(0, 10));
  EXPECT_TRUE(lumen.open(0, 4));
  EXPECT_TRUE(lumen.open(5, 10));
}

TEST(Lumen, ACutPartsIt) {
  Lumen lumen = tube(3);
  lumen.set(1, Pass::cut);
  EXPECT_FALSE(lumen.open(0, 3));
}

TEST(Lumen, ACoverThatIsNoNumberDoesNotClose) {
  Lumen lumen = tube(3);
  lumen.closures.push_back({1, std::numeric_limits<float>::quiet_NaN()});
  EXPECT_TRUE(lumen.open(0, 3));
}

TEST(Lumen, IndicesThatNameNothingHaveNoEffect) {
  Lumen lumen = tube(3);
  lumen.segments.push_back({-1, 2});
  lumen.segments.push_back({0, 99});
  lumen.closures = {{-1, 1.0f}, {17, 1.0f}};
  lumen.cuts = {-5, 99};
  EXPECT_TRUE(lumen.open(0, 3));
  EXPECT_FALSE(lumen.open(0, 4));
  EXPECT_FALSE(lumen.open(-1, 0));
}

TEST(Lumen, EveryTreeOfUpToEightSegmentsInEveryStateAgreesWithBruteForce) {
  const std::size_t rooted_trees[] = {1, 1, 2, 4, 9, 20, 48, 115, 286};  // of 1 .. 9 nodes (OEIS A000081)
  for (int nodes = 1; nodes <= 9; ++nodes) {
    const auto all = trees(nodes);
    ASSERT_EQ(all.size(), rooted_trees[nodes - 1]);
    for (const std::vector<int>& parent : all) {
      std::vector<LumenSegment> segments;
      for (int i = 1; i < nodes; ++i) segments.push_back({parent[i], i});
      // Every segment open or not; how it is not (clip or cut), and half-closed clips, alternate along the tree.
      for_all_states(nodes - 1, {Pass::open, Pass::clipped}, [&](std::vector<Pass> pass) {
        for (std::size_t i = 0; i < pass.size(); i += 2)
          pass[i] = pass[i] == Pass::open ? Pass::half_clipped : Pass::cut;
        ASSERT_EQ(agreeing_pairs(segments, pass, nodes), nodes * nodes);
      });
    }
  }
}

TEST(Lumen, EverySmallTreeInEveryKindOfStateAgreesWithBruteForce) {
  for (int nodes = 2; nodes <= 6; ++nodes)
    for (const std::vector<int>& parent : trees(nodes)) {
      std::vector<LumenSegment> segments;
      for (int i = 1; i < nodes; ++i) segments.push_back({i, parent[i]});
      for_all_states(
          nodes - 1, {Pass::open, Pass::half_clipped, Pass::clipped, Pass::cut},
          [&](const std::vector<Pass>& pass) { ASSERT_EQ(agreeing_pairs(segments, pass, nodes), nodes * nodes); });
    }
}

TEST(Lumen, EveryGraphOfFiveNodesWithItsAnastomosesAgreesWithBruteForce) {
  std::vector<LumenSegment> edges;
  for (std::int32_t i = 0; i < 5; ++i)
    for (std::int32_t j = 0; j < i; ++j) edges.push_back({i, j});
  for (unsigned there = 0; there < 1u << edges.size(); ++there) {
    std::vector<LumenSegment> segments;
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (there >> i & 1) segments.push_back(edges[i]);
    for_all_states(int(segments.size()), {Pass::open, Pass::clipped},
                   [&](const std::vector<Pass>& pass) { ASSERT_EQ(agreeing_pairs(segments, pass, 5), 25); });
  }
}
