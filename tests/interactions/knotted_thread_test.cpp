// A thread between two hands is pulled apart: with a knot at its knot pull strength, straight at its breaking force.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_stitch.hpp>
#include <trocar/suture/thread/paths.hpp>

#include "few_bodies.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

constexpr double kLength = 0.15, kTick = 0.001;  // [m], [s]

SutureModels one_thread(const std::vector<Vec3d>& path) {
  SutureModels models;
  SutureModel m;
  m.name = "thread";
  m.thread = suture::build({.stuff = suture::find_thread("3-0", "PDS")->stuff,
                            .length = kLength,
                            .gravity = {0, 0, 0},
                            .most_solves = 32,
                            .holds = kFirstHandSlot + 2,
                            .obstacles = 2 * kRodSlots + kNeedlePieces});
  m.path = path;
  models.list.push_back(std::move(m));
  return models;
}

/// Both hands hold an end and draw it outwards until the thread parts.
struct PulledApart {
  double pull = 0;  ///< the most that it bore [N]
  int broken = 0;   ///< reports of that
  bool in_knot = false;
};
PulledApart pull_apart(const std::vector<Vec3d>& path) {
  const SutureModels models = one_thread(path);
  Suture::States states = Suture::start(models);
  SutureWorks work = Suture::make_work(models, 2);
  test::FewBodies none;
  const tissue::Box cavity{{-1, -1, -1}, {1, 1, 1}};
  suture::ThreadState& thread = states[0].thread;
  const double ends[2] = {0, kLength};
  Vec3d held[2] = {thread.x.front(), thread.x.back()};
  PulledApart r;
  for (int k = 0; k < 12000 && r.broken == 0; ++k) {
    Suture::clear(work);
    for (size_t h = 0; h < 2; ++h) {
      held[h].x += h == 0 ? 2e-5 : -2e-5;  // the thread lies along -x, as knots are laid
      SuturePinch& p = work.pinches[h];
      p.count = 1;
      p.suture = 0;
      p.s = ends[h];
      p.target = held[h];
      p.bears = 1000;
    }
    const std::vector<std::uint8_t> whole = thread.alive;
    const SewnReport report = sew(models, none.all(), {0, 0, 0}, kTick, cavity, states, work);
    r.broken += report.broken_count;
    r.pull = std::max(r.pull, states[0].strain);
    if (report.broken_count == 0) continue;
    EXPECT_EQ(report.broken[0].suture, BodyId(BodyKind::suture, 0));
    EXPECT_EQ(report.broken[0].crushed_by, -1) << "no instrument presses on it";
    const auto cut = std::mismatch(whole.begin(), whole.end(), thread.alive.begin()).first - whole.begin();
    for (int i = 0; i < models.list[0].thread.nodes; ++i) {
      const double along = std::abs(i - double(cut)) * models.list[0].thread.spacing;
      const double beside = length(thread.x[size_t(i)] - thread.x[size_t(cut)]);
      const double thick = models.list[0].thread.stuff.diameter;
      r.in_knot = r.in_knot || (along > 5 * thick && beside < 2 * thick);
    }
  }
  return r;
}

}  // namespace

TEST(KnottedThread, PartsInItsKnotAtItsKnotPullStrength) {  // [knot pull]
  const suture::ThreadStuff stuff = suture::find_thread("3-0", "PDS")->stuff;
  const PulledApart r = pull_apart(suture::laid_overhand(1, kLength, 0.012, stuff.diameter));
  EXPECT_EQ(r.broken, 1);
  EXPECT_NEAR(r.pull, stuff.knotted_break_force, 0.1 * stuff.knotted_break_force);
  EXPECT_TRUE(r.in_knot);
}

TEST(KnottedThread, WithoutAKnotItPartsAtItsBreakingForce) {  // [knot pull]
  const suture::ThreadStuff stuff = suture::find_thread("3-0", "PDS")->stuff;
  const PulledApart r = pull_apart({{kLength, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(r.broken, 1);
  EXPECT_NEAR(r.pull, stuff.break_force, 0.1 * stuff.break_force);
  EXPECT_FALSE(r.in_knot);
}
