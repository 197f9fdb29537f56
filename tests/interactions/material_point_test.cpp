// A material point of every kind of body: where it is, how fast it goes, and loads as the transpose of that.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

#include "few_bodies.hpp"
#include "straight_tube.hpp"

namespace trocar::interactions {
namespace {

using test::FewBodies;

/// A bar of cubes of six tetrahedra each.
tissue::CuttableDescription bar_of_tetrahedra() {
  tissue::CuttableDescription d;
  const tissue::BoxLattice box = tissue::box_lattice(6, 2, 2, 0.005);
  d.points = box.corners;
  constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
  for (const auto& c : box.cells)
    for (const auto& p : kPaths) d.cells.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
  d.material = {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.2, .damping_time = 1e-3};
  return d;
}

tissue::NetworkDescription block() {
  const tissue::BoxLattice box = tissue::box_lattice(4, 3, 3, 0.005);
  return tissue::lattice_network(box.corners, box.cells, {}, {.youngs_modulus = 5.4e3, .density = 1060}).network;
}

tissue::MembraneDescription level_sheet() {
  tissue::MembraneDescription d;
  d.columns = 9, d.rows = 7;
  for (int r = 0; r < d.rows; ++r)
    for (int c = 0; c < d.columns; ++c) d.positions.push_back({0.0025 * c, 0.0025 * r, 0});
  d.held.assign(d.positions.size(), 0);
  for (int r = 0; r < d.rows; ++r) d.held[std::size_t(r * d.columns)] = 1;
  d.thickness = 0.0005, d.youngs_modulus = 20e3, d.density = 1000, d.damping_time = 4e-4;
  d.bending_damping_time = 4e-4;
  return d;
}

/// A lattice, tetrahedra, a sheet and a tube, each of its own.
struct EachKind : FewBodies {
  const BodyId lattice = BodyId::organ(0), tetrahedra = BodyId::organ(1), sheet = BodyId::membrane(0),
               rod = BodyId::strand(0);
  const BodyId all_kinds[4] = {lattice, tetrahedra, sheet, rod};

  EachKind() {
    models.solids.emplace_back().network = tissue::build(block(), 1e-3);
    states.solids.push_back(rest_state(models.solids[0].network));
    models.cuttables.emplace_back().body = build(bar_of_tetrahedra(), 1e-3);
    states.cuttables.push_back(rest_state(models.cuttables[0].body));
    models.membranes.emplace_back().sheet = build(level_sheet(), 1e-3);
    states.membranes.push_back(rest_state(models.membranes[0].sheet));
    states.torn.emplace_back(models.membranes[0].sheet.triangles.size());
    add(test::StraightTube().body);
    work.organs.resize(2);
    work.membranes.resize(1);
    for (OrganWork& organ : work.organs) organ.loads.reserve(256);
    work.membranes[0].loads.reserve(256);
  }
  std::vector<tissue::NodeState>& rows(BodyId body) {
    if (body == lattice) return states.solids[0].nodes;
    return body == tetrahedra ? states.cuttables[0].nodes : states.membranes[0].network.nodes;
  }
  int count(BodyId body) { return body == rod ? models.strand_bodies[0].nodes() : int(node_count(all(), body)); }
  Vec3d node(BodyId body, int n) {
    return body == rod ? states.strands[0].x[std::size_t(n)] : nodes_of(all(), body).position(n);
  }
  Vec3d speed(BodyId body, int n) {
    return body == rod ? states.strands[0].v[std::size_t(n)] : nodes_of(all(), body).velocity(n);
  }
  /// f(place) -> place of all nodes.
  template <class F>
  void move(BodyId body, F&& f) {
    if (body == rod) {
      for (Vec3d& x : states.strands[0].x) x = f(x);
      return;
    }
    const tissue::NodeView view = nodes_of(all(), body);
    for (tissue::NodeState& n : rows(body)) {
      const Vec3d to = f(Vec3d{n.x, n.y, n.z} + view.origin) - view.origin;
      n.x = float(to.x), n.y = float(to.y), n.z = float(to.z);
    }
  }
  /// Positions by up to `far` [m] and velocities of up to 1 m/s at random.
  void shake(core::Random& random, double far) {
    const auto any = [&](double most) {
      return Vec3d{random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
    };
    for (const BodyId body : all_kinds) {
      move(body, [&](Vec3d x) { return x + any(far); });
      if (body == rod)
        for (Vec3d& v : states.strands[0].v) v = any(1);
      else
        for (tissue::NodeState& n : rows(body)) {
          const Vec3d v = any(1);
          n.vx = float(v.x), n.vy = float(v.y), n.vz = float(v.z);
        }
    }
  }
  /// One tick on with the velocities as they are, or back.
  void go(double dt) {
    for (std::size_t i = 0; i < states.strands[0].x.size(); ++i) states.strands[0].x[i] += dt * states.strands[0].v[i];
    for (const BodyId body : {lattice, tetrahedra, sheet})
      for (tissue::NodeState& n : rows(body)) n.x += float(dt * n.vx), n.y += float(dt * n.vy), n.z += float(dt * n.vz);
  }
  /// Points in it, at its surface and beside it.
  std::vector<MaterialPoint> points(BodyId body, core::Random& random, int n) {
    std::vector<MaterialPoint> out;
    for (int i = 0; i < n; ++i) {
      const Vec3d at = node(body, int(random.uniform(0, count(body) - 1e-9)));
      const double far = 0.003;
      out.push_back(attach(
          all(), body, at + Vec3d{random.uniform(-far, far), random.uniform(-far, far), random.uniform(-far, far)}));
    }
    return out;
  }
};

TEST(MaterialPoint, IsWhereItWasAttachedWhateverTheBodyIs) {
  EachKind k;
  core::Random random(1);
  k.shake(random, 0.0005);
  for (const BodyId body : k.all_kinds)
    for (int i = 0; i < 50; ++i) {
      const Vec3d at = k.node(body, int(random.uniform(0, k.count(body) - 1e-9))) +
                       Vec3d{random.uniform(-0.003, 0.003), random.uniform(-0.003, 0.003), 0.001};
      EXPECT_LT(length(place_of(k.all(), attach(k.all(), body, at)) - at), 1e-9) << body.code();
    }
}

TEST(MaterialPoint, LoadIsTheTransposeOfVelocityForEveryKind) {  // virtual work                       [couplings]
  EachKind k;
  core::Random random(2);
  k.shake(random, 0.0004);
  for (const BodyId body : k.all_kinds)
    for (const MaterialPoint& p : k.points(body, random, 100)) {
      k.shake(random, 0.0001);
      const Vec3d force{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      const NodeForces on = transposed(k.all(), p, force);
      double work = 0, all = 0;
      Vec3d sum;
      for (int i = 0; i < on.count; ++i) {
        const double each = dot(on.force[std::size_t(i)], k.speed(body, on.node[std::size_t(i)]));
        work += each, all += std::fabs(each);
        sum += on.force[std::size_t(i)];
      }
      EXPECT_NEAR(work, dot(force, velocity_of(k.all(), p)), 1e-12 * std::max(1.0, all)) << body.code();
      EXPECT_LT(length(sum - force), 3e-7) << "weights are of single precision";
    }
}

TEST(MaterialPoint, VelocityIsHowItsPlaceChanges) {
  EachKind k;
  core::Random random(3);
  k.shake(random, 0.0002);
  for (const BodyId body : k.all_kinds)
    for (const MaterialPoint& p : k.points(body, random, 50)) {
      constexpr double kStep = 1e-4;
      const Vec3d v = velocity_of(k.all(), p);
      k.go(kStep);
      const Vec3d after = place_of(k.all(), p);
      k.go(-2 * kStep);
      const Vec3d before = place_of(k.all(), p);
      k.go(kStep);
      EXPECT_LT(length((after - before) / (2 * kStep) - v), 0.01 * std::max(0.5, length(v))) << body.code();
    }
}

TEST(MaterialPoint, TurnsWithItsBody) {
  EachKind k;
  core::Random random(4);
  // By 75 degrees about a slanting axis, and away.
  const Quatd turn = quat_from_two_vectors(Vec3d{0.6, 0.8, 0}, normalised(Vec3d{-0.3, 0.4, 0.9}));
  const auto moved = [&](Vec3d x) { return rotate(turn, x) + Vec3d{0.01, -0.02, 0.03}; };
  for (const BodyId body : k.all_kinds)
    for (const MaterialPoint& p : k.points(body, random, 30)) {
      EachKind turned;
      const Vec3d before = place_of(k.all(), p);
      turned.move(body, moved);
      // A rod does not tell how it has twisted: what is beside it keeps its distance from the axis and its place on it.
      if (body == k.rod) {
        EXPECT_LT(length(foot_of(turned.all(), p) - moved(foot_of(k.all(), p))), 1e-9);
        EXPECT_NEAR(length(place_of(turned.all(), p) - foot_of(turned.all(), p)), length(before - foot_of(k.all(), p)),
                    1e-9);
      } else {
        EXPECT_LT(length(place_of(turned.all(), p) - moved(before)), 2e-6) << body.code();
      }
      EXPECT_LT(length(drawn_place(turned.all(), p) - before), 1e-6) << body.code();
    }
}

TEST(MaterialPoint, OnACutRodRidesOnTheStumpThatItLiesOn) {
  EachKind k;
  const MaterialPoint near = at_element(k.all(), 0, 8, 0.2, {0, 0, 0.0016}),
                      far = at_element(k.all(), 0, 8, 0.8, {0, 0, 0.0016});
  const Vec3d near_was = place_of(k.all(), near), far_was = place_of(k.all(), far);
  tissue::cut_element(k.states.strands[0], 8);
  EXPECT_LT(length(place_of(k.all(), near) - near_was), 1e-9) << "the cut itself moves nothing";
  for (std::size_t i = 9; i < k.states.strands[0].x.size(); ++i) k.states.strands[0].x[i] += Vec3d{0.02, 0.01, 0};
  EXPECT_LT(length(place_of(k.all(), near) - near_was), 1e-9);
  EXPECT_LT(length(place_of(k.all(), far) - far_was - Vec3d{0.02, 0.01, 0}), 1e-9);
}

TEST(MaterialPoint, InTetrahedraStaysOnItsSideOfACut) {
  EachKind k;
  tissue::CuttableModel& body = k.models.cuttables[0].body;
  tissue::CuttableWork scratch = make_work(body);
  const MaterialPoint left = attach(k.all(), k.tetrahedra, {0.0125, 0.005, 0.010}),
                      right = attach(k.all(), k.tetrahedra, {0.0175, 0.005, 0.010});
  const geometry::CutResult cut =
      tissue::cut(body, geometry::square_blade({0.015, 0.005, 0.005}, {1, 0, 0}, 0.02), k.states.cuttables[0], scratch);
  ASSERT_GT(cut.doubled, 0);
  const auto piece_of = [&](const MaterialPoint& p) {
    tissue::make_current(body, k.states.cuttables[0], scratch);
    const geometry::Tet& cell = k.states.cuttables[0].tets.cells[std::size_t(p.element)];
    for (const int n : cell) EXPECT_EQ(scratch.part[std::size_t(n)], scratch.part[std::size_t(cell[0])]);
    return scratch.part[std::size_t(cell[0])];
  };
  ASSERT_NE(piece_of(left), piece_of(right));
  const Vec3d left_was = place_of(k.all(), left), right_was = place_of(k.all(), right);
  const tissue::NodeView nodes = nodes_of(k.all(), k.tetrahedra);
  for (int n = 0; n < k.states.cuttables[0].tets.nodes; ++n)
    if (scratch.part[std::size_t(n)] == piece_of(right))
      k.states.cuttables[0].nodes[std::size_t(nodes.row_of_node[std::size_t(n)])].x += 0.01f;
  EXPECT_LT(length(place_of(k.all(), left) - left_was), 1e-7);
  EXPECT_LT(length(place_of(k.all(), right) - right_was - Vec3d{0.01, 0, 0}), 1e-7);
}

TEST(MaterialPoint, AVertexOfTetrahedraStaysOnItsSideOfACutAndKeepsItsNumberThere) {
  EachKind k;
  tissue::CuttableModel& body = k.models.cuttables[0].body;
  tissue::CuttableWork scratch = make_work(body);
  std::vector<std::int32_t> cut_open;
  for (std::int32_t n = 0; n < k.count(k.tetrahedra); ++n)
    if (std::fabs(k.node(k.tetrahedra, n).x - 0.015) < 1e-6) cut_open.push_back(n);
  ASSERT_GT(cut_open.size(), 4u);
  std::vector<MaterialPoint> held;
  for (const std::int32_t n : cut_open) held.push_back(on_vertex(k.all(), 1, n));
  for (std::size_t i = 0; i < held.size(); ++i) EXPECT_EQ(vertex_of(k.all(), held[i]), cut_open[i]);
  ASSERT_GT(
      tissue::cut(body, geometry::square_blade({0.015, 0.005, 0.005}, {1, 0, 0}, 0.02), k.states.cuttables[0], scratch)
          .doubled,
      0);
  tissue::make_current(body, k.states.cuttables[0], scratch);
  for (const MaterialPoint& p : held) {
    const geometry::Tet& cell = k.states.cuttables[0].tets.cells[std::size_t(p.element)];
    const std::int32_t vertex = vertex_of(k.all(), p);
    EXPECT_NE(std::find(cell.begin(), cell.end(), vertex), cell.end());
    EXPECT_EQ(scratch.part[std::size_t(vertex)], scratch.part[std::size_t(cell[0])]);
    EXPECT_LT(length(place_of(k.all(), p) - k.node(k.tetrahedra, vertex)), 1e-9);
  }
}

TEST(MaterialPoint, OfAFileNamesOnlyWhatIsThere) {
  EachKind k;
  core::Random random(7);
  for (const BodyId body : k.all_kinds)
    for (const MaterialPoint& good : k.points(body, random, 5)) {
      ASSERT_TRUE(is_valid(k.models, good));
      MaterialPoint p = good;
      p.body = BodyId(body.kind(), 7);
      EXPECT_FALSE(is_valid(k.models, p)) << "no such body";
      p = good, p.element = 1 << 20;
      EXPECT_FALSE(is_valid(k.models, p)) << "no such element";
      p = good, p.count = 1000;
      EXPECT_EQ(is_valid(k.models, p), body == k.rod) << "a rod has no count";
      p = good, p.count = 0;
      EXPECT_EQ(is_valid(k.models, p), body == k.rod);
      p = good, p.node[0] = -3;
      EXPECT_EQ(is_valid(k.models, p), body == k.rod);
      p = good, p.frame = MaterialPoint::skin_row;
      EXPECT_FALSE(is_valid(k.models, p)) << "its row is of no vertex";
      p = good, p.frame = MaterialPoint::long_row;
      EXPECT_FALSE(is_valid(k.models, p)) << "long rows are the Model's";
    }
  EXPECT_FALSE(is_valid(k.models, on_object(BodyId(BodyKind::suture, 0), 0)));
}

TEST(MaterialPoint, OnATornTriangleGoesWithItsNearestCorner) {
  EachKind k;
  const MaterialPoint p = attach(k.all(), k.sheet, {0.0052, 0.0051, 0});
  k.states.torn[0][std::size_t(p.element)] = 1;
  const Vec3d was = place_of(k.all(), p);
  const tissue::NodeView nodes = nodes_of(k.all(), k.sheet);
  for (std::size_t i = 1; i < 3; ++i)
    if (p.weight[i] < p.weight[0]) k.rows(k.sheet)[std::size_t(nodes.row_of_node[std::size_t(p.node[i])])].y += 0.005f;
  EXPECT_LT(length(place_of(k.all(), p) - was), 1e-6);
}

/// A point load on a free body gives it the momentum of the force, and of k and d what they say.
TEST(MaterialPoint, ALoadIsAllOfTheForce) {
  EachKind k;
  core::Random random(6);
  k.shake(random, 0.0002);
  for (const BodyId body : {k.lattice, k.tetrahedra, k.sheet})
    for (const MaterialPoint& p : k.points(body, random, 30)) {
      NetworkLoads& loads = loads_on(k.all(), body);
      loads.clear();
      const PointLoad load{{0.3, -0.2, 0.1}, 200, place_of(k.all(), p) + Vec3d{0.001, 0, 0.002}, 0.5};
      put_load(k.all(), p, load, {});
      Vec3d sum;
      for (const tissue::NodeLoad& l : loads.gathered)
        sum += vec_cast<double>(l.f0) + double(l.k) * (vec_cast<double>(l.x0) - k.node(body, l.node)) -
               double(l.d) * k.speed(body, l.node);
      const Vec3d want = load.f0 + load.k * Vec3d{0.001, 0, 0.002} - load.d * velocity_of(k.all(), p);
      EXPECT_LT(length(sum - want), 1e-4 * length(want)) << body.code();
    }
}

}  // namespace
}  // namespace trocar::interactions
