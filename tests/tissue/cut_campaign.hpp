// Random cuts in a row, while the body lives: what the surgeon who never stops would leave.
#pragma once

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

#include "../geometry/cut_checks.hpp"

namespace trocar::tissue::campaign {

using geometry::Blade;
using geometry::Field;

/// An edge of liver: a lens of 70 x 50 x 24 mm.
inline Field liver_like() {
  Field f;
  f.box = {{-0.036, -0.026, -0.013}, {0.036, 0.026, 0.013}};
  f.inside = [](Vec3d p) {
    const double x = p.x / 0.035, y = p.y / 0.025, z = p.z / 0.012;
    return 0.012 * (1 - std::sqrt(x * x + y * y + z * z));
  };
  return f;
}
/// A bowel-like tube, 60 mm long, 12 mm wide, with a wall of 4 mm.
inline Field tube() {
  Field f;
  f.box = {{-0.031, -0.013, -0.013}, {0.031, 0.013, 0.013}};
  f.inside = [](Vec3d p) {
    const double wall = 0.002 - std::fabs(std::sqrt(p.y * p.y + p.z * p.z) - 0.010);
    return std::min(wall, 0.030 - std::fabs(p.x));
  };
  return f;
}
/// A membrane as a solid sheet, 60 x 60 x 4 mm.
inline Field sheet() {
  Field f;
  f.box = {{-0.031, -0.031, -0.003}, {0.031, 0.031, 0.003}};
  f.inside = [](Vec3d p) { return std::min({0.030 - std::fabs(p.x), 0.030 - std::fabs(p.y), 0.002 - std::fabs(p.z)}); };
  return f;
}

struct Campaign {
  const char* name;
  Field (*shape)();
  double cell, poisson;
};
inline void PrintTo(const Campaign& c, std::ostream* out) { *out << c.name; }

inline const Campaign kCampaigns[] = {
    {"liver_like", liver_like, 0.006, 0.45}, {"tube", tube, 0.003, 0.25}, {"membrane", sheet, 0.003, 0.25}};

/// Cuts and lives, and asks for a closed surface, booked volume and mass, and a body that has not blown up.
inline void run(const Campaign& campaign, int cuts) {
  const Field shape = campaign.shape();
  const geometry::TetMesh mesh = geometry::stuffed(shape, campaign.cell);
  CuttableDescription d;
  d.points = mesh.points;
  d.cells = mesh.cells;
  d.material = {.youngs_modulus = 5.4e3,
                .poisson = campaign.poisson,
                .density = 1060,
                .p1 = 2,
                .p2 = 100,
                .cap = 0.1,
                .damping_time = 1e-3};
  d.global_damping = 0.5;
  d.gravity = {0, 0, -9.81};
  d.spare_nodes = 4 * int(mesh.cells.size());
  d.fixed.assign(d.points.size(), kFree);
  for (size_t i = 0; i < d.points.size(); ++i)
    if (d.points[i].x < shape.box.low.x + 0.006) d.fixed[i] = kHeld;
  const CuttableModel model = build(d, 1e-3);
  CuttableState state = rest_state(model);
  CuttableWork work = make_work(model);
  const geometry::Soundness before = geometry::soundness(state.tets);

  core::Random random(97);
  const auto any = [&](double size) {
    return Vec3d{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  };
  int parted = 0;
  double fastest = 0;
  for (int i = 0; i < cuts; ++i) {
    // The blade goes where tissue is: beside a node that is there now.
    const Vec3d middle = position(model, state, int(random.uniform(0, 1) * (state.tets.nodes - 1)));
    const Vec3d u = any(0.01), across = any(0.01), v = across - (dot(u, across) / dot(u, u)) * u;
    Blade blade;
    blade.corners = 4;
    blade.corner = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    const geometry::CutResult book = cut(model, blade, state, work);
    ASSERT_FALSE(book.full) << i;
    parted += book.parted;
    for (int tick = 0; tick < 2; ++tick) ASSERT_TRUE(advance(model, {}, {}, state, work).fine()) << i;
  }
  for (int i = 0; i < state.tets.nodes; ++i) fastest = std::max(fastest, length(velocity(model, state, i)));
  const geometry::Soundness after = geometry::soundness(state.tets);
  double mass = 0;
  for (int i = 0; i < state.tets.nodes; ++i) mass += work.mass[size_t(i)];

  EXPECT_GT(parted, cuts);
  EXPECT_TRUE(after.linked);
  EXPECT_EQ(after.odd_edges, 0) << "the surface is closed";
  EXPECT_GT(after.least_volume, 0);
  EXPECT_GE(after.least_dihedral, std::min(before.least_dihedral, geometry::kLeastDihedral) - 1e-9);
  EXPECT_NEAR(after.volume, before.volume + state.volume, 1e-6 * before.volume);
  EXPECT_NEAR(mass, model.density * after.volume, 1e-6 * mass);
  EXPECT_LT(fastest, 9.81 * 2.0 + 5) << "at most two seconds of falling, and no blow-up";
  std::cout << campaign.name << ": " << mesh.cells.size() << " cells, " << parted << " faces parted, "
            << state.tets.nodes - model.own_nodes << " nodes doubled, smallest dihedral angle " << before.least_dihedral
            << " then " << after.least_dihedral << " degrees, volume shaved off " << -100 * state.volume / before.volume
            << " %, " << after.pinched_edges << " pinched edges, fastest " << fastest << " m/s\n";
  testing::Test::RecordProperty("smallest_dihedral", std::to_string(after.least_dihedral));
}

}  // namespace trocar::tissue::campaign
