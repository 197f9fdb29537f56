// An organ that can be cut anywhere, in a scene: what one closing of the scissors does to it, and to what is drawn.
#include <gtest/gtest.h>

#include <trocar/sim/recording/keyframe.hpp>

#include "session.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

const tissue::CuttableModel& bar() { return small::model().cuttables[0].body; }

/// Of the work that session.hpp records: its end, and where the bar was cut.
struct Story {
  State hanging, before, after, end;  ///< untouched; around the tick of the cut; when all is done
  std::vector<Event> cuts;
};

const Story& story() {
  static const Story told = [] {
    Story r;
    const laws::Session& work = laws::session();
    Work w = make_work(small::model());
    r.hanging = work.states[4400 / laws::kMark - 1];
    r.end = work.states.back();
    for (const std::uint64_t cut : work.cut) {  // again from the mark before it
      r.after = work.states[(cut - 1) / laws::kMark - 1];
      while (r.after.tick < cut) {
        r.before = r.after;
        const StepReport report = step(small::model(), work.inputs[r.after.tick], r.after, w);
        for (int e = 0; e < report.event_count; ++e)
          if (report.events[e].kind == Event::cut) r.cuts.push_back(report.events[e]);
      }
    }
    return r;
  }();
  return told;
}

/// Numbers of the pieces that hang together by faces, by cell.
std::vector<int> pieces(const geometry::CuttableTets& b) {
  std::vector<int> piece(b.cells.size(), -1);
  int pieces = 0;
  for (size_t first = 0; first < b.cells.size(); ++first) {
    if (piece[first] >= 0) continue;
    std::vector<int> todo{int(first)};
    piece[first] = pieces;
    while (!todo.empty()) {
      const int t = todo.back();
      todo.pop_back();
      for (const int u : b.across[size_t(t)])
        if (u >= 0 && piece[size_t(u)] < 0) piece[size_t(u)] = pieces, todo.push_back(u);
    }
    ++pieces;
  }
  return piece;
}

double height(const State& s, int piece) {
  const geometry::CuttableTets& b = s.cuttables[0].tets;
  const std::vector<int> of = pieces(b);
  double sum = 0;
  int n = 0;
  for (size_t t = 0; t < b.cells.size(); ++t)
    for (int k = 0; k < 4 && of[t] == piece; ++k, ++n)
      sum += tissue::position(bar(), s.cuttables[0], b.cells[t][size_t(k)]).z;
  return sum / n;
}

TEST(CuttableOrgan, HangsAsDrawn) {
  const State& s = story().hanging;
  double off = 0;
  for (int n = 0; n < bar().own_nodes; ++n)
    off = std::max(off, length(tissue::position(bar(), s.cuttables[0], n) - bar().drawn.rest[size_t(n)]));
  std::printf("farthest node from where it was drawn after 4.4 s: %.4f mm\n", off * 1e3);
  EXPECT_LT(off, 1e-4);
  EXPECT_EQ(s.cuttables[0].version, 0u);
}

TEST(CuttableOrgan, BladesThatCloseAroundABarPartItInTwo) {
  const Story& s = story();
  ASSERT_EQ(s.cuts.size(), 2u) << "the tube and the bar";
  const interactions::Cut& cut = s.after.cuts[size_t(s.cuts[1].record)];
  EXPECT_EQ(cut.solid, small::kBar);
  EXPECT_EQ(cut.strand, -1);
  EXPECT_NE(s.after.cuttables[0].version, 0u);
  const std::vector<int> of = pieces(s.after.cuttables[0].tets);
  EXPECT_EQ(*std::max_element(of.begin(), of.end()), 1) << "two pieces";
}

TEST(CuttableOrgan, TheFreedPieceFallsAndTheOtherStays) {
  const Story& s = story();
  const std::vector<int> of = pieces(s.after.cuttables[0].tets);
  const auto held = [&](int piece) {
    for (size_t t = 0; t < of.size(); ++t)
      for (const int node : s.after.cuttables[0].tets.cells[t])
        if (of[t] == piece && node < bar().own_nodes && bar().fixed[size_t(node)]) return true;
    return false;
  };
  ASSERT_NE(held(0), held(1));
  const int stays = held(0) ? 0 : 1;
  EXPECT_NEAR(height(s.end, stays), height(s.before, 0), 0.002);
  EXPECT_LT(height(s.end, 1 - stays), height(s.after, 1 - stays) - 0.005);
}

TEST(CuttableOrgan, ScratchMadeAfterTheCutGivesTheSameBits) {
  const Model& m = small::model();
  State one = story().before, other = one;
  Work w = make_work(m), fresh = make_work(m);
  Input input = m.start;
  for (size_t t = 0; t < m.hands.size(); ++t) {
    const interactions::ToolState& tool = one.tools[t];
    input.tools[t] = tool_input(tool.pose(), 1);
    input.tools[t].instrument = tool.instrument;
  }
  for (int i = 0; i < 200; ++i) step(m, input, one, w);
  ASSERT_NE(one.cuttables[0].version, 0u);
  State copy = one;
  for (int i = 0; i < 300; ++i) {
    step(m, input, one, w);
    step(m, input, copy, fresh);
  }
  EXPECT_EQ(hash_of(one), hash_of(copy));
  for (int i = 0; i < 500; ++i) step(m, input, other, fresh);  // scratch of another cut body
  EXPECT_EQ(hash_of(one), hash_of(other));
}

TEST(CuttableOrgan, AKeyframeShowsTheCut) {
  const Model& m = small::model();
  const State& from = story().end;
  State to = initial_state(m);
  ASSERT_TRUE(restore_display(m, display_bytes(m, from), to));
  const geometry::CuttableTets &a = from.cuttables[0].tets, &b = to.cuttables[0].tets;
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.across, b.across);
  EXPECT_EQ(from.cuttables[0].version, to.cuttables[0].version);
  for (int n = 0; n < a.nodes; ++n)
    EXPECT_LT(length(tissue::position(bar(), from.cuttables[0], n) - tissue::position(bar(), to.cuttables[0], n)),
              1e-5);
}

TEST(CuttableOrgan, AKeyframeWithCellsThatCannotBeIsRefused) {
  const Model& m = small::model();
  const auto restores = [&m](void (*spoil)(geometry::CuttableTets&)) {
    State from = story().end, to = initial_state(m);
    spoil(from.cuttables[0].tets);
    return restore_display(m, display_bytes(m, from), to);
  };
  EXPECT_TRUE(restores([](geometry::CuttableTets&) {}));
  EXPECT_FALSE(restores([](geometry::CuttableTets& b) { b.cells[5] = {0, 0, 0, 0}; })) << "no volume";
  EXPECT_FALSE(restores([](geometry::CuttableTets& b) { std::swap(b.cells[5][0], b.cells[5][1]); })) << "inverted";
  EXPECT_FALSE(restores([](geometry::CuttableTets& b) { b.cells[5][0] = b.nodes; })) << "no such node";
  EXPECT_FALSE(restores([](geometry::CuttableTets& b) {
    for (std::int32_t& u : b.across[5])
      if (u >= 0) u = u == 7 ? 8 : 7;
  })) << "neighbours that do not know each other";
}

TEST(CuttableOrgan, ItsSkinFollowsTheCutAndStaysClosed) {
  const State& s = story().end;
  tissue::CuttableSkin skin = tissue::make_skin(bar());
  const size_t before = skin.skin.triangles.size();
  tissue::update(bar(), s.cuttables[0], skin);
  EXPECT_GT(skin.skin.triangles.size(), before);
  std::vector<std::array<int, 2>> edges;
  for (const auto& t : skin.skin.triangles)
    for (size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  for (const auto& e : edges) {
    const auto there = std::equal_range(edges.begin(), edges.end(), e);
    const auto back = std::equal_range(edges.begin(), edges.end(), std::array<int, 2>{e[1], e[0]});
    EXPECT_EQ(there.second - there.first, back.second - back.first) << e[0] << " " << e[1];
  }
}

}  // namespace
