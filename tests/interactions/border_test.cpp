// Borders of a membrane on what carries them: the nodes follow, the holders feel, nothing runs away.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/couplings/border.hpp>

#include "few_bodies.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

using core::kTick;

/// A free strand along x with a sheet that hangs from it; the sheet's other border is free.
struct Hanging {
  test::FewBodies few;
  MembraneBody& membrane = few.models.membranes.emplace_back();
  tissue::MembraneModel& sheet = membrane.sheet;
  std::vector<Attachment>& holds = membrane.holds;
  tissue::MembraneState& state = few.states.membranes.emplace_back();
  tissue::MembraneWork& work = few.work.membranes.emplace_back().body;
  std::vector<tissue::BorderPull> pulls;
  std::vector<Vec3d> targets;
  Vec3d force{0, 0, 0};   ///< on every node of the strand [N]
  Vec3d astray{0, 0, 0};  ///< impulse that the borders' added inertia took [N s]

  explicit Hanging(double modulus = 20e3, bool held = false, double radius = 0.0015) {
    tissue::StrandDescription s;
    for (int i = 0; i <= 16; ++i) s.positions.push_back({0.0025 * i, 0, 0});
    s.radius.assign(16, radius);
    s.youngs_modulus = 60e3;
    s.density = 1050;
    s.damping_time = 0.004;
    s.prestress = false;
    if (held) {
      s.prescribed.assign(17, 0);
      s.prescribed.front() = s.prescribed.back() = 1;
    }
    StrandBody rod;
    rod.model = build(s, kTick);
    for (int i = 0; i <= 16; ++i) rod.arc.push_back(0.0025 * i);
    few.add(rod);
    tissue::MembraneDescription d;
    d.columns = 15;
    d.rows = 6;
    for (int r = 0; r < d.rows; ++r)
      for (int c = 0; c < d.columns; ++c) d.positions.push_back({0.002 + 0.0025 * c, 0, -0.0025 * r});
    d.held.assign(d.positions.size(), 0);
    for (int c = 0; c < d.columns; ++c) d.held[size_t(c)] = 1;
    d.thickness = 0.0005;
    d.youngs_modulus = modulus;
    d.density = 1000;
    d.damping_time = 4e-4 * 20e3 / modulus;
    d.bending_damping_time = d.damping_time;
    sheet = build(d, kTick);
    state = rest_state(sheet);
    work = make_work(sheet);
    for (int node : sheet.held_nodes) {
      const StrandPlace at = place_at(body(), 0.002 + 0.0025 * node);
      holds.push_back({at_element(few.all(), 0, at.element, at.w, {})});
    }
    pulls.resize(holds.size());
    targets.resize(holds.size());
  }
  const StrandBody& body() const { return few.models.strand_bodies[0]; }
  tissue::StrandState& strand() { return few.states.strands[0]; }
  const tissue::StrandState& strand() const { return few.states.strands[0]; }
  StrandLoads& loads() { return few.work.strands[0].loads; }
  bool step() {
    loads().clear();
    border_pulls(sheet, state, work, pulls);
    border_loads(few.all(), 0, pulls, kTick);
    for (int i = 0; i < body().nodes(); ++i) {
      tissue::StrandLoad load;
      load.element = std::min(i, body().nodes() - 2);
      load.w = i - load.element;
      load.f0 = force;
      loads().add(load, {});
    }
    loads().reaction.assign(loads().list.size(), Vec3d{});
    const std::vector<Vec3d> before = strand().v;
    const bool strand_fine =
        advance(body().model, {}, loads().list, {}, loads().reaction, strand(), few.work.strands[0].body).fine();
    for (size_t h = 0; h < holds.size(); ++h) {
      const size_t e = size_t(holds[h].point.element);
      const auto at = [&](const std::vector<Vec3d>& v) {
        return v[e] + double(holds[h].point.weight[0]) * (v[e + 1] - v[e]);
      };
      astray += kTick * added_damping(pulls[h], kTick) * (at(strand().v) - at(before));
    }
    for (size_t h = 0; h < holds.size(); ++h) targets[h] = place_of(few.all(), holds[h].point);
    return advance(sheet, targets, {}, {}, state, work).fine() && strand_fine;
  }
  /// Of strand and sheet; held nodes have no mass of their own in the sheet's motion.
  Vec3d momentum() const {
    Vec3d p{0, 0, 0};
    for (int i = 0; i < body().nodes(); ++i) p += body().model.mass[size_t(i)] * strand().v[size_t(i)];
    for (int i = 0; i < sheet.nodes(); ++i)
      if (sheet.network.fixed[size_t(i)] != tissue::kHeld)
        p += sheet.network.mass[size_t(i)] * velocity(sheet.network, state.network, i);
    return p;
  }
  double kinetic() const {
    double e = 0;
    for (int i = 0; i < body().nodes(); ++i)
      e += 0.5 * body().model.mass[size_t(i)] * dot(strand().v[size_t(i)], strand().v[size_t(i)]);
    return e + tissue::energy(sheet, state).kinetic;
  }
};

TEST(Border, EdgeNodesAreExactlyWhereTheStrandIs) {
  Hanging h;
  for (Vec3d& v : h.strand().v) v = {0.02, 0.05, 0.1};
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(h.step());
    for (size_t k = 0; k < h.holds.size(); ++k)
      ASSERT_LT(length(position(h.sheet.network, h.state.network, h.sheet.held_nodes[k]) -
                       place_of(h.few.all(), h.holds[k].point)),
                1e-8);
  }
}

TEST(Border, MomentumGoesOverFromStrandToSheet) {
  // A push of 60 ms on the strand. Strand, sheet and the inertia that the borders add have together what the push gave,
  // within 20 % of the sheet's part; the added inertia alone is less than the sheet's mass.
  for (const Vec3d& push : {Vec3d{0, 0, 0.01}, Vec3d{0, 0.01, 0}, Vec3d{0.01, 0, 0}}) {
    Hanging h;
    Vec3d given{0, 0, 0};
    double worst = 0, sheet_mass = 0, whole_mass = 0;
    for (int i = 0; i < h.sheet.nodes(); ++i)
      if (h.sheet.network.fixed[size_t(i)] != tissue::kHeld) sheet_mass += h.sheet.network.mass[size_t(i)];
    for (double m : h.body().model.mass) whole_mass += m;
    whole_mass += sheet_mass;
    for (int i = 0; i < 300; ++i) {
      const double ramp = i < 60 ? 0.5 * (1 - std::cos(i * 2 * std::numbers::pi / 60)) : 0;
      const Vec3d each = ramp / h.body().nodes() * push;
      h.force = each;
      given += kTick * ramp * push;
      ASSERT_TRUE(h.step());
      worst = std::max(worst, length(h.momentum() + h.astray - given));
    }
    double added = 0;
    for (const tissue::BorderPull& pull : h.pulls) added += kTick * added_damping(pull, kTick);
    EXPECT_LT(added, sheet_mass);
    EXPECT_LT(worst, 0.20 * sheet_mass / whole_mass * length(given)) << push.x << " " << push.y << " " << push.z;
  }
}

TEST(Border, BoundedUnderAStrandLighterThanTheSheetTenTimesAsStiffToo) {
  // Thrown in zigzag the borders jolt the sheet once, by up to K (v dt)^2; from then on energy only falls.
  for (double modulus : {2e3, 20e3, 200e3}) {
    Hanging h(modulus, true, 0.0006);
    for (int i = 1; i + 1 < h.body().nodes(); ++i) h.strand().v[size_t(i)] = {0, 0.1 * (i % 2 ? 1 : -1), 0.1};
    double start = h.kinetic(), late = 0;
    for (int i = 0; i < 800; ++i) {
      ASSERT_TRUE(h.step()) << modulus;
      if (i < 30) start = std::max(start, h.kinetic());
      if (i >= 400) late = std::max(late, h.kinetic());
    }
    EXPECT_LT(late, 0.25 * start) << modulus;
  }
}

TEST(Border, TheStrandBearsTheSheetsWeight) {
  Hanging h(20e3, true);
  // Gravity on the sheet only: the held strand sags until its ends bear the sheet.
  h.sheet.network.gravity = {0, 0, -9.81};
  h.sheet.network.gravity_step[2] = float(-9.81 * h.sheet.network.dt);
  std::vector<tissue::StrandReaction> ends(2);
  for (int i = 0; i < 4000; ++i) ASSERT_TRUE(h.step());
  h.loads().clear();
  border_pulls(h.sheet, h.state, h.work, h.pulls);
  border_loads(h.few.all(), 0, h.pulls, kTick);
  advance(h.body().model, {}, h.loads().list, ends, {}, h.strand(), h.few.work.strands[0].body);
  double weight = 0;
  for (int i = 0; i < h.sheet.nodes(); ++i)
    if (h.sheet.network.fixed[size_t(i)] != tissue::kHeld) weight += 9.81 * h.sheet.network.mass[size_t(i)];
  EXPECT_NEAR(ends[0].force.z + ends[1].force.z, -weight, 0.02 * weight);
}

TEST(Border, WhatPressesOnAHeldNodeIsBorneByTheStrand) {
  Hanging h;
  NetworkLoads& on_sheet = h.few.work.membranes[0].loads;
  on_sheet.reserve(8);
  const int node = h.sheet.held_nodes[7];
  const Vec3d place = position(h.sheet.network, h.state.network, node), push{0.001, -0.002, 0.003};
  const double stretched = 0.0002;
  const auto load = [&](double k) {
    tissue::NodeLoad l;
    l.node = node;
    l.f0 = vec_cast<float>(push);
    l.k = float(k);
    l.x0 = vec_cast<float>(place + Vec3d{0, stretched, 0});
    return l;
  };
  for (const double k : {0.0, 20.0}) {
    h.loads().clear(), on_sheet.clear();
    on_sheet.add(load(k), {Owner::tool_contact, 1, 0});
    border_loads(h.few.all(), 0, h.pulls, kTick);
    Vec3d borne{0, 0, 0};
    for (const tissue::StrandLoad& l : h.loads().list) {
      const Vec3d at = h.strand().x[size_t(l.element)] +
                       l.w * (h.strand().x[size_t(l.element) + 1] - h.strand().x[size_t(l.element)]);
      borne += l.f0 + l.k * (l.x0 - at);
    }
    EXPECT_LT(length(borne - push - Vec3d{0, k * stretched, 0}), 1e-6) << k;
    for (const Tag& tag : h.loads().tag) EXPECT_EQ(tag.owner, Owner::anchor) << "the instrument feels it by the sheet";
  }
}

TEST(Border, WhereTheStrandIsCutEachSideGoesWithItsStump) {
  Hanging h;
  tissue::cut_element(h.strand(), 8);
  for (int i = 0; i < h.body().nodes(); ++i) h.strand().v[size_t(i)] = {i <= 8 ? -0.02 : 0.02, 0, 0};
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(h.step());
  // The sheet holds the pieces together: it is stretched between them and slows them down.
  EXPECT_GT(tissue::energy(h.sheet, h.state).stretch, 0);
  EXPECT_LT(length(h.strand().v[12]), 0.02);
}

}  // namespace
