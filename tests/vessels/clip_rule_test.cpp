// The clip rule, exactly: an opening has no flow if and only if a closed clip (or a cut) lies on every way from a
// source. Every connected graph of up to eight segments, cycles and all, with every source and clips in every
// combination, held to a rule of its own: reachability in the graph of pieces, by brute force.
#include <array>
#include <set>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;

/// A connected simple graph; edges (from < to).
struct Shape {
  int nodes = 1;
  std::vector<std::pair<int, int>> edges;
  bool joined(int a, int b) const {
    for (const auto& [x, y] : edges)
      if ((x == a && y == b) || (x == b && y == a)) return true;
    return false;
  }
  int degree(int a) const {
    int n = 0;
    for (const auto& [x, y] : edges) n += x == a || y == a;
    return n;
  }
};

/// Backtracking: can node `at` and all beyond it be mapped, given where the ones before went?
bool maps(const Shape& a, const Shape& b, std::array<int, 9>& to, unsigned used, int at) {
  if (at == a.nodes) return true;
  for (int j = 0; j < b.nodes; ++j) {
    if (used >> j & 1 || a.degree(at) != b.degree(j)) continue;
    bool fits = true;
    for (int i = 0; i < at && fits; ++i) fits = a.joined(at, i) == b.joined(j, to[i]);
    if (!fits) continue;
    to[at] = j;
    if (maps(a, b, to, used | 1u << j, at + 1)) return true;
  }
  return false;
}

bool isomorphic(const Shape& a, const Shape& b) {
  std::array<int, 9> to{};
  return a.nodes == b.nodes && maps(a, b, to, 0, 0);
}

/// All of n edges from all of n - 1: an edge more between two nodes, or to a new one.
std::vector<Shape> grown(const std::vector<Shape>& smaller) {
  std::vector<Shape> found;
  for (const Shape& s : smaller)
    for (int a = 0; a < s.nodes; ++a)
      for (int b = a + 1; b <= s.nodes; ++b) {
        if (s.joined(a, b)) continue;
        Shape t = s;
        t.nodes = std::max(s.nodes, b + 1);
        t.edges.emplace_back(a, b);
        bool known = false;
        for (const Shape& f : found) known = known || isomorphic(f, t);
        if (!known) found.push_back(t);
      }
  return found;
}

/// All with 0 .. 8 edges.
const std::vector<std::vector<Shape>>& shapes() {
  static const std::vector<std::vector<Shape>> all = [] {
    std::vector<std::vector<Shape>> v{{Shape{}}};
    while (v.size() < 9) v.push_back(grown(v.back()));
    return v;
  }();
  return all;
}

constexpr unsigned kNear = 1, kFar = 2;  // clips of a segment: before its opening, behind it

/// Every segment has an opening at its middle: does a way lead to it (0: from `from`'s side, 1: from `to`'s)?
/// Warshall on nodes and two sides of every middle, which are one place where it is not cut through.
std::vector<std::array<bool, 2>> reached(const Shape& s, const std::vector<int>& sources,
                                         const std::vector<unsigned>& clips, int cut) {
  const int n = s.nodes + 2 * int(s.edges.size());
  std::vector<std::uint32_t> next(static_cast<std::size_t>(n), 0);
  const auto join = [&](int a, int b) { next[a] |= 1u << b, next[b] |= 1u << a; };
  for (int i = 0; i < int(s.edges.size()); ++i) {
    const int left = s.nodes + 2 * i, right = left + 1;
    if (!(clips[i] & kNear)) join(s.edges[i].first, left);
    if (!(clips[i] & kFar)) join(right, s.edges[i].second);
    if (i != cut) join(left, right);
  }
  std::uint32_t seen = 0;
  for (const int source : sources) seen |= 1u << source;
  for (std::uint32_t before = 0; before != seen;) {
    before = seen;
    for (int i = 0; i < n; ++i)
      if (seen >> i & 1) seen |= next[i];
  }
  std::vector<std::array<bool, 2>> result(s.edges.size());
  for (int i = 0; i < int(s.edges.size()); ++i)
    for (int side = 0; side < 2; ++side) result[i][side] = seen >> (s.nodes + 2 * i + side) & 1;
  return result;
}

struct Case {
  const Shape* shape;
  std::vector<int> sources;
  FlowModel model;
  FlowState start;
  FlowWork work;
  std::vector<Opening> openings;
  std::vector<Occlusion> clips;
  std::vector<OpeningFlow> flows;
  std::vector<unsigned> state;  // of each segment

  Case(const Shape& s, std::vector<int> from) : shape(&s), sources(std::move(from)) {
    VesselGraph g;
    g.nodes = s.nodes;
    for (const auto& [a, b] : s.edges) g.segments.push_back(artery(a, b, 0.01, 1.5e-3, 1e6, 0.15e-3));
    for (const int source : sources) g.sources.push_back(constant_pressure(source, 93 * kMmHg));
    g.settings.drain_time = 0;
    g.settings.max_openings = int(s.edges.size()), g.settings.max_clips = 2 * int(s.edges.size());
    model = build(g);
    start = rest_state(model);
    work = make_work(model);
    openings.resize(s.edges.size()), flows.resize(s.edges.size()), clips.resize(2 * s.edges.size());
    state.resize(s.edges.size());
  }

  /// Compares two ticks with the rule; returns how many openings had no flow, or -1.
  int agrees(int cut) {
    for (int i = 0; i < int(openings.size()); ++i) {
      openings[i] = {.segment = i, .s = 0.5, .area = 1e-6, .outside = 12 * kMmHg};
      if (i == cut) openings[i].kind = Opening::Kind::cut;
      clips[2 * i] = {.segment = state[i] & kNear ? i : -1, .s = 0.25, .cover = 1};
      clips[2 * i + 1] = {.segment = state[i] & kFar ? i : -1, .s = 0.75, .cover = 0.98};
    }
    const auto expected = reached(*shape, sources, state, cut);
    FlowState s = start;
    int dry = 0;
    for (int tick = 0; tick < 2; ++tick) {
      if (!advance(model, {.openings = openings, .clips = clips}, flows, s, work).fine()) return -1;
      for (int i = 0; i < int(openings.size()); ++i)
        for (int side = 0; side < (i == cut ? 2 : 1); ++side) {
          const bool way = i == cut ? expected[i][side] : expected[i][0] || expected[i][1];
          const bool flows_now = flows[i].flow[side] > 0 && flows[i].picolitres[side] > 0;
          const bool none = flows[i].flow[side] == 0 && flows[i].picolitres[side] == 0;
          if (way ? !flows_now : !none) return -1;
          dry += !way;
        }
    }
    return dry;
  }
};

/// Runs `body` over all assignments of `choices` to the segments of a case.
template <class F>
void for_all_states(Case& c, const std::vector<unsigned>& choices, F&& body) {
  std::vector<std::size_t> digit(c.state.size(), 0);
  for (;;) {
    for (std::size_t i = 0; i < digit.size(); ++i) c.state[i] = choices[digit[i]];
    body();
    std::size_t i = 0;
    while (i < digit.size() && ++digit[i] == choices.size()) digit[i++] = 0;
    if (i == digit.size()) return;
  }
}

struct Tally {
  long cases = 0, dry = 0;
  void add(int result) { ++cases, dry += result; }
  void tell(const char* what) const {
    record(what, "%.0f cases, %.0f openings without flow", double(cases), double(dry));
    EXPECT_GT(dry, cases / 10) << "the rule was hardly put to the test";
  }
};

TEST(ClipRule, AllConnectedGraphsOfUpToEightSegmentsAreHere) {
  const std::size_t known[] = {1, 1, 1, 3, 5, 12, 30, 79, 227};  // OEIS A002905
  for (int n = 0; n <= 8; ++n) EXPECT_EQ(shapes()[n].size(), known[n]) << n;
}

TEST(ClipRule, HoldsOnEveryGraphOfUpToEightSegmentsWithEverySource) {
  Tally tally;
  for (int n = 1; n <= 8; ++n)
    for (const Shape& shape : shapes()[n])
      for (int source = 0; source < shape.nodes; ++source) {
        Case c(shape, {source});
        // Up to five segments: no clip, one on either side, or both; beyond: one, now on this side, now on that.
        const std::vector<unsigned> choices = n <= 5 ? std::vector<unsigned>{0, kNear, kFar, kNear | kFar}
                                                     : std::vector<unsigned>{0, (source + n) % 2 ? kNear : kFar};
        for_all_states(c, choices, [&] {
          const int result = c.agrees(-1);
          ASSERT_GE(result, 0) << n << " segments, source " << source;
          tally.add(result);
        });
        if (testing::Test::HasFatalFailure()) return;
      }
  tally.tell("row 20, one source, a hole in every segment");
}

TEST(ClipRule, HoldsWithTwoSources) {
  Tally tally;
  for (int n = 2; n <= 6; ++n)
    for (const Shape& shape : shapes()[n])
      for (int a = 0; a < shape.nodes; ++a)
        for (int b = a + 1; b < shape.nodes; ++b) {
          Case c(shape, {a, b});
          for_all_states(c, {0, (a + b) % 2 ? kNear : kFar}, [&] {
            const int result = c.agrees(-1);
            ASSERT_GE(result, 0) << n << " segments, sources " << a << " " << b;
            tally.add(result);
          });
          if (testing::Test::HasFatalFailure()) return;
        }
  tally.tell("row 20, two sources");
}

TEST(ClipRule, HoldsForBothStumpsOfEverySegmentCutThrough) {
  Tally tally;
  for (int n = 1; n <= 6; ++n)
    for (const Shape& shape : shapes()[n])
      for (int source = 0; source < shape.nodes; ++source) {
        Case c(shape, {source});
        for (int cut = 0; cut < n; ++cut)
          for_all_states(c, n <= 4 ? std::vector<unsigned>{0, kNear, kFar} : std::vector<unsigned>{0, kNear}, [&] {
            const int result = c.agrees(cut);
            ASSERT_GE(result, 0) << n << " segments, source " << source << ", cut " << cut;
            tally.add(result);
          });
        if (testing::Test::HasFatalFailure()) return;
      }
  tally.tell("row 20, one segment cut through");
}

TEST(ClipRule, ClipDownstreamLeavesTheFlow) {
  VesselGraph g;
  g.nodes = 2;
  g.segments = {artery(0, 1, 0.1, 1.5e-3, 1e6, 0.15e-3)};
  g.sources = {constant_pressure(0, 93 * kMmHg)};
  Simulation sim(g);
  sim.openings = {{.segment = 0, .s = 0.5, .area = 1e-6, .outside = 12 * kMmHg}};
  sim.run(0.5);
  const double free = sim.flows[0].flow[0];
  sim.clips = {{.segment = 0, .s = 0.6, .cover = 1}};
  sim.run(0.5);
  EXPECT_NEAR(sim.flows[0].flow[0], free, 1e-3 * free);
  sim.clips = {{.segment = 0, .s = 0.4, .cover = 1}};
  sim.run(0.5);
  EXPECT_EQ(sim.flows[0].flow[0], 0);
  sim.clips = {{.segment = 0, .s = 0.4, .cover = 0.97}};
  sim.run(3);
  EXPECT_GT(sim.flows[0].flow[0], 0) << "not quite closed";
  sim.clips.clear();
  sim.run(0.5);
  EXPECT_NEAR(sim.flows[0].flow[0], free, 1e-3 * free) << "taken off again";
}

}  // namespace
}  // namespace trocar::vessels
